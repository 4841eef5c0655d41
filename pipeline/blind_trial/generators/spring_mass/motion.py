"""Motion of a rig with hidden physics, by LSODA of adaptive step and order; filters of sensors are integrated with it.

    m_i(t) x_i'' = sum_links -+ (k e + c v + F(t, e, v, z)) + f(t),    z' = G(t, e, v, z),    y' = w (x - y)

A. C. Hindmarsh, ODEPACK (1983). Forces between samples are joined linearly, as the amplifier puts them out.
"""

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.integrate import ODEintWarning, odeint

from pipeline.contract.errors import ConvergenceError

RELATIVE, ABSOLUTE = 1e-6, 1e-9
#: instants at which the state is kept, per sample; jumps happen there only
PARTS = 8


@dataclass(frozen=True)
class Law:
    """A hidden force along ``row`` (n,): ``force(t, e, v, z)`` N, with ``states`` z that change by ``rates``."""

    row: np.ndarray
    force: object
    states: int = 0
    rates: object = None


@dataclass(frozen=True)
class World:
    """What a rig is in truth: its ``laws``, masses over time ``mass(t)`` (n,), ``jump(x, v)`` -> v at impacts."""

    rig: object
    laws: tuple = ()
    mass: object = None
    jump: object = None


def moved(world, force, interval, corner):
    """Filtered displacements (sensor, instant) at PARTS instants a sample, under ``force`` (sample,) N from rest.

    ``corner`` Hz of the first-order filters. Raises ConvergenceError.
    """
    size = len(world.rig.mass)
    grid = interval * np.arange(len(force))
    time = np.linspace(0, grid[-1], PARTS * (len(force) - 1) + 1)
    rate = rates(world, grid, np.asarray(force, float), 2 * np.pi * corner)
    start = np.zeros(3 * size + sum(law.states for law in world.laws))
    if world.jump is None:
        return _integrated(rate, start, time, interval)[:, 2 * size:3 * size].T
    states = [start]
    for now, later in zip(time[:-1], time[1:], strict=True):
        state = _integrated(rate, states[-1], np.array([now, later]), interval)[-1]
        state[size:2 * size] = world.jump(state[:size], state[size:2 * size])
        states.append(state)
    return np.array(states)[:, 2 * size:3 * size].T


def _integrated(rate, start, time, interval):
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", ODEintWarning)
        states, information = odeint(rate, start, time, tfirst=True, rtol=RELATIVE, atol=ABSOLUTE, hmax=interval,
                              mxstep=5000, full_output=True)
    if information["message"] != "Integration successful." or not np.isfinite(states).all():
        raise ConvergenceError("motion of a trial", "an integration that succeeds", information["message"])
    return states


def rates(world, times, pushed, reach):
    """The right-hand side ``rate(t, state)`` under forces ``pushed`` at instants ``times``, filters of ``reach`` rad/s.

    States are displacements, velocities, filtered displacements, then those of laws.
    """
    rig, size, rows = world.rig, len(world.rig.mass), world.rig.rows
    stiffness = rows.T @ np.diag([link.stiffness for link in rig.links]) @ rows
    damping = rows.T @ np.diag([link.damping for link in rig.links]) @ rows
    fixed, push = np.array(rig.mass), np.eye(size)[rig.pushed]

    def rate(time, state):
        displacement, speed = state[:size], state[size:2 * size]
        total = push * np.interp(time, times, pushed) - stiffness @ displacement - damping @ speed
        change, first = np.empty(len(state)), 3 * size
        for law in world.laws:
            e, v, z = law.row @ displacement, law.row @ speed, state[first:first + law.states]
            total = total - law.row * law.force(time, e, v, z)
            if law.states:
                change[first:first + law.states] = law.rates(time, e, v, z)
            first += law.states
        change[:size], change[size:2 * size] = speed, total / (fixed if world.mass is None else world.mass(time))
        change[2 * size:3 * size] = reach * (displacement - state[2 * size:3 * size])
        return change

    return rate
