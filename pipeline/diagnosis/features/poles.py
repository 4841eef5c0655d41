"""Features of self-excited benches: poles of taps and growth phases, ratios of sensors, forces locked to the angle.

Runs with motion channels are free vibrations: their poles count where two records (a run and its ``repeat_of``) show
them; sensors that look at one point give the logarithm of their ratio and their delay. Runs with joint forces alone are
slow turns: they give cosine and sine of the first orders. Every operating point is one record of features.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract import ConfigError
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.inference.problem import Observed
from pipeline.physics.signals.pole_identification import (
    Poles,
    before_saturation,
    confirmed,
    fundamental,
    likeness,
    steady_poles,
)
from pipeline.physics.virtual_rig.modes import modes, motions, order_locked
from pipeline.physics.virtual_rig.sensor import JOINT_FORCE, VELOCITY

#: orders of the drive that slow turns are read for
ORDERS = (1, 2, 3)


@dataclass(frozen=True)
class Features:
    """What one operating point showed: Poles ``seen``, or none; ``values``, ``std`` {feature: SI value}.

    ``resolved``: rad/s that poles have to be apart to be told apart, 2 pi / length of the shortest record.
    """

    run: object
    seen: Poles | None
    values: dict
    std: dict
    resolved: float = 0.0


def features(bench, recorded, settings, rules=DEFAULTS.poles):
    """{run name: Features} of {name: Recorded}; ``settings`` the section ``bench.poles``.

    Raises ConfigError where a run of free vibration has no repeat.
    """
    found = {}
    for name, one in recorded.items():
        if one.repeat_of:
            continue
        again = [other for other in recorded.values() if other.repeat_of == name]
        if not set(one.channels) & {c.name for c in motions(bench)}:
            found[name] = _turned(bench, one)
            continue
        if not again:
            raise ConfigError(f"run {name}", "a repeat: poles count where two records show them", "none",
                              "record it twice and set repeat_of")
        (first, apart), (second, other) = (_poles(bench, record, settings, rules) for record in (one, again[0]))
        seen = fundamental(confirmed(first, second))
        found[name] = _told(bench, Features(one.run, seen, {}, {}, max(apart, other)), settings, rules)
    return found


def _poles(bench, one, settings, rules):
    """(Poles of a run as its motion channels show them, shapes as velocities; rad/s that it tells apart)."""
    seen = [c for c in motions(bench) if c.name in one.channels]
    samples = _unbroken(one)[[one.channels.index(c.name) for c in seen]]
    count = before_saturation(samples, one.run.sample_rate, settings.saturation)
    told = steady_poles(samples, one.run.sample_rate, settings.low, settings.high, count)
    power = np.array([VELOCITY.order - c.measurand.order for c in seen])
    apart = 2 * np.pi * one.run.sample_rate / min(count, samples.shape[1])
    std = np.hypot(told.std, rules.unresolved * apart)
    return replace(told, shape=told.shape * told.root[:, None] ** power, std=std), apart


def _unbroken(one):
    """Samples (c, n) of a Recorded run from where all its channels begin. ConfigError where any is lost after that."""
    valid = one.valid.all(axis=0)
    begin = int(np.argmax(valid))
    if not valid[begin:].all():
        raise ConfigError(f"run {one.run.name}", "samples without a gap, of which poles can be read",
                          f"{int((~valid[begin:]).sum())} lost ones", "cut the record before them, or leave it out")
    return one.samples[:, begin:]


def _told(bench, one, settings, rules):
    """The Features with their values: every pole, and the ratio of every two sensors of one point; none, if no pole."""
    if not len(one.seen.root):
        return one
    values, std = {}, {}
    for k, (root, spread) in enumerate(zip(one.seen.root, one.seen.std, strict=True), 1):
        frequency, growth = _named(k)
        values |= {frequency: root.imag / (2 * np.pi), growth: root.real}
        floor = settings.resolution * root.imag
        std |= {frequency: np.hypot(spread, floor) / (2 * np.pi), growth: np.hypot(spread, floor)}
    for (first, second), (gain, delay) in _pairs(bench).items():
        heard = one.seen.of(_heard(one.seen.shape[:, [first, second]], rules))
        ratio = heard.shape[:, second] / heard.shape[:, first]
        trusted = 1 / (heard.std / abs(heard.root) + 1e-3) ** 2
        late = -np.angle(ratio) / heard.root.imag
        for name, each, floor in ((gain, np.log(abs(ratio)), rules.gain_std), (delay, late, rules.delay_std)):
            middle = np.median(each)
            kept = abs(each - middle) <= 3 * np.median(abs(each - middle)) + floor
            values[name] = float(np.average(each[kept], weights=trusted[kept]))
            std[name] = float(np.hypot(np.std(each[kept]) / np.sqrt(kept.sum()), floor))
    return replace(one, values=values, std=std)


def _heard(shape, rules=DEFAULTS.poles):
    """Indices of the poles of amplitudes (p, 2) that both sensors hear; all where there is none."""
    size = abs(shape)
    loud = (size > rules.heard * size.max(axis=0, initial=0.0)).all(axis=1)
    return np.flatnonzero(loud | ~loud.any())


def _turned(bench, one):
    """Features of a slow turn: least squares of the joint forces over cosine and sine of the orders."""
    angle = one.run.conditions.get("speed", bench.model.speed) * one.run.time
    if abs(angle[-1]) < 1.9 * np.pi:
        raise ConfigError(f"run {one.run.name}", "a whole turn of the drive, because it shows no motion",
                          f"{abs(angle[-1]) / (2 * np.pi):.2g} turns")
    basis = np.column_stack([np.ones_like(angle), *(w(n * angle) for n in ORDERS for w in (np.cos, np.sin))])
    values, std = {}, {}
    for name, samples, valid in zip(one.channels, one.samples, one.valid, strict=True):
        fitted, *_ = np.linalg.lstsq(basis[valid], samples[valid], rcond=None)
        left = np.std(samples[valid] - basis[valid] @ fitted)
        spread = left * np.sqrt(np.diag(np.linalg.inv(basis[valid].T @ basis[valid])))
        for key, value, own in zip(_orders(name), fitted[1:], spread[1:], strict=True):
            values[key], std[key] = float(value), float(own)
    return Features(one.run, None, values, std)


def observed(found, held_out=()):
    """(Observed, ...) of {run: Features} with one list of channels, {channel: SI unit}; what a run lacks is masked.

    Runs that show nothing are left out. Raises ConfigError where all do.
    """
    shown = {run: one for run, one in found.items() if one.values}
    if not shown:
        raise ConfigError("bench.poles", "runs that show a pole in two records each", f"none of {', '.join(found)}",
                          "widen low and high, or record longer")
    names = sorted({name for one in shown.values() for name in one.values}, key=_order)
    told = []
    for run, one in shown.items():
        valid = np.array([[name in one.values] for name in names])
        samples = np.array([[one.values.get(name, 0.0)] for name in names])
        std = np.array([one.std.get(name, 1.0) for name in names])
        told.append(Observed(run, one.run.conditions, tuple(names), samples, None, valid, noise_std=std,
                             held_out=run in held_out))
    return tuple(told), {name: _unit(name) for name in names}


def predicted(bench, one, channels, rules=DEFAULTS.poles):
    """(c, 1) of the features ``channels`` that the bench would have shown where Features ``one`` were seen; 0 for
    those that the run lacks."""
    values = {}
    if one.seen is not None:
        root, shape = modes(bench, one.run)
        own = merged(one.seen.root, root, assigned(one.seen, root, shape, rules), one.resolved)
        for k, near in enumerate(nearer(one.seen.root, own, rules), 1):
            values |= dict(zip(_named(k), (near.imag / (2 * np.pi), near.real), strict=True))
        told = motions(bench)
        for (first, second), (gain, delay) in _pairs(bench).items():
            values[gain] = np.log(abs(told[second].gain / told[first].gain))
            values[delay] = told[second].delay - told[first].delay
    for channel in bench.channels:
        if channel.measurand == JOINT_FORCE and _orders(channel.name)[0] in one.values:
            force = channel.gain * order_locked(bench, one.run, channel.source, ORDERS)
            parts = np.column_stack((force.real, force.imag)).ravel()
            values |= dict(zip(_orders(channel.name), parts, strict=True))
    return np.array([[values.get(name, 0.0) if name in one.values else 0.0] for name in channels])


def assigned(seen, root, shape, rules=DEFAULTS.poles):
    """Index (p,) of the root (r,) that explains each of the Poles ``seen``, by distance and shape.

    Each root explains one; a peak that none is left for, as where the model lacks a mode, falls to the likeliest.
    Eigenvalues that cross on the way to their peaks are paired by mode shape; a distance of several times the prior
    error counts less and less, so that a peak that is no mode does not move all others by one.
    """
    apart = abs(np.subtract.outer(seen.root, root)) / (rules.near * abs(seen.root))[:, None]
    cost = apart / np.sqrt(1 + (apart / rules.far) ** 2) + 1 - likeness(seen.shape, shape)
    found = cost.argmin(axis=1)
    peaks, roots = scipy.optimize.linear_sum_assignment(cost)
    found[peaks] = roots
    return found


def merged(seen, root, own, resolved):
    """What (p,) the roots ``own`` (indices) of peaks ``seen`` look like beside those that no peak is left for.

    Two roots that a record cannot tell apart show as one peak between them: it is taken to lie where it was seen.
    """
    found, rest = root[own], np.delete(root, own)
    for k, (peak, first) in enumerate(zip(seen, root[own], strict=True)):
        way = rest[abs(rest - first) < resolved] - first
        share = np.clip(np.real((peak - first) * way.conj()) / np.maximum(abs(way) ** 2, 1e-300), 0, 1)
        between = np.append(first, first + share * way)
        found[k] = between[np.argmin(abs(between - peak))]
    return found


def nearer(seen, root, rules=DEFAULTS.poles):
    """Roots (p,) drawn towards those ``seen``: as they are where close, never farther than ``reach`` of one.

    A peak that the model does not have is far from any root; how far says nothing.
    """
    apart = root - seen
    return seen + apart / np.sqrt(1 + abs(apart / (rules.reach * seen)) ** 2)


def _pairs(bench):
    """{(i, j): (feature, feature)} of motion channels at one sensor: logarithm of their ratio, and delay."""
    told = motions(bench)
    return {(i, j): (f"gain of {b.name} over {a.name}", f"delay of {b.name} behind {a.name}")
            for j, b in enumerate(told) for i, a in enumerate(told[:j]) if a.source == b.source}


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
