"""States of friction within a time step, compiled: their equations, what they do to friction, and how they go on.

The equations x' = s - r x are those of ``friction_states``. Steps are exact for constant s and r: first with those at
the begin, which gives the friction of the step, then, once its forces are known, with those of its middle, so that
nothing is late by a part of a step.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.dry_friction import (
    DELAYED,
    FACTOR,
    LOAD_KEPT,
    LOAD_SHARE,
    READ_AT,
    SPEED_KEPT,
    SPEED_SHARE,
)
from pipeline.physics.numerics.compiled import borrowing

MEMORY, DISTANCE, SCATTER, EVOLVING = range(4)
#: what a state x that evolves makes of friction, g being its gain: 1 + g x, 1 + g ln(1 + x), 1 / (1 + g x), x
LINEAR, LOGARITHMIC, INVERSE, ITSELF = range(4)
#: columns of StateKernel.parameter of a state that evolves: source and rate over (1, v, p v, q), form, gain, whether it
#: comes to rest in steady sliding, where it begins at rest
SOURCE, RATE, FORM, GAIN, SETTLES, AT_REST = 0, 4, 8, 9, 10, 11
PARAMETERS = 12
#: below this a rate times a step counts as none, where series replace quotients
_SMALL = 1e-5


class StateKernel(NamedTuple):
    """k states of c contacts."""

    kind: np.ndarray        # (k,)
    contact: np.ndarray     # (k,)
    parameter: np.ndarray   # (k, PARAMETERS)
    area: np.ndarray        # (c,) m^2
    begin: np.ndarray       # (c,) m, distance where the table is read first


def settles(states):
    """True (k,) for states that come to rest in steady sliding, about which small motions are; others drift or turn."""
    return (states.kind == MEMORY) | ((states.kind == EVOLVING) & (states.parameter[:, SETTLES] > 0))


@borrowing
def source_and_rate(kind, p, load, area, speed, drawn):
    """(s, r) of a state under a load N, at a slip speed >= 0, with the friction force ``drawn`` >= 0 N."""
    if kind == DISTANCE:
        return speed, 0.0
    if kind == EVOLVING:
        rubbed, heat = load * speed / area, drawn * speed / area
        return (p[SOURCE] + p[SOURCE + 1] * speed + p[SOURCE + 2] * rubbed + p[SOURCE + 3] * heat,
                p[RATE] + p[RATE + 1] * speed + p[RATE + 2] * rubbed + p[RATE + 3] * heat)
    return 0.0, 0.0


@borrowing
def factor(kind, p, x, angle):
    """What a state makes of friction; 1 where it does not act as a factor."""
    if kind == EVOLVING:
        if p[FORM] == LINEAR:
            return 1.0 + p[GAIN] * x
        if p[FORM] == LOGARITHMIC:
            return 1.0 + p[GAIN] * np.log1p(x)
        return 1.0 / (1.0 + p[GAIN] * x) if p[FORM] == INVERSE else x
    if kind == SCATTER:
        return 1.0 + p[0] * np.cos(p[1] * angle - p[2])
    return 1.0


def state_slopes(p, x, load, area, speed):
    """(r, and what x' changes by over N and over v at a state ``x``) of one that settles, whatever the heat."""
    heard = [p[first + 1] + p[first + 2] * load / area for first in (SOURCE, RATE)]
    pressed = [p[first + 2] * speed / area for first in (SOURCE, RATE)]
    rate = source_and_rate(EVOLVING, p, load, area, speed, 0.0)[1]
    return rate, pressed[0] - x * pressed[1], heard[0] - x * heard[1]


def factor_slope(p, x):
    """Change of friction with a state that evolves, as a share of friction."""
    if p[FORM] == ITSELF:
        return 1.0 / x
    inner = {LINEAR: 1.0, LOGARITHMIC: 1.0 / (1.0 + x)}.get(int(p[FORM]))
    if inner is None:
        return -p[GAIN] / (1.0 + p[GAIN] * x)
    return p[GAIN] * inner / factor(EVOLVING, p, x, 0.0)


@borrowing
def _kept(reach):
    """(e^-z, (1 - e^-z) / z) of z = ``reach``: what is left of a state, and the mean of that."""
    keep = np.exp(-reach)
    return keep, (1.0 - keep) / reach if reach > _SMALL else 1.0 - 0.5 * reach


@borrowing
def advanced(kind, p, x, load, area, speed, drawn, step):
    """A state ``x`` a ``step`` s later, under a load N, a slip speed and a friction force ``drawn`` >= 0 that stay."""
    source, rate = source_and_rate(kind, p, load, area, speed, drawn)
    keep, mean = _kept(rate * step)
    return keep * x + mean * step * source


@borrowing
def expect(states, value, friction, load, slip, drawn, angle, turned, step, middle):
    """Fill the columns of ``friction`` for the step to come, from states ``value`` (k, 2) and forces at its begin.

    ``load``, ``slip``, ``drawn`` (c,) are N, slip speed and T there, of either sign; the drive goes from ``angle`` to
    ``turned``. ``middle``: friction acts by its mean over the step, else by its end.
    """
    friction.contact[:, FACTOR] = 1.0
    share = 0.5 if middle else 1.0
    for k in range(states.kind.size):
        kind, i, p = states.kind[k], states.contact[k], states.parameter[k]
        j, speed = friction.contact[i], abs(slip[i])
        if kind == MEMORY:
            keep, mean = _kept(step * speed / p[0])
            last, first = 1.0 - mean, mean - keep
            j[DELAYED] = 1.0
            j[LOAD_KEPT] = keep * value[k, 0] + first * load[i]
            j[SPEED_KEPT] = keep * value[k, 1] + first * speed
            j[LOAD_SHARE] = j[SPEED_SHARE] = last
            if middle:      # the mean slip speed is known to friction, that of the end is twice it less the begin
                j[LOAD_KEPT] = 0.5 * (value[k, 0] + j[LOAD_KEPT])
                j[SPEED_KEPT] = 0.5 * (value[k, 1] + j[SPEED_KEPT] - last * speed)
                j[LOAD_SHARE] = 0.5 * last
            continue
        after = advanced(kind, p, value[k, 0], load[i], states.area[i], speed, abs(drawn[i]), step)
        if kind == DISTANCE:
            j[READ_AT] = (1.0 - share) * value[k, 0] + share * after
        else:
            j[FACTOR] *= ((1.0 - share) * factor(kind, p, value[k, 0], angle)
                            + share * factor(kind, p, after, turned))


@borrowing
def settle(states, value, load, loaded, slip, slipped, drawn, step):
    """Bring states ``value`` (k, 2) to the end of a step.

    ``load`` and ``loaded`` (c,) are N at its begin and end, ``slip`` and ``slipped`` the slip speeds, ``drawn`` the
    mean T. Contacts that are open remember no load.
    """
    for k in range(states.kind.size):
        kind, i, p = states.kind[k], states.contact[k], states.parameter[k]
        speed, other = abs(slip[i]), abs(slipped[i])
        if kind == MEMORY:
            keep, mean = _kept(step * 0.5 * (speed + other) / p[0])
            value[k, 0] = keep * value[k, 0] + (mean - keep) * load[i] + (1.0 - mean) * loaded[i]
            value[k, 1] = keep * value[k, 1] + (mean - keep) * speed + (1.0 - mean) * other
            if loaded[i] == 0.0:
                value[k, 0] = 0.0
            continue
        value[k, 0] = advanced(kind, p, value[k, 0], 0.5 * (load[i] + loaded[i]), states.area[i], 0.5 * (speed + other),
                               abs(drawn[i]), step)
