"""The loop over time steps, compiled: linear step of the pairs, contact forces, bookkeeping.

Per step: the pairs go on with the forces known so far, the contacts see the motion that this leads to and find their
forces, these are added. Energies are summed at every step: work is (mean force) x (displacement of the step), which is
exact for forces constant over the step; loss in dampers by the trapezoidal rule.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from pipeline.physics.time_stepping_contact import SOLVED, solve_contacts

DIVERGED = 4
#: sums may be reordered to use the width of the processor; nothing else is relaxed
_FAST = {"reassoc", "contract", "nsz"}
INPUT, DAMPING, NORMAL, FRICTION, SLIDING = range(5)


class LinearKernel(NamedTuple):
    """Linear step of m pairs under c contacts and i inputs: forces are N (c), T (c), inputs (i)."""

    step: np.ndarray        # (2, 2, m)
    first: np.ndarray       # (2 c + i, 2, m) effect of the forces at the begin of the step
    last: np.ndarray        # (2 c + i, 2, m) effect of the forces at its end, or of forces constant over it
    rows: np.ndarray        # (4, c, 2, m) observables: displacement, velocity along n, then along t
    response: np.ndarray    # (4, 2, c, c) of the observables to ``last``
    input_rows: np.ndarray  # (i, 2, m) displacement along the inputs
    sensors: np.ndarray     # (2, s, 2, m) displacement, velocity
    hold: np.ndarray        # (2,) 1 where N, T are constant over the step
    pull: np.ndarray        # (m,) squared frequencies, uncoupled
    drag: np.ndarray        # (m,) damping, uncoupled
    energy: np.ndarray      # (2m, 2m) energy form of coupled pairs, else empty
    power: np.ndarray       # (2m, 2m) loss form of coupled pairs, else empty


class HistoryKernel(NamedTuple):
    """Values at equal intervals from time 0, linear between, constant beyond the last."""

    value: np.ndarray       # (samples, n)
    interval: float


class Record(NamedTuple):
    """What is kept at r instants."""

    displacement: np.ndarray    # (s, r)
    velocity: np.ndarray        # (s, r)
    gap: np.ndarray             # (c, r)
    normal: np.ndarray          # (c, r) mean since the last record
    friction: np.ndarray        # (c, r) mean since the last record
    slip: np.ndarray            # (c, r)
    status: np.ndarray          # (c, r)
    stored: np.ndarray          # (r,)
    work: np.ndarray            # (5, r) input, damping, normal, friction, sliding
    share: np.ndarray           # (c, 3) steps open, sticking, sliding


@njit(cache=True)
def read(history, time, found):
    """Fill ``found`` (n,) with the values at ``time``."""
    last = history.value.shape[0] - 1
    place = time / history.interval
    k = min(int(place), last)
    share = place - k
    for i in range(found.size):
        found[i] = history.value[k, i]
        if k < last:
            found[i] += share * (history.value[k + 1, i] - history.value[k, i])


@njit(cache=True, fastmath=_FAST)
def _advance(step, now, after):
    for b in range(now.shape[1]):
        one, other = now[0, b], now[1, b]
        after[0, b] = step[0, 0, b] * one + step[0, 1, b] * other
        after[1, b] = step[1, 0, b] * one + step[1, 1, b] * other


@njit(cache=True, fastmath=_FAST)
def _add(column, factor, pairs):
    for b in range(pairs.shape[1]):
        pairs[0, b] += factor * column[0, b]
        pairs[1, b] += factor * column[1, b]


@njit(cache=True, fastmath=_FAST)
def _seen(row, pairs):
    total = 0.0
    for b in range(pairs.shape[1]):
        total += row[0, b] * pairs[0, b] + row[1, b] * pairs[1, b]
    return total


@njit(cache=True, fastmath=_FAST)
def _loss_rate(linear, pairs):
    """Power of the dampers, W."""
    if linear.power.size:
        state = pairs.ravel()
        return state @ (linear.power @ state)
    total = 0.0
    for b in range(pairs.shape[1]):
        total += linear.drag[b] * pairs[1, b] ** 2
    return total


@njit(cache=True)
def stored_energy(linear, pairs):
    """Kinetic and strain energy, J."""
    if linear.energy.size:
        state = pairs.ravel()
        return state @ (linear.energy @ state)
    return 0.5 * np.sum(pairs[1] ** 2 + linear.pull * pairs[0] ** 2)


@njit(cache=True)
def _keep(linear, law, record, row, pairs, seen, force, drive, status, steps, work):
    for s in range(linear.sensors.shape[1]):
        record.displacement[s, row] = _seen(linear.sensors[0, s], pairs)
        record.velocity[s, row] = _seen(linear.sensors[1, s], pairs)
    for i in range(seen.shape[1]):
        record.gap[i, row] = law.gap[i] + seen[0, i]
        record.normal[i, row], record.friction[i, row] = force[0, i] / steps, force[1, i] / steps
        record.slip[i, row] = drive[i] - seen[3, i]
        record.status[i, row] = status[i]
    record.stored[row] = stored_energy(linear, pairs)
    record.work[:, row] = work


@njit(cache=True)
def march(linear, law, friction, lever, drive, inputs, pairs, force, status, step, steps, every, book, record):
    """(code, step number, contact): fills ``record``; ``pairs``, ``force``, ``status`` go in and come out.

    ``lever`` (c,), ``drive`` HistoryKernel of the drive speed, ``inputs`` of the input forces; ``book``: whether
    the work of inputs and dampers is summed.
    """
    contacts, count = law.gap.size, linear.input_rows.shape[0]
    free, seen, after = np.zeros((4, contacts)), np.zeros((4, contacts)), np.empty_like(pairs)
    held, summed, turning = force.copy(), np.zeros((2, contacts)), np.zeros((2, 1))
    sliding, way, work = np.zeros((2, contacts)), np.zeros(contacts), np.zeros(5)
    begin, end = np.zeros(count), np.zeros(count)
    place, place_after = np.zeros(count), np.zeros(count)
    varies = inputs.value.shape[0] > 1
    read(inputs, 0.0, begin)
    end[:] = begin
    read(drive, 0.0, turning[1])
    steady = np.zeros_like(pairs)
    for i in range(count):
        place[i] = _seen(linear.input_rows[i], pairs)
        if not varies:
            _add(linear.first[2 * contacts + i], begin[i], steady)
            _add(linear.last[2 * contacts + i], begin[i], steady)
    for i in range(contacts):
        sliding[1, i] = lever[i] * turning[1, 0]
        for o in range(4):
            seen[o, i] = _seen(linear.rows[o, i], pairs)
    _keep(linear, law, record, 0, pairs, seen, force, sliding[1], status, 1, work)
    loss = _loss_rate(linear, pairs) if book else 0.0
    for number in range(1, steps + 1):
        _advance(linear.step, pairs, after)
        if varies:
            read(inputs, number * step, end)
            for i in range(count):
                _add(linear.first[2 * contacts + i], begin[i], after)
                _add(linear.last[2 * contacts + i], end[i], after)
        else:
            _add(steady, 1.0, after)
        if contacts:
            turning[0, 0] = turning[1, 0]
            read(drive, number * step, turning[1])
            for i in range(contacts):
                for f in range(2):
                    held[f, i] = force[f, i]
                    if not linear.hold[f] and force[f, i] != 0.0:
                        _add(linear.first[f * contacts + i], force[f, i], after)
            for i in range(contacts):
                sliding[0, i], sliding[1, i] = lever[i] * turning[0, 0], lever[i] * turning[1, 0]
                way[i] = 0.5 * step * (sliding[0, i] + sliding[1, i])
                for o in range(4):
                    free[o, i] = _seen(linear.rows[o, i], after)
            code, contact = solve_contacts(law, friction, linear.response, free, seen, held, sliding, way, force,
                                           status)
            if code != SOLVED:
                return code, number, contact
            for i in range(contacts):
                for f in range(2):
                    if force[f, i] != 0.0:
                        _add(linear.last[f * contacts + i], force[f, i], after)
            _account(linear, law, held, force, free, seen, way, status, record, summed, work)
        if book:
            rate = _loss_rate(linear, after)
            work[DAMPING] += 0.5 * step * (loss + rate)
            loss = rate
            for i in range(count):
                place_after[i] = _seen(linear.input_rows[i], after)
                work[INPUT] += 0.5 * (begin[i] + end[i]) * (place_after[i] - place[i])
            place, place_after = place_after, place
        begin, end = end, begin
        if not varies:
            end[:] = begin
        pairs[:] = after
        if number % every == 0:
            if not np.isfinite(np.sum(pairs)):
                return DIVERGED, number, 0
            _keep(linear, law, record, number // every, pairs, seen, summed, sliding[1], status, every, work)
            summed[:] = 0.0
    return SOLVED, 0, 0


@njit(cache=True)
def _account(linear, law, held, force, free, seen, way, status, record, summed, work):
    """Observables at the end of the step into ``seen``; mean forces, their work, the status of the step."""
    contacts = seen.shape[1]
    for i in range(contacts):
        moved, slid = seen[0, i], way[i] + seen[2, i]
        for o in range(4):
            total = free[o, i]
            for j in range(contacts):
                for f in range(2):
                    total += linear.response[o, f, i, j] * force[f, j]
            seen[o, i] = total
        mean_n = force[0, i] if linear.hold[0] else 0.5 * (held[0, i] + force[0, i])
        mean_t = force[1, i] if linear.hold[1] else 0.5 * (held[1, i] + force[1, i])
        summed[0, i] += mean_n
        summed[1, i] += mean_t
        slid -= seen[2, i]
        work[NORMAL] += mean_n * (seen[0, i] - moved)
        work[SLIDING] += mean_t * slid
        work[FRICTION] += mean_t * (way[i] - slid)
        record.share[i, status[i]] += 1.0
