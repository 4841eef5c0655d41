"""Steps of the sliding motion, compiled: the linear part exact, what remains of the contact forces linear over a step.

    z1 = e^(s h) z0 + A f0 + B f1,      B = (e^(s h) - 1 - s h) / (s^2 h),      A = (e^(s h) - 1) / s - B,

with the modal forces f = psi^T r at both ends (exponential time differencing; Cox & Matthews, J. Comput. Phys. 176
(2002) 430). The contact forces r at the end depend on the motion there, which is linear in them: they are solved for by
Newton's method with a line search, in which only patches count whose forces change stiffly with the motion. No step is
accepted that has not converged.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.sliding_motion.patch_forces import beyond_linear

DONE, UNSETTLED = 0, 1
SWEEPS, TOLERANCE, SHORTEST = 200, 3e-5, 1e-4
#: change of the force of a patch with itself, over one step, beyond which Newton's method counts it
STIFF = 0.1
#: columns of the energies: work of contact forces, lost in bodies and joints, in the damping added, stored
WORK, LOSS, ADDED, STORED = range(4)
#: sums may be reordered to use the width of the processor; nothing else is relaxed
_FAST = {"reassoc", "contract", "nsz"}


class StepKernel(NamedTuple):
    """One step of m modes in real coordinates (Re z, Im z) under p patches; factors (2, m) are real, imaginary."""

    decay: np.ndarray
    begin: np.ndarray
    end: np.ndarray
    motion: np.ndarray      # (4 p, 2m) u, u', v, w of the patches
    force: np.ndarray       # (3 p, 2m) modal forces of unit forces along normals, tangents and lateral rows
    response: np.ndarray    # (4 p, 3 p) of the motion at the end of a step to the forces there
    own: np.ndarray         # (p, 4, 3) that of each patch to its own forces
    step: float             # s


class EnergyKernel(NamedTuple):
    """Quadratic forms (2m, 2m): stored energy (J); power (W) of the linear contact forces, lost in bodies and joints,
    and lost by moved roots; empty: no book."""

    stored: np.ndarray
    contact: np.ndarray
    loss: np.ndarray
    added: np.ndarray


class Record(NamedTuple):
    """What is kept every so many steps."""

    state: np.ndarray       # (r, 2m)
    share: np.ndarray       # (r, 2) share of the contacts that are open, of the patches that stick
    energy: np.ndarray      # (r, 4) J: WORK, LOSS, ADDED, STORED


def step_kernel(root, motion, force, step):
    """StepKernel of roots (m,) for steps of ``step`` s; ``motion`` and ``force`` as in it."""
    turn = root * step
    growth = np.expm1(turn)
    end = (growth - turn) / (root**2 * step)
    begin = growth / root - end
    m, reached = len(root), force.T.copy()
    reached[:m], reached[m:] = (end.real[:, None] * force.T[:m] - end.imag[:, None] * force.T[m:],
                                end.real[:, None] * force.T[m:] + end.imag[:, None] * force.T[:m])
    factors = (np.array([each.real, each.imag]) for each in (growth + 1, begin, end))
    response, p = np.ascontiguousarray(motion @ reached), len(force) // 3
    patch = np.arange(p)
    own = np.ascontiguousarray(response.reshape(4, p, 3, p)[:, patch, :, patch])
    return StepKernel(*factors, motion, force, response, own, float(step))


@njit
def _times(factor, values, result):
    """Add complex ``factor`` (2, m) times ``values`` (2m,) to ``result`` (2m,)."""
    m = factor.shape[1]
    for q in range(m):
        result[q] += factor[0, q] * values[q] - factor[1, q] * values[m + q]
        result[m + q] += factor[0, q] * values[m + q] + factor[1, q] * values[q]


@njit(fastmath=_FAST)
def multiply(matrix, values, result):
    """Add ``matrix`` (r, n) times ``values`` (n,) to ``result`` (r,)."""
    for i in range(matrix.shape[0]):
        total = 0.0
        for q in range(values.size):
            total += matrix[i, q] * values[q]
        result[i] += total


@njit(fastmath=_FAST)
def spread(matrix, values, result):
    """Fill ``result`` (n,) with ``values`` (r,) times ``matrix`` (r, n)."""
    for q in range(result.size):
        result[q] = 0.0
    for i in range(values.size):
        factor = values[i]
        for q in range(result.size):
            result[q] += factor * matrix[i, q]


@njit
def advance(patches, steps, energy, state, rest, previous, done, count, every, record, spent):
    """(code, step, sweeps) after the steps ``done`` + 1 to ``count`` from ``state`` (2m,), which ends where they end,
    as do the others.

    ``rest`` (3, p) contact forces beyond the linear ones at the begin, and ``previous`` those a step before;
    ``spent`` (3,) J: WORK, LOSS, ADDED so far. A step without a solution leaves all as it was before it.
    """
    size, p = state.size, patches.load.size
    base, force, y, free = np.empty(size), np.empty(size), np.empty((4, p)), np.empty(4 * p)
    guess, trial, reply, slope = np.empty(3 * p), np.empty(3 * p), np.empty((3, p)), np.zeros((p, 3, 4))
    error, change = np.empty(3 * p), np.empty(3 * p)
    limit, sweeps = TOLERANCE * np.sqrt(np.sum(patches.load**2)), 0
    book, power, power_end = energy.stored.size > 0, np.zeros(3), np.zeros(3)
    spread(steps.force, rest.ravel(), force)
    if book:
        y[:] = 0.0
        multiply(steps.motion, state, y.ravel())
        _powers(energy, state, y, rest, power)
    for number in range(done + 1, count + 1):
        base[:] = 0.0
        _times(steps.decay, state, base)
        _times(steps.begin, force, base)
        free[:] = 0.0
        multiply(steps.motion, base, free)
        for q in range(3 * p):
            trial[q] = 2.0 * rest.ravel()[q] - previous.ravel()[q]
        settled, last, length = False, np.inf, 1.0
        for _ in range(SWEEPS):
            y.ravel()[:] = free
            multiply(steps.response, trial, y.ravel())
            beyond_linear(patches, y, reply, slope)
            error[:] = reply.ravel() - trial
            sweeps, miss = sweeps + 1, np.sqrt(error @ error)
            if miss <= limit:
                settled = True
                break
            if not miss < last and length > SHORTEST:
                length *= 0.5
                trial[:] = guess + length * change
                continue
            if not miss < np.inf:
                break
            guess[:], last, length = trial, miss, 1.0
            _newton(steps.response, steps.own, slope, error, change)
            trial[:] = guess + change
        if not settled:
            return UNSETTLED, number, sweeps
        previous[:], rest[:] = rest, reply
        spread(steps.force, rest.ravel(), force)
        state[:] = base
        _times(steps.end, force, state)
        if book:
            _powers(energy, state, y, rest, power_end)
            spent += 0.5 * steps.step * (power + power_end)
            power[:] = power_end
        if number % every == 0:
            row = number // every - 1
            record.state[row] = state
            record.share[row] = _shares(patches, y)
            if book:
                record.energy[row, :STORED] = spent
                record.energy[row, STORED] = state @ (energy.stored @ state)
    return DONE, count, sweeps


@njit
def modal_rate(patches, motion, force, root, state, result):
    """Fill ``result`` (2m,) with dz/dt at ``state`` (2m,); ``root`` (2, m): real, imaginary, rows as in StepKernel."""
    p = patches.load.size
    y, rest = np.zeros((4, p)), np.empty((3, p))
    multiply(motion, state, y.ravel())
    beyond_linear(patches, y, rest, np.empty((p, 3, 4)))
    spread(force, rest.ravel(), result)
    _times(root, state, result)


@njit
def observed(patches, motion, energy, state, power):
    """Shares at ``state`` (2m,), see Record, and ``power`` (3,) W filled: WORK, LOSS, ADDED, if there is a book."""
    p = patches.load.size
    y, rest = np.zeros((4, p)), np.empty((3, p))
    multiply(motion, state, y.ravel())
    if energy.stored.size:
        beyond_linear(patches, y, rest, np.zeros((p, 3, 4)))
        _powers(energy, state, y, rest, power)
    return _shares(patches, y)


@njit
def _newton(response, own, slope, error, change):
    """Fill ``change`` (3p,) of the forces with a step of Newton's method for their ``error`` (3p,).

    Slopes (p, 3, 4) count at the patches that are stiff; the others follow their error.
    """
    p = len(slope)
    change[:] = error
    stiff, count = np.empty(p, np.int64), 0
    for i in range(p):
        most = 0.0
        for f in range(3):
            for g in range(3):
                total = 0.0
                for o in range(4):
                    total += slope[i, f, o] * own[i, o, g]
                most = max(most, abs(total))
        if most > STIFF:
            stiff[count] = i
            count += 1
    if count == 0:
        return
    matrix, side, aside = np.zeros((3 * count, 3 * count)), np.empty(3 * count), error.copy()
    for a in range(count):
        for f in range(3):
            aside[f * p + stiff[a]] = 0.0
    moved = np.zeros(4)
    for a in range(count):
        i = stiff[a]
        for o in range(4):
            moved[o] = response[o * p + i] @ aside
        for f in range(3):
            side[3 * a + f] = error[f * p + i] + slope[i, f] @ moved
            for b in range(count):
                for g in range(3):
                    total = 0.0
                    for o in range(4):
                        total += slope[i, f, o] * response[o * p + i, g * p + stiff[b]]
                    matrix[3 * a + f, 3 * b + g] = -total
            matrix[3 * a + f, 3 * a + f] += 1.0
    side = np.linalg.solve(matrix, side)
    for a in range(count):
        for f in range(3):
            change[f * p + stiff[a]] = side[3 * a + f]


@njit
def _powers(energy, state, y, rest, power):
    """Fill ``power`` (3,) W at ``state``: WORK, LOSS, ADDED."""
    power[WORK] = state @ (energy.contact @ state)
    for row in range(3):
        power[WORK] += rest[row] @ y[row + 1]
    power[LOSS], power[ADDED] = state @ (energy.loss @ state), state @ (energy.added @ state)


@njit
def _shares(patches, y):
    """Shares of the contacts that are open and of the patches that stick."""
    closed = sticking = 0.0
    for i in range(patches.load.size):
        row = int((y[0, i] - patches.lowest) / patches.interval)
        closed += patches.closed[i, min(max(row, 0), patches.closed.shape[1] - 1)]
        if np.hypot(patches.speed[i] - y[2, i], y[3, i]) < patches.stick_speed:
            sticking += 1.0
    return 1.0 - closed / patches.contacts, sticking / patches.load.size
