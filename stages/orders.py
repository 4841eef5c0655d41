"""Stage orders: vibration of the recordings that follows the revolutions of a shaft."""

from functools import partial

import numpy as np

from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.diagnosis.experiment_design.overloaded_channels import overload_told
from pipeline.physics.signals.orders.order_tracking import (
    campbell,
    over_speed,
    shaft_of,
    shaft_of_pulses,
    smooth,
    track,
)
from pipeline.physics.signals.orders.outstanding_orders import strongest
from pipeline.products import Orders, OrderSpectra, Recording
from pipeline.recordings.samples import with_gaps


class Settings(Section):
    """The shaft, and how finely its orders are told apart."""

    shaft: str = option("", "channel that tells the speed of revolution, in rpm, rad/s or revolutions per second (Hz);"
                        " none = the first of each run that measures an angular velocity")
    pulses: int = option(0, "pulses a revolution where that channel is a tacho, in any unit; 0 = a speed", ge=0)
    channels: tuple[str, ...] = option((), "channels whose orders are sought; none = all that measure acceleration,"
                                       " velocity, displacement, force, torque or pressure, of sound too")
    revolutions: int = option(8, "revolutions of a block; its inverse is the distance of the lines", ge=4, le=256)
    highest_order: int = option(20, "highest order", ge=2, le=400)
    variation: float = option(0.2, "least range of the speed, as a share of the highest, of which orders are told",
                              gt=0, lt=1)
    slowest: float = option(0.1, "speeds below this share of the highest are left out", ge=0.02, lt=1)
    window: Quantity("s", gt=0) = option("0.5 s", "length of a frame of the Campbell diagram")
    bins: int = option(40, "bins of speed", ge=4, le=200)
    outstanding: int = option(6, "most orders that are told of a channel", ge=1, le=40)


#: what channels that are searched measure
_SEARCHED = ("acceleration", "velocity", "displacement", "force", "torque", "moment", "pressure", "sound_pressure")
#: rad/s in the units of a speed of revolution
_TURNING = {"rad/s": 1.0, "Hz": 2.0 * np.pi}
#: share of the sampling rate that the highest frequency may reach: above it the reading at equal angles errs
_READ = 0.2


def _check(sections):
    """Refuse pulses of no channel."""
    if sections["orders"].pulses and not sections["orders"].shaft:
        raise ConfigError("orders.shaft", "the channel of the pulses", "none")


@stage(check=_check)
def orders(recording: Recording, settings: Settings, context: Context) -> Orders:
    """Find vibration that follows the revolutions of a shaft.

    Method:
    Orders are amplitudes over the revolutions of a shaft: the speed was integrated to the angle, the signals read at
    equal angles by cubic splines (computed order tracking), and Hann spectra taken over blocks of {revolutions}
    revolutions, for orders up to {highest_order}, at speeds above {slowest} of the highest. An order is told where it
    stands 9 dB above the median of the lines about it in the mean and in 30 % of the blocks, also of those in which a
    tone of constant frequency would lie elsewhere; where these are fewer than four, it is marked. The Campbell diagram
    is of Hann frames of {window}, sorted by their mean speed.
    """
    _check_names(recording, settings)
    tasks, remarks = [], []
    for name, run in recording.runs.items():
        shaft = _shaft(run, settings)
        if shaft is None:
            continue
        turning = _turning(run.channels[shaft], settings.pulses)
        if turning is None:
            remarks.append(f"{name}: the tacho {shaft} gives fewer than three pulses: no orders")
            continue
        if turning.remark:
            context.remark(f"{name}, {shaft}: {turning.remark}")
        if np.ptp(turning.speed) < settings.variation * turning.speed.max() or not turning.speed.max():
            remarks.append(f"{name}: the speed {shaft} varies by less than {settings.variation:g} of its highest value:"
                           " no orders")
            continue
        tasks += [(name, key, channel, shaft, turning) for key, channel in run.channels.items()
                  if key != shaft and _wanted(key, channel, settings)]
    made = {}
    for task, result in zip(tasks, context.map(partial(_tracked, settings=settings), tasks, "orders"), strict=True):
        if isinstance(result, str):
            remarks.append(f"{task[0]}, {task[1]}: no orders: {result}")
        else:
            made[f"{task[0]}.{task[1]}"] = result
    for remark in remarks:
        context.remark(remark)
    cut = [f"{run}, {key}: {told}" for run, key, channel, *_ in tasks if f"{run}.{key}" in made
           and (told := overload_told(channel))]         # the import has told it before
    return Orders(spectra=made, remarks=[*remarks, *cut])


def _check_names(recording, settings):
    """Refuse channels that no run has."""
    there = {key for run in recording.runs.values() for key in run.channels}
    for key, names in (("shaft", {settings.shaft} - {""}), ("channels", set(settings.channels))):
        if names - there:
            raise ConfigError(f"orders.{key}", f"channels of the recording: {', '.join(sorted(there))}",
                              ", ".join(sorted(names - there)))


def _shaft(run, settings):
    """Name of the channel that tells the speed of a run; None of none."""
    if settings.shaft in run.channels:
        unit = str(run.channels[settings.shaft].unit)
        if unit not in _TURNING and not settings.pulses:
            raise ConfigError("orders.shaft", "a channel in rpm, rad/s or Hz", f"{settings.shaft} in {unit}")
        return settings.shaft
    return None if settings.shaft else next(iter(run.telling("speed")), None)


def _turning(channel, pulses):
    """Shaft of the channel that tells its speed, or its pulses; None of too few pulses."""
    if pulses:
        return shaft_of_pulses(*_series(channel), pulses)
    return shaft_of(*_series(channel, _TURNING[str(channel.unit)]))


def _wanted(name, channel, settings):
    return name in settings.channels if settings.channels else str(channel.measures) in _SEARCHED


def _series(channel, factor=1.0):
    """(samples, rate, begin) of a channel, NaN where samples are missing."""
    return factor * with_gaps(channel), float(channel.rate), float(channel.begin)


def _tracked(task, settings):
    """OrderSpectra of a channel, or why it has none."""
    run, name, channel, shaft, turning = task
    fastest = float(turning.speed.max())
    samples, rate, begin = _series(channel)
    highest = min(settings.highest_order, _READ * rate * 2.0 * np.pi / fastest)
    if highest < 2.0:
        return f"its rate of {rate:g} Hz is too low for the second order at {fastest:.4g} rad/s"
    top = highest * fastest / (2.0 * np.pi)
    if len(samples) < 2.0 * settings.window * rate:
        return f"it is shorter than two frames of {settings.window:g} s"
    signal = smooth(samples, rate, begin, top)
    orders = track(signal, turning, highest, settings.revolutions, settings.slowest * fastest)
    if orders is None:
        return f"no {settings.revolutions} revolutions lie within it without missing samples"
    edge = np.linspace(max(settings.slowest * fastest, turning.speed.min()), fastest, settings.bins + 1)
    found = strongest(orders, settings.outstanding)
    level, blocks = over_speed(orders.speed, found.amplitude.T, edge)
    frequency, diagram, frames = campbell(signal, turning, top, settings.window, edge)
    return OrderSpectra(run=run, channel=name, shaft=shaft, remark=turning.remark,
                        unit=str(channel.unit), time=orders.time,
                        speed=orders.speed, order=orders.order, amplitude=orders.amplitude.astype(np.float32),
                        edge=edge, outstanding=found.order, sure=found.sure.astype(int), level=level.T,
                        blocks=blocks, frequency=frequency, campbell=diagram.astype(np.float32),
                        frames=frames)
