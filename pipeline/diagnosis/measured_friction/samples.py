"""Measured coefficients of friction with their conditions: from tables, or from the strokes of a tribometer."""

from dataclasses import dataclass, fields

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: parts of a slide whose means tell how much it scatters
_PARTS = 4
#: samples of a slide, at least
_FEWEST = 4 * _PARTS
#: share of the largest speed below which a tribometer turns round
_SLOW = 0.1


@dataclass(frozen=True)
class Samples:
    """Coefficients of ``friction`` (n,) with standard errors ``friction_std`` (0: not stated), ``pressure`` Pa,
    ``speed`` m/s, sliding ``distance`` m, ``temperature`` K, and the ``run`` (n,) that each comes from."""

    friction: np.ndarray
    friction_std: np.ndarray
    pressure: np.ndarray
    speed: np.ndarray
    distance: np.ndarray
    temperature: np.ndarray
    run: np.ndarray

    def __len__(self):
        return len(self.friction)


def joined(every):
    """All of several Samples."""
    return Samples(*(np.concatenate([getattr(s, f.name) for s in every]) for f in fields(Samples)))


def tabulated(name, table):
    """Samples of a product MeasuredFriction of a run. ConfigError for what cannot be a coefficient of friction."""
    values = [np.atleast_1d(getattr(table, f.name)) for f in fields(Samples)[:-1]]
    made = Samples(*values, np.full(len(values[0]), name))
    for what in ("friction", "pressure", "speed"):
        wrong = np.flatnonzero(~(getattr(made, what) > 0))
        if len(wrong):
            raise ConfigError(f"run {name}: {what}", "values above 0", f"{getattr(made, what)[wrong[0]]:g} in row"
                              f" {wrong[0] + 1}", "take the magnitude of friction and speed")
    if made.friction.max() > 10:
        raise ConfigError(f"run {name}: friction", "coefficients, a few tenths as a rule", f"{made.friction.max():g}",
                          "state its unit: percent is %")
    return made


def of_slides(name, load, friction, position, rate, area, temperature, settle=0.5, before=0.0):
    """Samples of the slides of a reciprocating tribometer, two neighbours each way make one.

    ``load``, ``friction`` N and ``position`` m (n,) at ``rate`` Hz, NaN where a sample is missing; ``area`` m^2 is
    nominal; ``temperature`` K; ``before`` m were slid before the first sample; the first ``settle`` of the way of a
    slide is left out, over which friction builds up. Half the difference of two neighbours leaves out what does not
    turn round with the motion (offsets, a tilted load).
    """
    every = (_slide(part, load, friction, position, rate, settle) for part in _one_way(position, rate))
    slides = [slide for slide in every if slide]
    pairs = [(a, b) for a, b in zip(slides[::2], slides[1::2], strict=False) if a["way"] != b["way"]]
    if not pairs:
        raise ConfigError(f"run {name}: position", "slides both ways, each of sixteen samples or more after it has"
                          " settled", f"{len(slides)} slides one way", "a longer stretch, or a smaller settle")
    travelled = np.nancumsum(abs(np.diff(position, prepend=position[:1])))

    def mean(what):
        return np.array([(a[what] + b[what]) / 2 for a, b in pairs])

    pressed = mean("load")
    if not (pressed > 0).all():
        raise ConfigError(f"run {name}: load", "a load above 0", f"{pressed.min():g} N", "turn its sign by factor: -1")
    turning = np.array([abs(a["friction"] - b["friction"]) / 2 for a, b in pairs])
    error = np.array([np.hypot(a["error"], b["error"]) / 2 for a, b in pairs])
    distance = np.array([before + travelled[b["middle"]] for _, b in pairs])
    return Samples(turning / pressed, error / pressed, pressed / area, mean("speed"), distance,
                   np.full(len(pairs), float(temperature)), np.full(len(pairs), name))


def _one_way(position, rate):
    """[slice] of the stretches over which a position (n,) moves one way faster than a share of its largest speed."""
    known = np.isfinite(position)
    course = np.interp(np.arange(len(position)), np.flatnonzero(known), position[known])
    width = min(max(5, 2 * (len(course) // 400) + 1), len(course) - 1 + len(course) % 2)
    speed = scipy.signal.savgol_filter(course, width, 2, deriv=1, delta=1 / rate)
    way = np.where(abs(speed) > _SLOW * np.quantile(abs(speed), 0.95), np.sign(speed), 0)
    edges = np.flatnonzero(np.diff(way, prepend=0, append=0))
    return [slice(a, b) for a, b in zip(edges, edges[1:], strict=False) if way[a] != 0]


def _slide(part, load, friction, position, rate, settle):
    """{load, friction, error of friction, speed, way, middle index} of one slide once it has settled, or None."""
    course = position[part][np.isfinite(position[part])]
    way = course[-1] - course[0] if len(course) else 0.0
    if way == 0.0:
        return None
    settled = abs(position[part] - course[0]) >= settle * abs(way)
    kept = part.start + np.flatnonzero(settled & np.isfinite(friction[part] + load[part]))
    if len(kept) < _FEWEST:
        return None
    parts = [friction[p].mean() for p in np.array_split(kept, _PARTS)]
    return {"load": load[kept].mean(), "friction": friction[kept].mean(),
            "error": np.std(parts, ddof=1) / np.sqrt(_PARTS), "way": float(np.sign(way)),
            "speed": abs(position[kept[-1]] - position[kept[0]]) / ((kept[-1] - kept[0]) / rate),
            "middle": int(kept[len(kept) // 2])}
