"""Features of self-excited benches: poles of taps and growth phases, ratios of sensors, forces locked to the angle.

Stops that squeal (``stops``) show the pole that grows. Other runs with motion channels are free vibrations: their poles
count where two records (a run and its ``repeat_of``) show them; sensors that look at one point give the logarithm of
their ratio and their delay. Runs with joint forces alone are slow turns: they give cosine and sine of the first orders.
Every operating point is one record of features.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.contract import ConfigError
from pipeline.diagnosis.features.pairing import assigned, merged, nearer
from pipeline.diagnosis.features.stops import channels_of, stops_of
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.inference.problem import Observed
from pipeline.physics.signals.pole_identification import (
    Poles,
    before_saturation,
    confirmed,
    fundamental,
    steady_poles,
)
from pipeline.physics.virtual_rig.modes import modes, motions, order_locked
from pipeline.physics.virtual_rig.sensor import JOINT_FORCE, VELOCITY

#: orders of the drive that slow turns are read for
ORDERS = (1, 2, 3)
#: largest range of a recorded speed over its mean at which a run has poles
_STEADY = 0.05


@dataclass(frozen=True)
class Features:
    """What one operating point showed: Poles ``seen``, or none; ``values``, ``std`` {feature: SI value}.

    ``resolved``: rad/s that poles have to be apart to be told apart, 2 pi / length of the shortest record.
    ``channels``: indices of the motion channels that shapes hold, none: all. ``stops`` {run: Growth, or why it tells
    none}.
    """

    run: object
    seen: Poles | None
    values: dict
    std: dict
    resolved: float = 0.0
    channels: tuple = ()
    stops: dict = field(default_factory=dict)

    def shown(self, shape):
        """Shapes (p, c) of all motion channels as these records show them."""
        return shape[:, list(self.channels)] if self.channels else shape


def features(bench, recorded, settings, rules=DEFAULTS.poles):
    """{run name: Features} of {name: Recorded}; ``settings`` the section ``bench.poles``.

    Raises ConfigError where a run of free vibration has no repeat.
    """
    result, squealing = {}, stops_of(bench, recorded, settings)
    for name, record in recorded.items():
        _refuse_changing_speed(record.run)
        if record.repeat_of:
            continue
        again = [other for other in recorded.values() if other.repeat_of == name]
        if stop := squealing.get(name):
            shown = Features(record.run, stop.seen, {}, {}, 0.0, stop.channels, stop.stops)
            result[name] = _told(bench, shown, settings, rules)
            continue
        if not set(record.channels) & {c.name for c in motions(bench)}:
            result[name] = _turned(bench, record)
            continue
        if not again:
            raise ConfigError(f"run {name}", "a repeat: poles count where two records show them", "none",
                              "record it twice and set repeat_of")
        shown = [{c.name for c in motions(bench)} & set(each.channels) for each in (record, again[0])]
        if lacking := shown[0] ^ shown[1]:
            raise ConfigError(f"run {again[0].run.name}", f"the motion channels of run {name}, which it repeats",
                              f"{', '.join(sorted(lacking))} in one of them alone",
                              "leave them out of bench.channels, or name another repeat")
        (first, apart), (second, other) = (_poles(bench, each, settings, rules) for each in (record, again[0]))
        seen, there = fundamental(confirmed(first, second)), channels_of(bench, record)
        result[name] = _told(bench, Features(record.run, seen, {}, {}, max(apart, other), there), settings, rules)
    return result


def _refuse_changing_speed(run):
    """ConfigError where the recorded speed of the drive changes, and the poles with it."""
    if np.ndim(run.drive) and np.ptp(run.drive) > _STEADY * abs(np.mean(run.drive)):
        raise ConfigError(f"run {run.name}: drive",
                          f"a speed constant within {_STEADY:.0%}, because poles are compared",
                          f"{np.min(run.drive):.3g} to {np.max(run.drive):.3g} rad/s",
                          "declare shorter stretches as runs, or compare samples (diagnosis.forward: simulation)")


def _poles(bench, record, settings, rules):
    """(Poles of a run as its motion channels show them, shapes as velocities; rad/s that it tells apart)."""
    seen = [c for c in motions(bench) if c.name in record.channels]
    samples = _unbroken(record)[[record.channels.index(c.name) for c in seen]]
    count = before_saturation(samples, record.run.sample_rate, settings.saturation)
    poles = steady_poles(samples, record.run.sample_rate, settings.low, settings.high, count)
    power = np.array([VELOCITY.order - c.measurand.order for c in seen])
    apart = 2 * np.pi * record.run.sample_rate / min(count, samples.shape[1])
    std = np.hypot(poles.std, rules.unresolved * apart)
    return replace(poles, shape=poles.shape * poles.root[:, None] ** power, std=std), apart


def _unbroken(record):
    """Samples (c, n) of a Recorded run from where all its channels begin. ConfigError where any is lost after that."""
    valid = record.valid.all(axis=0)
    begin = int(np.argmax(valid))
    if not valid[begin:].all():
        raise ConfigError(f"run {record.run.name}", "samples without a gap, of which poles can be read",
                          f"{int((~valid[begin:]).sum())} lost ones", "cut the record before them, or leave it out")
    return record.samples[:, begin:]


def _told(bench, features, settings, rules):
    """The Features with their values: every pole, and the ratio of every two sensors of one point; none, if no pole."""
    if not len(features.seen.root):
        return features
    values, std = {}, {}
    for k, (root, spread) in enumerate(zip(features.seen.root, features.seen.std, strict=True), 1):
        frequency, growth = _named(k)
        values |= {frequency: root.imag / (2 * np.pi), growth: root.real}
        floor = settings.resolution * root.imag
        std |= {frequency: np.hypot(spread, floor) / (2 * np.pi), growth: np.hypot(spread, floor)}
    for (first, second), (gain, delay) in _pairs(bench).items() if not features.stops else ():
        if not {first, second} <= set(features.channels or range(len(motions(bench)))):
            continue
        first, second = (features.channels.index(k) if features.channels else k for k in (first, second))
        heard = features.seen.of(_heard(features.seen.shape[:, [first, second]], rules))
        ratio = heard.shape[:, second] / heard.shape[:, first]
        trusted = 1 / (heard.std / abs(heard.root) + 1e-3) ** 2
        late = -np.angle(ratio) / heard.root.imag
        for name, each, floor in ((gain, np.log(abs(ratio)), rules.gain_std), (delay, late, rules.delay_std)):
            middle = np.median(each)
            kept = abs(each - middle) <= 3 * np.median(abs(each - middle)) + floor
            values[name] = float(np.average(each[kept], weights=trusted[kept]))
            std[name] = float(np.hypot(np.std(each[kept]) / np.sqrt(kept.sum()), floor))
    return replace(features, values=values, std=std)


def _heard(shape, rules=DEFAULTS.poles):
    """Indices of the poles of amplitudes (p, 2) that both sensors hear; all where there is none."""
    size = abs(shape)
    loud = (size > rules.heard * size.max(axis=0, initial=0.0)).all(axis=1)
    return np.flatnonzero(loud | ~loud.any())


def _turned(bench, record):
    """Features of a slow turn: least squares of the joint forces over cosine and sine of the orders."""
    angle = record.run.conditions.get("speed", bench.model.speed) * record.run.time
    if abs(angle[-1]) < 1.9 * np.pi:
        raise ConfigError(f"run {record.run.name}", "a whole turn of the drive, because it shows no motion",
                          f"{abs(angle[-1]) / (2 * np.pi):.2g} turns")
    basis = np.column_stack([np.ones_like(angle), *(w(n * angle) for n in ORDERS for w in (np.cos, np.sin))])
    values, std = {}, {}
    for name, samples, valid in zip(record.channels, record.samples, record.valid, strict=True):
        fitted, *_ = np.linalg.lstsq(basis[valid], samples[valid], rcond=None)
        left = np.std(samples[valid] - basis[valid] @ fitted)
        spread = left * np.sqrt(np.diag(np.linalg.inv(basis[valid].T @ basis[valid])))
        for key, value, deviation in zip(_orders(name), fitted[1:], spread[1:], strict=True):
            values[key], std[key] = float(value), float(deviation)
    return Features(record.run, None, values, std)


def observed(features, held_out=()):
    """(Observed, ...) of {run: Features} with one list of channels, {channel: SI unit}; what a run lacks is masked.

    Runs that show nothing are left out. Raises ConfigError where all do.
    """
    shown = {run: run_features for run, run_features in features.items() if run_features.values}
    if not shown:
        raise ConfigError("bench.poles", "runs that show a pole in two records each", f"none of {', '.join(features)}",
                          "widen low and high, or record longer")
    names = sorted({name for run_features in shown.values() for name in run_features.values}, key=_order)
    observations = []
    for run, run_features in shown.items():
        valid = np.array([[name in run_features.values] for name in names])
        samples = np.array([[run_features.values.get(name, 0.0)] for name in names])
        std = np.array([run_features.std.get(name, 1.0) for name in names])
        observations.append(Observed(run, run_features.run.conditions, tuple(names), samples, None, valid,
                                     noise_std=std, held_out=run in held_out))
    return tuple(observations), {name: _unit(name) for name in names}


def predicted(bench, features, channels, rules=DEFAULTS.poles):
    """(c, 1) of the features ``channels`` that the bench would have shown where ``features`` were seen; 0 for
    those that the run lacks."""
    values = {}
    if features.seen is not None:
        root, shape = modes(bench, features.run)
        index = assigned(features.seen, root, features.shown(shape), rules)
        nearest = merged(features.seen.root, root, index, features.resolved)
        for k, near in enumerate(nearer(features.seen.root, nearest, rules), 1):
            values |= dict(zip(_named(k), (near.imag / (2 * np.pi), near.real), strict=True))
        moving = motions(bench)
        for (first, second), (gain, delay) in _pairs(bench).items():
            values[gain] = np.log(abs(moving[second].gain / moving[first].gain))
            values[delay] = moving[second].delay - moving[first].delay
    for channel in bench.channels:
        if channel.measurand == JOINT_FORCE and _orders(channel.name)[0] in features.values:
            force = channel.gain * order_locked(bench, features.run, channel.source, ORDERS)
            parts = np.column_stack((force.real, force.imag)).ravel()
            values |= dict(zip(_orders(channel.name), parts, strict=True))
    return np.array([[values.get(name, 0.0) if name in features.values else 0.0] for name in channels])


def _pairs(bench):
    """{(i, j): (feature, feature)} of motion channels at one sensor: logarithm of their ratio, and delay."""
    moving = motions(bench)
    return {(i, j): (f"gain of {b.name} over {a.name}", f"delay of {b.name} behind {a.name}")
            for j, b in enumerate(moving) for i, a in enumerate(moving[:j]) if a.source == b.source}


def _named(k):
    return f"pole {k} frequency", f"pole {k} growth rate"


def _orders(channel):
    return [f"order {n} {wave} of {channel}" for n in ORDERS for wave in ("cosine", "sine")]


def _unit(name):
    if name.startswith("pole"):
        return "Hz" if name.endswith("frequency") else "rad/s"
    return {"gain": "1", "delay": "s", "order": "N"}[name.split()[0]]


def _order(name):
    """Sensors first, then poles by number, then orders."""
    kind = name.split()[0]
    number = int(name.split()[1]) if kind == "pole" else 0
    return ("gain", "delay", "pole", "order").index(kind), number, name
