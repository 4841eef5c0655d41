"""From a recording to what a bench is run with, and what a diagnosis compares with.

Scalar conditions of a run are handed on by name: ``speed`` is that of the drive, a condition named as an input is its
force (or displacement), ``normal_load`` that of friction joints. Recorded channels feed inputs, times the force or the
displacement per unit that the case states for the input, and the drive; between samples of theirs that were lost they
count as straight.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError
from pipeline.contract.units import TURNED
from pipeline.physics.virtual_rig.band_limited import refined
from pipeline.physics.virtual_rig.response import Run
from pipeline.physics.virtual_rig.sensor import measurand

#: intervals by which channels of one run may begin apart
_TOGETHER = 0.01
#: what an input of each unit is
_FEEDS = {"m": "a displacement", "N": "a force", "rad": "an angle", "N m": "a torque"}
#: conditions that a bench reads by themselves, and their units
_CONDITIONS = {"speed": ("rad/s", "m/s"), "normal_load": ("N",)}


@dataclass(frozen=True)
class Recorded:
    """One recorded run in the form of a bench: how it was run, and what its ``channels`` (c,) wrote.

    ``samples`` (c, n) in SI, ``valid`` (c, n), ``unit`` (c,); ``repeat_of`` names the run that it repeats.
    ``unknown``: how uncertain the start of the run is (``StartSpread``), where it is to be fitted.
    """

    run: Run
    channels: tuple
    unit: tuple
    samples: np.ndarray
    valid: np.ndarray
    repeat_of: str
    unknown: object = None


def recorded(recording, settings, model=None):
    """{run name: Recorded} of a product Recording under the section ``bench``.

    ``model``: the product ReducedModel whose inputs are fed; None: inputs are forces as recorded, times their gains.

    Raises ConfigError for runs without any channel of the bench, unequal sampling, and units other than the model's.
    """
    inputs = _inputs(model)
    runs = {name: _recorded(name, run, settings, inputs) for name, run in recording.runs.items()
             if set(run.channels) & set(settings.channels)}
    if not runs:
        known = sorted({c for run in recording.runs.values() for c in run.channels})
        raise ConfigError("bench.channels",
                          f"channels of the recording, of {', '.join(known) or 'which there are none'}",
                          ", ".join(settings.channels) or "none", "name recorded channels and what they show")
    check_units(runs, settings, model)
    _check_courses(runs, settings, model)
    return runs


def led(course, time, where):
    """Displacement (n,) in m at the instants ``time`` (n,) of an end that is led through a section Course."""
    begin, speed = np.array(course.at), np.array(course.speed)
    if len(begin) != len(speed) or (np.diff(begin) <= 0).any():
        raise ConfigError(where, "rising instants and as many speeds", f"{len(begin)} and {len(speed)}")
    change = np.diff(speed, prepend=0.0)
    return np.maximum(time[:, None] - begin, 0.0) @ change


def _check_courses(runs, settings, model):
    """Refuse courses of what is not the far end of a spring, of unknown runs, and beside a recorded channel."""
    joints = {} if model is None else dict(zip(map(str, model.joint_name), model.joint_stiffness, strict=True))
    moved = {} if model is None else dict(zip(map(str, model.input_name), map(str, model.input_joint), strict=True))
    for key, courses in settings.courses.items():
        if not joints.get(moved.get(key), 0.0) > 0:
            found = f"no stiffness of {moved[key]}" if moved.get(key) else "a force" if key in moved else "none"
            raise ConfigError(f"bench.courses.{key}", "an input that displaces a spring: steps of a speed need the"
                              " stiffness of the machine between drive and block", found,
                              "add the spring of the machine, and an input that displaces it")
        if key in settings.inputs:
            raise ConfigError(f"bench.courses.{key}", "no recorded channel beside it", settings.inputs[key].channel)
        unknown = [name for name in courses if name not in runs]
        if unknown:
            raise ConfigError(f"bench.courses.{key}", f"of the runs {', '.join(runs)}", ", ".join(unknown))


def _inputs(model):
    """{input: (unit that feeds it, what it does per unit)} of a product ReducedModel; none of None."""
    if model is None:
        return {}
    turning = set(map(str, model.turning))
    units = {str(name): "m" if joint else "N" for name, joint in zip(model.input_name, model.input_joint, strict=True)}
    return {name: (TURNED[unit] if f"inputs.{name}" in turning else unit, float(scale))
            for (name, unit), scale in zip(units.items(), model.input_scale, strict=True)}


def _recorded(name, run, settings, model_inputs):
    seen = [c for c in settings.channels if c in run.channels]
    parts = [run.channels[c] for c in seen]
    fed = settings.inputs | ({"drive": settings.drive} if settings.drive else {})
    for key, given in fed.items():
        if given.channel not in run.channels:
            raise ConfigError(f"bench.{'drive' if key == 'drive' else f'inputs.{key}'}.channel",
                              f"one of {', '.join(run.channels)} of run {name}", repr(given.channel))
    rates = {float(p.rate) for p in parts} | {float(run.channels[f.channel].rate) for f in fed.values()}
    lengths = {len(p.samples) for p in parts} | {len(run.channels[f.channel].samples) for f in fed.values()}
    if len(rates) > 1 or len(lengths) > 1:
        raise ConfigError(f"run {name}", "channels of one rate and length",
                          f"{sorted(rates)} Hz, {sorted(lengths)} samples", "resample them to one rate first")
    rate, count = rates.pop(), lengths.pop()
    begins = [float(run.channels[c].begin) for c in (*seen, *(f.channel for f in fed.values()))]
    if (max(begins) - min(begins)) * rate > _TOGETHER:
        raise ConfigError(f"run {name}", "channels that begin at one instant", f"{min(begins):.9g} s to"
                          f" {max(begins):.9g} s", "state begin and end of the run, in recording.files, where all are")
    _check_fed(name, run, settings, model_inputs)
    inputs = {key: model_inputs.get(key, ("N", 1.0))[1] * _fed(given, run) for key, given in settings.inputs.items()}
    inputs |= {key: led(courses[name], np.arange(count) / rate, f"bench.courses.{key}.{name}")
               for key, courses in settings.courses.items() if name in courses}
    drive = None if settings.drive is None else _fed(settings.drive, run)
    if settings.drive is not None and settings.drive.hold == "band_limited":
        drive = refined(drive, 1)
    if settings.drive is not None and settings.drive.hold == "step":
        raise ConfigError("bench.drive.hold", "linear or band_limited: a speed that jumps takes an infinite force",
                          "step", "feed the measured speed, or the position with derivative: true")
    conditions = {key: float(np.ravel(c.value)[0]) for key, c in run.conditions.items()}
    compared = np.array([valid(p) for p in parts]) & (np.arange(count) >= settings.settle * rate)
    held, within = (tuple(key for key, given in settings.inputs.items() if given.hold == hold)
                    for hold in ("step", "band_limited"))
    plan = Run(name, (count - 1) / rate, rate, inputs, drive, conditions, held=held, band_limited=within)
    return Recorded(plan, tuple(seen), tuple(str(p.unit) for p in parts), np.array([p.samples for p in parts], float),
                    compared, str(run.repeat_of))


def _fed(given, run):
    """(n,) what a section Fed makes of a channel of the product Run."""
    channel = run.channels[given.channel]
    kept, instants = valid(channel), np.arange(len(channel.samples))
    samples = np.interp(instants, instants[kept], np.asarray(channel.samples)[kept])
    if given.derivative:
        samples = np.gradient(samples, 1 / float(channel.rate))
    return (1.0 if given.gain is None else given.gain) * samples


def _check_fed(name, run, settings, model_inputs):
    """Refuse channels, or their rates, and conditions in units that are not those of what they feed."""
    for key, given in settings.inputs.items():
        unit = model_inputs.get(key, ("N", 1.0))[0]
        wanted = (f"{unit} s",) if given.derivative else (unit, "1")
        _check_unit(f"bench.inputs.{key}", run.channels[given.channel].unit, wanted, given, name,
                    _FEEDS[unit])
    if settings.drive is not None:
        wanted = ("rad", "m") if settings.drive.derivative else ("rad/s", "m/s")
        _check_unit("bench.drive", run.channels[settings.drive.channel].unit, wanted, settings.drive, name, "the drive")
    known = _CONDITIONS | {key: (wanted,) for key, (wanted, _) in model_inputs.items()}
    for key, wanted in known.items():
        if key in run.conditions and str(run.conditions[key].unit) not in wanted:
            raise ConfigError(f"run {name}: conditions.{key}", f"a value in {' or '.join(wanted)}",
                              str(run.conditions[key].unit))


def _check_unit(where, unit, wanted, given, run, what):
    if given.gain is None and str(unit) not in wanted:
        raise ConfigError(where, f"a recorded unit of {' or '.join(wanted)}, because it feeds {what}",
                          f"{unit} in run {run}", "state its gain, or convert the recording")


def valid(channel):
    """(n,) False where samples of a product Channel are missing."""
    kept = np.ones(len(channel.samples), bool)
    for first, after in np.reshape(channel.missing, (-1, 2)):
        kept[int(first):int(after)] = False
    return kept


def check_units(runs, settings, model=None):
    """Refuse channels whose unit is not that of the quantity which the case says they show.

    Angles are the displacements of sensors that see rotations at a radius of 1 m; ``model``: product ReducedModel.
    """
    turning = () if model is None else [str(n) for n, t in zip(model.sensor_name, model.sensor_turns, strict=True) if t]
    for name, recorded_run in runs.items():
        for channel, unit in zip(recorded_run.channels, recorded_run.unit, strict=True):
            shown = settings.channels[channel]
            wanted = measurand(shown.quantity, f"bench.channels.{channel}.quantity").unit
            if shown.source in turning and unit == TURNED.get(wanted):
                continue
            if unit != wanted and shown.gain is None:
                raise ConfigError(f"bench.channels.{channel}",
                                  f"a recorded unit of {wanted}, because it shows {shown.quantity}",
                                  f"{unit} in run {name}", "state its gain, or convert the recording")
