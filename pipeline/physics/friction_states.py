"""What friction remembers: states of a contact that grow and decay while it slides, and what they do to friction.

Every state obeys x' = s - r x, with s and r from the load N, the slip speed v >= 0, the friction force T and the area
A of the contact:

    memory    s = (v / L) (N, v), r = v / L            T = mu x_N, mu read at the load x_N and the speed x_v
    healing   s = v_0 / L,        r = v / L            mu (1 + b ln(1 + x)), x = v_0 theta / L: Dieterich's ageing law
    distance  s = v,              r = 0                mu is read at the distance x
    film      s = v p / (d p_0),  r = v / d            mu (1 + g x), p = N / A
    fade      s = |T| v / (A q tau), r = 1 / tau       mu / (1 + d x)
    plateaus  s = (1 + k) / tau,  r = (1 + k p v / q) / tau     mu x
    scatter   none                                     mu (1 + a cos(n angle - phase))

Steps are exact for constant s and r: first with those at the begin, which gives the friction of the step, then, once
its forces are known, with those of its middle, so that nothing is late by a part of a step.
"""

from dataclasses import astuple, dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact_groups import parts
from pipeline.physics.dry_friction import (
    DELAYED,
    FACTOR,
    LOAD_KEPT,
    LOAD_SHARE,
    READ_AT,
    SPEED_KEPT,
    SPEED_SHARE,
)

MEMORY, HEALING, DISTANCE, FILM, FADE, PLATEAUS, SCATTER = range(7)
#: below this a rate times a step counts as none, where series replace quotients
_SMALL = 1e-5


@dataclass(frozen=True)
class Memory:
    """Load and slip speed reach friction over the sliding way ``length`` m (V. Prakash, J. Tribol. 120 (1998) 97)."""

    length: float


@dataclass(frozen=True)
class Healing:
    """Friction grows with the age of the contact: ``share`` b, ``speed`` v_0 m/s, ``length`` L m."""

    share: float
    speed: float
    length: float


@dataclass(frozen=True)
class Distance:
    """The table of friction is read at the way slid so far, from ``Friction.distance`` on."""


@dataclass(frozen=True)
class Film:
    """A film that grows over the way ``length`` m to p / ``pressure`` (Pa) and adds ``gain`` times itself."""

    gain: float
    length: float
    pressure: float


@dataclass(frozen=True)
class Fade:
    """A temperature with the time constant ``time`` s, 1 under ``heat`` W/m^2, and friction that falls by ``drop``."""

    drop: float
    heat: float
    time: float


@dataclass(frozen=True)
class Plateaus:
    """Contact plateaus that friction power wears off: ``strength`` k, ``heat`` q W/m^2, ``time`` tau s."""

    strength: float
    heat: float
    time: float


@dataclass(frozen=True)
class Scatter:
    """Friction that varies around the drive: ``amplitude``, ``order``, ``phase`` rad, () or (c,)."""

    amplitude: float
    order: float
    phase: np.ndarray | float


_KIND = {Memory: MEMORY, Healing: HEALING, Distance: DISTANCE, Film: FILM, Fade: FADE, Plateaus: PLATEAUS,
         Scatter: SCATTER}
#: the states that come to rest in steady sliding, about which small motions are found; the others drift or turn
SETTLING = (MEMORY, HEALING, PLATEAUS)


class StateKernel(NamedTuple):
    """k states of c contacts."""

    kind: np.ndarray        # (k,)
    contact: np.ndarray     # (k,)
    parameter: np.ndarray   # (k, 3)
    area: np.ndarray        # (c,) m^2
    begin: np.ndarray       # (c,) m, distance where the table is read first


def state_kernel(friction, area):
    """StateKernel of a Friction, or of Grouped ones, for contacts of ``area`` (c,) m^2."""
    rows, begin = [], np.zeros(len(area))
    for law, own in parts(friction, len(area)):
        begin[own] = law.distance
        for state in law.states:
            values = np.zeros((len(area), 3))
            for k, value in enumerate(astuple(state)):
                values[:, k] = value
            rows += [(_KIND[type(state)], i, *values[i]) for i in own]
    rows = np.array(rows, float).reshape(-1, 5)
    if not np.isfinite(rows).all():
        raise ConfigError("friction states", "finite values", str(rows[~np.isfinite(rows).all(axis=1), 2:]))
    return StateKernel(rows[:, 0].astype(np.int64), rows[:, 1].astype(np.int64), np.array(rows[:, 2:]),
                       np.array(area, float), begin)


def started(states, load, speed):
    """States (k, 2) of contacts under ``load`` (c,) N that slide steadily at ``speed`` (c,) m/s, of either sign.

    Films are not yet there, heat neither; what starts at rest has just come to rest from the speed v_0 of its law.
    """
    value = np.zeros((len(states.kind), 2))
    for k, (kind, i) in enumerate(zip(states.kind, states.contact, strict=True)):
        swift = abs(speed[i])
        if kind == MEMORY:
            value[k] = load[i], swift
        elif kind == DISTANCE:
            value[k, 0] = states.begin[i]
        elif kind == HEALING and swift == 0:
            value[k, 0] = 1.0
        elif kind in SETTLING:
            source, rate = source_and_rate(kind, states.parameter[k], load[i], states.area[i], swift, 0.0)
            value[k, 0] = source / rate
    return value


def factors(states, value, angle):
    """Factor (c,) of states (k, 2) on friction, the drive standing at ``angle`` rad."""
    found = np.ones(len(states.area))
    for k, (kind, i) in enumerate(zip(states.kind, states.contact, strict=True)):
        found[i] *= factor(kind, states.parameter[k], value[k, 0], angle)
    return found


@njit(cache=True)
def source_and_rate(kind, p, load, area, speed, drawn):
    """(s, r) of a state under a load N, at a slip speed >= 0, with the friction force ``drawn`` >= 0 N."""
    if kind == HEALING:
        return p[1] / p[2], speed / p[2]
    if kind == DISTANCE:
        return speed, 0.0
    if kind == FILM:
        return speed / p[1] * load / (area * p[2]), speed / p[1]
    if kind == FADE:
        return drawn * speed / (area * p[1] * p[2]), 1.0 / p[2]
    if kind == PLATEAUS:
        return (1.0 + p[0]) / p[2], (1.0 + p[0] * load * speed / (area * p[1])) / p[2]
    return 0.0, 0.0


@njit(cache=True)
def factor(kind, p, x, angle):
    """What a state makes of friction; 1 where it does not act as a factor."""
    if kind == HEALING:
        return 1.0 + p[0] * np.log1p(x)
    if kind == FILM:
        return 1.0 + p[0] * x
    if kind == FADE:
        return 1.0 / (1.0 + p[0] * x)
    if kind == PLATEAUS:
        return x
    if kind == SCATTER:
        return 1.0 + p[0] * np.cos(p[1] * angle - p[2])
    return 1.0


@njit(cache=True)
def _kept(reach):
    """(e^-z, (1 - e^-z) / z) of z = ``reach``: what is left of a state, and the mean of that."""
    keep = np.exp(-reach)
    return keep, (1.0 - keep) / reach if reach > _SMALL else 1.0 - 0.5 * reach


@njit(cache=True)
def expect(states, value, friction, load, slip, drawn, angle, turned, step, middle):
    """Fill the columns of ``friction`` for the step to come, from states ``value`` (k, 2) and forces at its begin.

    ``load``, ``slip``, ``drawn`` (c,) are N, slip speed and T there, of either sign; the drive goes from ``angle`` to
    ``turned``. ``middle``: friction acts by its mean over the step, else by its end.
    """
    friction.contact[:, FACTOR] = 1.0
    share = 0.5 if middle else 1.0
    for k in range(states.kind.size):
        kind, i, p = states.kind[k], states.contact[k], states.parameter[k]
        own, speed = friction.contact[i], abs(slip[i])
        if kind == MEMORY:
            keep, mean = _kept(step * speed / p[0])
            last, first = 1.0 - mean, mean - keep
            own[DELAYED] = 1.0
            own[LOAD_KEPT] = keep * value[k, 0] + first * load[i]
            own[SPEED_KEPT] = keep * value[k, 1] + first * speed
            own[LOAD_SHARE] = own[SPEED_SHARE] = last
            if middle:      # the mean slip speed is known to friction, that of the end is twice it less the begin
                own[LOAD_KEPT] = 0.5 * (value[k, 0] + own[LOAD_KEPT])
                own[SPEED_KEPT] = 0.5 * (value[k, 1] + own[SPEED_KEPT] - last * speed)
                own[LOAD_SHARE] = 0.5 * last
            continue
        source, rate = source_and_rate(kind, p, load[i], states.area[i], speed, abs(drawn[i]))
        keep, mean = _kept(rate * step)
        after = keep * value[k, 0] + mean * step * source
        if kind == DISTANCE:
            own[READ_AT] = (1.0 - share) * value[k, 0] + share * after
        else:
            own[FACTOR] *= ((1.0 - share) * factor(kind, p, value[k, 0], angle)
                            + share * factor(kind, p, after, turned))


@njit(cache=True)
def settle(states, value, load, loaded, slip, slipped, drawn, step):
    """Bring states ``value`` (k, 2) to the end of a step.

    ``load`` and ``loaded`` (c,) are N at its begin and end, ``slip`` and ``slipped`` the slip speeds, ``drawn`` the
    mean T. Contacts that are open remember no load.
    """
    for k in range(states.kind.size):
        kind, i, p = states.kind[k], states.contact[k], states.parameter[k]
        one, other = abs(slip[i]), abs(slipped[i])
        if kind == MEMORY:
            keep, mean = _kept(step * 0.5 * (one + other) / p[0])
            value[k, 0] = keep * value[k, 0] + (mean - keep) * load[i] + (1.0 - mean) * loaded[i]
            value[k, 1] = keep * value[k, 1] + (mean - keep) * one + (1.0 - mean) * other
            if loaded[i] == 0.0:
                value[k, 0] = 0.0
            continue
        source, rate = source_and_rate(kind, p, 0.5 * (load[i] + loaded[i]), states.area[i], 0.5 * (one + other),
                                       abs(drawn[i]))
        keep, mean = _kept(rate * step)
        value[k, 0] = keep * value[k, 0] + mean * step * source
