"""Motion of linear rigs, exact for forces that are linear between samples: by the exponential over a step."""

import numpy as np
from scipy.linalg import expm
from scipy.signal import lfilter

from pipeline.blind_trial.generators.spring_mass.motion import PARTS, rates

#: condition of shapes of motion beyond which they are all but alike
_ALIKE = 1e8
#: instants, s, at which laws are looked at for whether they are linear
_INSTANTS = (0.0, 0.7, 3.1)


def linear(rig, force, interval, corner):
    """Filtered displacements (sensor, instant) of a rig alone, as ``motion.moved``, by its exponential over a step."""
    return _states(rig, force, interval, corner)[:, 2 * len(rig.mass):].T


def coarse(rig, force, interval, corner):
    """The same where displacements count as straight between samples: what a model of so long a step shows."""
    states, reach = _states(rig, force, interval, corner), np.array([[-2 * np.pi * corner]])
    instants = np.arange(len(states)) / PARTS
    kept, now, ramp = _held(reach, -reach[0], interval / PARTS)
    displacements = []
    for displacement in states[:, :len(rig.mass)].T:
        straight = np.interp(instants, instants[::PARTS], displacement[::PARTS])
        fed = now * straight[:-1] + ramp * np.diff(straight)
        displacements.append(lfilter([1.0], [1.0, -kept.item()], np.append(0.0, fed)))
    return np.array(displacements)


def linear_world(world, forces, interval, corner):
    """[(sensor, instant)] under each of ``forces``, as ``linear``, of a World whose laws are linear and do not change;
    None of another."""
    size, reach = len(world.rig.mass), 2 * np.pi * corner
    still, pushed = (rates(world, np.array([0.0, 1.0]), np.full(2, push), reach) for push in (0.0, 1.0))
    if world.jump or world.mass:
        return None
    states = 3 * size + sum(law.states for law in world.laws)
    matrix = np.array([still(0.0, direction) for direction in np.eye(states)]).T
    for time, state in zip(_INSTANTS, np.random.default_rng(0).standard_normal((len(_INSTANTS), states)), strict=True):
        if not np.allclose(still(time, state), matrix @ state, rtol=1e-9, atol=1e-9 * abs(matrix @ state).max()):
            return None
    push = pushed(0.0, np.zeros(states))
    return [driven(matrix, push, force, interval)[:, 2 * size:3 * size].T for force in forces]


def driven(matrix, push, force, interval):
    """States (instant, s) of x' = ``matrix`` x + ``push`` f from rest, the forces (n,) joined linearly."""
    size, step = len(push), interval / PARTS
    kept, now, ramp = _held(matrix, push, step)
    fine = np.interp(np.arange(PARTS * (len(force) - 1) + 1) / PARTS, np.arange(len(force)), force)
    pushed = np.outer(fine[:-1], now) + np.outer(np.diff(fine), ramp)
    factors, shapes = np.linalg.eig(kept)
    if np.linalg.cond(shapes) > _ALIKE:
        return _marched(kept, pushed)
    modal = np.vstack((np.zeros(size), pushed @ np.linalg.inv(shapes).T))
    return np.real(np.array([lfilter([1.0], [1.0, -factor], g) for factor, g in zip(factors, modal.T, strict=True)]).T
                   @ shapes.T)


def _states(rig, force, interval, corner):
    """(instant, displacements, velocities and filtered displacements) of a rig alone."""
    size, rows, reach = len(rig.mass), rig.rows, 2 * np.pi * corner
    inverse = np.diag(1 / np.array(rig.mass))
    stiffness, damping = (rows.T @ np.diag([getattr(link, what) for link in rig.links]) @ rows
                          for what in ("stiffness", "damping"))
    none, unit = np.zeros((size, size)), np.eye(size)
    matrix = np.block([[none, unit, none], [-inverse @ stiffness, -inverse @ damping, none],
                       [reach * unit, none, -reach * unit]])
    push = np.concatenate((np.zeros(size), inverse[rig.pushed], np.zeros(size)))
    return driven(matrix, push, force, interval)


def _marched(kept, pushed):
    """The same step by step: where shapes of motion are all but alike, a state is no sum of them."""
    states = np.zeros((len(pushed) + 1, len(kept)))
    for k, more in enumerate(pushed):
        states[k + 1] = kept @ states[k] + more
    return states


def _held(rates, push, step):
    """(transition, answer to a constant, answer to a ramp from 0 to 1) over a step: C. Van Loan (1978)."""
    size = len(push)
    whole = np.zeros((size + 2, size + 2))
    whole[:size, :size], whole[:size, size], whole[size, size + 1] = rates * step, push * step, 1.0
    transition = expm(whole)
    return transition[:size, :size], transition[:size, size], transition[:size, size + 1]
