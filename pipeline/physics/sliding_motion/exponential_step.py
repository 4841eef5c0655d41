"""Steps of the sliding motion, compiled: the linear part exact, what remains of the contact forces linear over a step.

    z1 = e^(s h) z0 + A f0 + B f1,      B = (e^(s h) - 1 - s h) / (s^2 h),      A = (e^(s h) - 1) / s - B,

with the modal forces f = psi^T r at both ends (exponential time differencing; Cox & Matthews, J. Comput. Phys. 176
(2002) 430). The contact forces r at the end depend on the motion there, which is linear in them: they are solved for by
Newton's method with a line search, in which only patches count whose forces change stiffly with the motion. No step is
accepted that has not converged. The first guess is extrapolated from earlier steps, in modal forces too, so that the
motion by it costs no product of its own; afterwards the motion follows the changes of the forces.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.sliding_motion.attached_elements import beyond_slopes
from pipeline.physics.sliding_motion.compiled_products import FAST, add_rows, multiply, spread, times
from pipeline.physics.sliding_motion.patch_forces import beyond_linear, foresee, remember

DONE, UNSETTLED = 0, 1
SWEEPS, TOLERANCE, SHORTEST = 200, 3e-5, 1e-4
#: from so many steps contact forces are extrapolated, by one of these rows: along a line, a parabola, a cubic
DEPTH = 4
_AHEAD = np.array([[2.0, -1.0, 0.0, 0.0], [3.0, -3.0, 1.0, 0.0], [4.0, -6.0, 4.0, -1.0]])
#: share of the tolerance that all changes of forces have together which a sweep may leave to the next
NEGLIGIBLE = 0.5
#: change of the force of a patch with itself, over one step, beyond which Newton's method counts it
STIFF = 0.1
#: columns of the energies: work of contact forces, lost in bodies and joints, in the damping added, stored
WORK, LOSS, ADDED, STORED = range(4)
#: states whose energies are computed together
_BLOCK = 64


class StepKernel(NamedTuple):
    """One step of m modes in real coordinates (Re z, Im z) under p patches; factors (2, m) are real, imaginary."""

    decay: np.ndarray
    begin: np.ndarray
    end: np.ndarray
    motion: np.ndarray      # (4 p, 2m) u, u', v, w of the patches
    force: np.ndarray       # (3 p, 2m) modal forces of unit forces along normals, tangents and lateral rows
    response: np.ndarray    # (3 p, 4 p) of the motion at the end of a step to the forces there, force by force
    own: np.ndarray         # (4, 3, p) that of each patch to its own forces
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
    response, p = np.ascontiguousarray((motion @ reached).T), len(force) // 3
    patch = np.arange(p)
    own = np.ascontiguousarray(response.reshape(3, p, 4, p)[:, patch, :, patch].transpose(2, 1, 0))
    return StepKernel(*factors, *_together(motion, force, response), own, float(step))


def _together(*matrices):
    """The same matrices in single precision, copied into one block, which large pages of memory can hold.

    A step takes as long as they are read. Sums remain in double precision, so that the motion is exactly that of rows
    which are off by 6e-8 of themselves, far below what is known of a contact.
    """
    sizes = [each.size for each in matrices]
    parts = np.split(np.concatenate([each.ravel() for each in matrices], dtype=np.float32), np.cumsum(sizes)[:-1])
    return [part.reshape(each.shape) for part, each in zip(parts, matrices, strict=True)]


@njit
def advance(patches, attached, steps, energy, state, past, memory, done, count, every, record, spent):
    """(code, step, sweeps) after the steps ``done`` + 1 to ``count`` from ``state`` (2m,), which ends where they end,
    as do the others.

    Elements stand behind the patches among the p forces. ``past`` (DEPTH, 3, p) forces beyond the linear ones at the
    begin and at the steps before it, from which those at the end of a step are extrapolated; ``memory``: states of
    friction (s, 2) and what they have seen, see ``foresee``; what elements remember, their elongations then, and the
    time (1,) s; ``spent`` (3,) J: WORK, LOSS, ADDED so far. A step without a solution leaves all as it was
    before it.
    """
    value, heard, held, begun, clock = memory
    size, p, after = state.size, steps.own.shape[2], held.copy()
    base, reached, ahead, modal = np.empty(size), np.empty(size), np.empty(size), np.empty((DEPTH, size))
    y, trial, reply = np.empty((4, p)), np.empty((3, p)), np.empty((3, p))
    limit, sweeps, best = TOLERANCE * np.sqrt(np.sum(patches.load**2)), 0, 0
    for k in range(DEPTH):
        spread(steps.force, past[k].ravel(), modal[k])
    book, filled = energy.stored.size > 0, 0
    seen, work = np.empty((_BLOCK + 1 if book else 0, size)), np.empty(_BLOCK + 1)
    if book:
        y[:] = 0.0
        multiply(steps.motion, state, y.ravel())
        seen[0], work[0] = state, _worked(past[0], y)
    for number in range(done + 1, count + 1):
        base[:] = 0.0
        times(steps.decay, state, base)
        times(steps.begin, modal[0], base)
        _extrapolate(best, modal, ahead)
        _extrapolate(best, past.reshape(DEPTH, 3 * p), trial.ravel())
        reached[:] = base
        times(steps.end, ahead, reached)
        y[:] = 0.0
        multiply(steps.motion, reached, y.ravel())
        if value.size:
            foresee(patches, value, heard, steps.step)
        time = clock[0] + steps.step
        settled, more = _settle(patches, attached, held, begun, time, steps, limit, trial.ravel(), y, reply, after)
        sweeps += more
        if settled:
            best = _nearest(past.reshape(DEPTH, 3 * p), reply.ravel())
            for k in range(DEPTH - 1, 0, -1):
                past[k], modal[k] = past[k - 1], modal[k - 1]
            past[0] = reply
            if value.size:
                remember(patches, value, heard, y, steps.step)
            held[:], clock[0] = after, time
            for j in range(begun.size):
                begun[j] = attached.place[j] + y[0, p - begun.size + j]
            spread(steps.force, reply.ravel(), modal[0])
            state[:] = base
            times(steps.end, modal[0], state)
            if number % every == 0:
                record.state[number // every - 1] = state
                record.share[number // every - 1] = _shares(patches, y)
            if book:
                filled += 1
                seen[filled], work[filled] = state, _worked(reply, y)
        if filled == _BLOCK or filled and (number == count or not settled):
            _keep_book(energy, steps.step, number if settled else number - 1, every, seen[:filled + 1],
                       work[:filled + 1], record, spent)
            seen[0], work[0], filled = seen[filled], work[filled], 0
        if not settled:
            return UNSETTLED, number, sweeps
    return DONE, count, sweeps


@njit
def _extrapolate(best, values, result):
    """Fill ``result`` (n,) with what follows ``values`` (DEPTH, n), newest first, by row ``best`` of _AHEAD."""
    for q in range(result.size):
        result[q] = _AHEAD[best, 0] * values[0, q]
        for k in range(1, DEPTH):
            result[q] += _AHEAD[best, k] * values[k, q]


@njit(fastmath=FAST)
def _nearest(values, came):
    """Row of _AHEAD that extrapolates ``values`` (DEPTH, n) nearest to what ``came`` (n,)."""
    best, least = 0, np.inf
    for row in range(len(_AHEAD)):
        total = 0.0
        for q in range(came.size):
            error = came[q]
            for k in range(DEPTH):
                error -= _AHEAD[row, k] * values[k, q]
            total += error * error
        if total < least:
            best, least = row, total
    return best


@njit
def _settle(patches, attached, held, begun, time, steps, limit, trial, y, reply, after):
    """(whether forces were found, sweeps): ``reply`` (3, p) to the motion ``y`` (4, p) under the forces ``trial``
    (3p,), within ``limit`` N of them; both begin as guesses, and y follows the forces. The others as of
    ``beyond_slopes``."""
    p = steps.own.shape[2]
    guess, error, change = np.empty(3 * p), np.empty(3 * p), np.empty(3 * p)
    before, moved, slope = np.empty(4 * p), np.empty(4 * p), np.zeros((3, 4, p))
    last, length = np.inf, 1.0
    for sweep in range(1, SWEEPS + 1):
        beyond_linear(patches, y, reply, slope)
        if begun.size:
            beyond_slopes(attached, held, begun, time, y, reply, slope, after)
        error[:] = reply.ravel() - trial
        miss = np.sqrt(np.sum(error * error))
        if miss <= limit:
            return True, sweep
        if not miss < last and length > SHORTEST:
            length *= 0.5
        elif not miss < np.inf:
            return False, sweep
        else:
            guess[:], before[:], last, length = trial, y.ravel(), miss, 1.0
            _newton(steps.response, steps.own, slope, error, limit, change, moved)
        trial[:] = guess + length * change
        y.ravel()[:] = before + length * moved
    return False, SWEEPS


@njit
def modal_rate(patches, motion, force, root, state, result):
    """Fill ``result`` (2m,) with dz/dt at ``state`` (2m,); ``root`` (2, m): real, imaginary, rows as in StepKernel."""
    p = patches.load.size
    y, rest = np.zeros((4, p)), np.empty((3, p))
    multiply(motion, state, y.ravel())
    beyond_linear(patches, y, rest, np.empty((3, 4, p)))
    spread(force, rest.ravel(), result)
    times(root, state, result)


@njit
def observed(patches, motion, energy, state, power):
    """Shares at ``state`` (2m,), see Record, and ``power`` (3,) W filled: WORK, LOSS, ADDED, if there is a book."""
    p = patches.load.size
    y, rest = np.zeros((4, p)), np.empty((3, p))
    multiply(motion, state, y.ravel())
    if energy.stored.size:
        beyond_linear(patches, y, rest, np.zeros((3, 4, p)))
        _powers(energy, state, y, rest, power)
    return _shares(patches, y)


@njit
def _newton(response, own, slope, error, limit, change, moved):
    """Fill ``change`` (3p,) of the forces with a step of Newton's method for their ``error`` (3p,), and ``moved`` (4p,)
    with the motion by it.

    Slopes (3, 4, p) count in full at the patches that are stiff; the others follow their error and, to first order,
    their own motion. Changes that are negligible beside the ``limit`` are left out of both.
    """
    p, least = own.shape[2], NEGLIGIBLE * limit / np.sqrt(error.size)
    largest = _follow(own, slope, error.reshape(3, p), change.reshape(3, p))
    stiff, active, number = np.flatnonzero(largest > STIFF), np.empty(3 * p, np.int64), 0
    count = len(stiff)
    for row in range(3 * p):
        if largest[row % p] > STIFF or not abs(change[row]) > least:
            change[row] = 0.0
        else:
            active[number] = row
            number += 1
    moved[:] = 0.0
    add_rows(response, change, active[:number], moved)
    if count == 0:
        return
    matrix, side, rows = np.zeros((3 * count, 3 * count)), np.empty(3 * count), np.empty(3 * count, np.int64)
    for a in range(count):
        i = stiff[a]
        for f in range(3):
            rows[3 * a + f] = f * p + i
            side[3 * a + f] = error[f * p + i]
            for o in range(4):
                side[3 * a + f] += slope[f, o, i] * moved[o * p + i]
            for b in range(count):
                for g in range(3):
                    total = 0.0
                    for o in range(4):
                        total += slope[f, o, i] * response[g * p + stiff[b], o * p + i]
                    matrix[3 * a + f, 3 * b + g] = -total
            matrix[3 * a + f, 3 * a + f] += 1.0
    side = np.linalg.solve(matrix, side)
    for k in range(3 * count):
        change[rows[k]] = side[k]
    add_rows(response, change, rows, moved)


@njit(fastmath=FAST)
def _follow(own, slope, error, change):
    """(p,) largest change of a force of each patch with its own forces; fills ``change`` (3, p) with the ``error``
    (3, p) and what it does to them itself."""
    p = own.shape[2]
    near, largest = np.empty(p), np.zeros(p)
    change[:] = error
    for f in range(3):
        for g in range(3):
            near[:] = 0.0
            for o in range(4):
                for i in range(p):
                    near[i] += slope[f, o, i] * own[o, g, i]
            for i in range(p):
                change[f, i] += near[i] * error[g, i]
                largest[i] = max(largest[i], abs(near[i]))
    return largest


@njit
def _worked(rest, y):
    """Power (W) of the contact forces ``rest`` (3, p) beyond the linear ones at the velocities in ``y`` (4, p)."""
    power = 0.0
    for row in range(3):
        for i in range(rest.shape[1]):
            power += rest[row, i] * y[row + 1, i]
    return power


@njit
def _keep_book(energy, step, number, every, seen, work, record, spent):
    """Add to ``spent`` (3,) what the steps between the states ``seen`` (n, 2m) took, ``work`` (n,) being the power of
    the contact forces beyond the linear ones, and keep rows of the ``record``; the last step is that of ``number``."""
    power, first = np.empty((3, len(seen))), number - len(seen) + 1
    power[WORK], power[LOSS], power[ADDED] = (
        work + _quadratic(energy.contact, seen), _quadratic(energy.loss, seen), _quadratic(energy.added, seen))
    kept = np.arange(every - first % every, len(seen), every)
    stored, k = _quadratic(energy.stored, seen[kept]), 0
    for n in range(1, len(seen)):
        spent += 0.5 * step * (power[:, n - 1] + power[:, n])
        if k < len(kept) and kept[k] == n:
            row = (first + n) // every - 1
            record.energy[row, :STORED], record.energy[row, STORED] = spent, stored[k]
            k += 1


@njit
def _quadratic(form, states):
    """``form`` (2m, 2m) at each of the ``states`` (n, 2m)."""
    return np.sum((states @ form) * states, axis=1)


@njit
def _powers(energy, state, y, rest, power):
    """Fill ``power`` (3,) W at ``state``: WORK, LOSS, ADDED."""
    power[WORK] = state @ (energy.contact @ state) + _worked(rest, y)
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
