"""The loop over time steps, compiled: linear step of the pairs, contact forces, bookkeeping.

Per step: the pairs go on with the forces known so far, the contacts see the motion that this leads to and find their
forces, these are added; nonlinear elements, where there are any, are solved together with them. Energies are summed at
every step: work is (mean force) x (displacement of the step), which is exact for forces constant over the step, or
(impulse) x (mean velocity across it); loss in dampers by the trapezoidal rule, between impulses, where velocities are
saw-teeth, by Simpson's.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.dry_friction import RIGID
from pipeline.physics.friction.state_kernels import expect, settle
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.time_stepping.contact_solver import SOLVED, solve_contacts
from pipeline.physics.time_stepping.coupled_solver import (
    first_forces,
    middle_angle,
    pulled,
    recede,
    settle_element_books,
    shift_work,
    solve_together,
    surface_shift,
    wear_on,
)
from pipeline.physics.time_stepping.element_forces import TURNING, laws_of, solve_elements, turn

DIVERGED = 4
#: sums may be reordered to use the width of the processor; nothing else is relaxed
_FAST = {"reassoc", "contract", "nsz"}
INPUT, DAMPING, NORMAL, FRICTION, SLIDING, ELEMENTS = range(6)


class LinearKernel(NamedTuple):
    """Linear step of m pairs under c contacts, i inputs and e elements: forces are N (c), T (c), inputs, elements."""

    step: np.ndarray        # (2, 2, m)
    first: np.ndarray       # (2 c + i + e, 2, m) effect of the forces at the begin of the step
    last: np.ndarray        # (2 c + i + e, 2, m) effect of the forces at its end, or of forces constant over it
    rows: np.ndarray        # (4 c, 2, m) observables: displacement, velocity along n, then along t
    response: np.ndarray    # (4, 2, c, c) of the observables to ``last``
    input_rows: np.ndarray  # (i, 2, m) displacement along the inputs
    sensors: np.ndarray     # (2 s, 2, m) displacement, then velocity
    hold: np.ndarray        # (2,) 1 where N, T are constant over the step
    pull: np.ndarray        # (m,) squared frequencies, uncoupled
    drag: np.ndarray        # (m,) damping, uncoupled
    energy: np.ndarray      # (2m, 2m) energy form of coupled pairs, else empty
    power: np.ndarray       # (2m, 2m) loss form of coupled pairs, else empty
    struck: np.ndarray      # (2 c, 2, m) effect at once of forces that are impulses; empty where none are


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
    work: np.ndarray            # (6, r) input, damping, normal, friction, sliding, elements
    elongation: np.ndarray      # (e, r)
    element_force: np.ndarray   # (e, r)
    share: np.ndarray           # (c, 3) steps open, sticking, sliding
    end: np.ndarray             # (2, m) pairs after the last step
    memory: np.ndarray          # (s,) of the elements after the last step
    states: np.ndarray          # (k, 2) of friction after the last step
    angle: np.ndarray           # (1,) rad of the drive, at time 0, then after the last step
    worn: np.ndarray            # (c,) m that the contacts have receded by, at time 0, then after the last step


@njit
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


@njit(fastmath=_FAST)
def _advance(step, steady, now, after):
    for b in range(now.shape[1]):
        one, other = now[0, b], now[1, b]
        after[0, b] = step[0, 0, b] * one + step[0, 1, b] * other + steady[0, b]
        after[1, b] = step[1, 0, b] * one + step[1, 1, b] * other + steady[1, b]


@njit(fastmath=_FAST)
def _push(columns, first, factors, pairs):
    """Add ``columns`` (from number ``first`` on) times ``factors`` to the pairs."""
    for k in range(factors.size):
        factor = factors[k]
        if factor != 0.0:
            for b in range(pairs.shape[1]):
                pairs[0, b] += factor * columns[first + k, 0, b]
                pairs[1, b] += factor * columns[first + k, 1, b]


@njit(fastmath=_FAST)
def _see(rows, pairs, seen):
    """Fill ``seen`` (r,) with the rows (r, 2, m) of the pairs."""
    for k in range(seen.size):
        total = 0.0
        for b in range(pairs.shape[1]):
            total += rows[k, 0, b] * pairs[0, b] + rows[k, 1, b] * pairs[1, b]
        seen[k] = total


@njit(fastmath=_FAST)
def _loss_rate(power, drag, pairs):
    """Power of the dampers, W."""
    if power.size:
        state = pairs.ravel()
        return state @ (power @ state)
    total = 0.0
    for b in range(pairs.shape[1]):
        total += drag[b] * pairs[1, b] ** 2
    return total


@njit
def stored_energy(energy, pull, pairs):
    """Kinetic and strain energy, J."""
    if energy.size:
        state = pairs.ravel()
        return state @ (energy @ state)
    total = 0.0
    for b in range(pairs.shape[1]):
        total += pairs[1, b] ** 2 + pull[b] * pairs[0, b] ** 2
    return 0.5 * total


@njit
def _keep(kept, gap, stored, record, row, seen, force, drive, status, steps, work):
    for s in range(kept.size // 2):
        record.displacement[s, row], record.velocity[s, row] = kept[s], kept[kept.size // 2 + s]
    for i in range(seen.shape[1]):
        record.gap[i, row] = gap[i] + seen[0, i]
        record.normal[i, row], record.friction[i, row] = force[0, i] / steps, force[1, i] / steps
        record.slip[i, row] = drive[i] - seen[3, i]
        record.status[i, row] = status[i]
    record.stored[row] = stored
    for k in range(work.size):
        record.work[k, row] = work[k]


@njit
def _keep_elements(elongation, element_force, row, place, drawn):
    for k in range(drawn.size):
        elongation[k, row], element_force[k, row] = place[0, k], drawn[k]


@njit
def march(linear, law, friction, elements, states, lever, drive, inputs, pairs, force, status, memory, value, age, step,
          steps, every, book, record):
    """(code, step number, contact or element): fills ``record`` from what stands at time 0, ``pairs`` to ``value``.

    ``lever`` (c,), ``drive`` HistoryKernel of the drive speed, ``inputs`` of the input forces; ``age`` s passed before
    time 0; ``book``: whether energy is kept and the work of inputs and dampers summed.
    """
    contacts, count = law.gap.size, linear.input_rows.shape[0]
    # functions of the loop take the arrays that they need: a whole tuple of arrays costs more than their work
    one_step, first, last, rows, response = linear.step, linear.first, linear.last, linear.rows, linear.response
    input_rows, power, drag, struck, share = linear.input_rows, linear.power, linear.drag, linear.struck, record.share
    sensors, energy, pull, gap = linear.sensors, linear.energy, linear.pull, law.gap
    holds = (linear.hold[0] > 0, linear.hold[1] > 0)
    free, seen, after = np.zeros((4, contacts)), np.zeros((4, contacts)), np.zeros_like(pairs)
    held, summed, turning = force.copy(), np.zeros((2, contacts)), np.zeros(1)
    free_flat, seen_flat, held_flat, force_flat = free.ravel(), seen.ravel(), held.ravel(), force.ravel()
    sliding, way, work, before = np.zeros((2, contacts)), np.zeros(contacts), np.zeros(6), status.copy()
    kicked, hit, jump = np.zeros_like(pairs), np.zeros((4, contacts)), np.zeros((2, contacts if struck.size else 0))
    hit_flat = hit.ravel()
    begin, end, watched = np.zeros(count), np.zeros(count), np.zeros(linear.sensors.shape[0])
    place, place_after = np.zeros(count), np.zeros(count)
    varies, turns, steady = inputs.value.shape[0] > 1, drive.value.shape[0] > 1, np.zeros_like(pairs)
    read(inputs, 0.0, begin)
    read(drive, 0.0, turning)
    end[:] = begin
    sliding[:] = turning[0] * lever
    way[:] = step * turning[0] * lever
    if not varies:
        _push(first, 2 * contacts, begin, steady)
        _push(last, 2 * contacts, begin, steady)
    count_e, waves = elements.kind.size, elements.waviness.shape[0] > 0
    recalls, middle = states.kind.size > 0, friction.description == RIGID and not law.newmark
    turns_aside = np.any(elements.kind == TURNING)
    wear, worn, pace = elements.wear, record.worn, np.zeros(elements.wear.size)
    special, angle, spin = count_e > 0 or waves or wear.size > 0 or recalls, record.angle[0], np.zeros(1)
    slip, slipped, mean = np.zeros(contacts), np.zeros(contacts), np.zeros(contacts)
    alone, shift, shift_before = np.zeros((4, contacts)), np.zeros((2, contacts)), np.zeros((2, contacts))
    lonely, now, later = np.zeros((2, count_e)), np.zeros((2, count_e)), np.zeros((2, count_e))
    drawn, drawn_before, remembered, earlier = np.zeros(count_e), np.zeros(count_e), memory.copy(), status.copy()
    laws, element_rows, grain, lonely_flat = laws_of(elements), elements.rows, np.zeros(count_e), lonely.ravel()
    _see(input_rows, pairs, place)
    _see(rows, pairs, seen_flat)
    if special:
        read(drive, 0.0, spin)
        instant = (age, angle, spin[0])
        wear_on(wear, force[0], sliding[1], seen[3], 0.0, worn, pace)
        surface_shift(elements.waviness, instant, shift)
        recede(worn, pace, 0.0, shift)
        seen[0] += shift[0]
        seen[1] += shift[1]
        _see(elements.rows, pairs, now.ravel())
        turn(elements, force[1], sliding[1] - seen[3], now[1])
        first_forces(elements, now, memory, drawn, instant)
        _keep_elements(record.elongation, record.element_force, 0, now, drawn)
    _see(sensors, pairs, watched)
    stored = stored_energy(energy, pull, pairs) if book else 0.0
    _keep(watched, gap, stored, record, 0, seen, force, sliding[1], status, 1, work)
    loss = _loss_rate(power, drag, pairs) if book else 0.0
    for number in range(1, steps + 1):
        _advance(one_step, steady, pairs, after)
        if varies:
            begin[:] = end
            read(inputs, number * step, end)
            _push(first, 2 * contacts, begin, after)
            _push(last, 2 * contacts, end, after)
        if special:
            drawn_before[:] = drawn
            shift_before[:] = shift
            remembered[:] = memory
            spun, angle_before = spin[0], angle
            read(drive, number * step, spin)
            angle = middle_angle(angle, spun, spin[0], step)
            instant = (age + number * step, angle, spin[0])
            _push(first, 2 * contacts + count, drawn, after)
        if contacts:
            if turns:
                read(drive, number * step, turning)
                for i in range(contacts):
                    sliding[0, i], sliding[1, i] = sliding[1, i], lever[i] * turning[0]
                    way[i] = 0.5 * step * (sliding[0, i] + sliding[1, i])
            held_flat[:] = force_flat
            if recalls or turns_aside:
                slip[:] = sliding[0] - seen[3]
            if turns_aside:
                turn(elements, held[1], slip, now[1])
            if recalls:
                expect(states, value, friction, held[0], slip, held[1], angle_before, angle, step, middle)
            if not (holds[0] and holds[1]):
                _push(first, 0, held_flat, after)
            _see(rows, after, free_flat)
            if not special:
                code, contact = solve_contacts(law, friction, response, free, seen, held, sliding, way, force,
                                               status, before)
                if code != SOLVED:
                    return code, number, contact
        if special:
            surface_shift(elements.waviness, instant, shift)
            recede(worn, pace, step, shift)
            for i in range(contacts):
                free[0, i] += shift[0, i]
                free[1, i] += shift[1, i]
            _see(element_rows, after, lonely_flat)
            if contacts:
                alone[:] = free
                earlier[:] = status
                code, contact = solve_together(law, friction, response, elements, alone, free, seen, held, sliding, way,
                                               force, status, earlier, before, lonely, later, now[0], remembered,
                                               memory, drawn, instant)
            else:
                code, contact = solve_elements(laws, lonely, now[0], remembered, memory, drawn, grain, instant)
                pulled(laws.own, lonely, drawn, later)
            if code != SOLVED:
                return code, number, contact
            _push(last, 2 * contacts + count, drawn, after)
            work[ELEMENTS] += settle_element_books(now[0], later[0], drawn_before, drawn)
            work[NORMAL] -= shift_work(shift_before[0], shift[0], held, force, holds[0])
            now, later = later, now
        if contacts:
            _push(last, 0, force_flat, after)
            if struck.size:
                kicked[:] = pairs
                _push(struck, 0, force_flat, kicked)
                _see(rows, kicked, hit_flat)
                loss = _loss_rate(power, drag, kicked) if book else 0.0
                jump[0] = 0.5 * step * (seen[1] + hit[1])
                jump[1] = 0.5 * step * (seen[3] + hit[3])
            _account(response, jump, holds, held, force, free, seen, way, status, share, summed, work)
            if recalls:
                slipped[:] = sliding[1] - seen[3]
                mean[:] = force[1] if holds[1] else 0.5 * (held[1] + force[1])
                settle(states, value, force[0] if holds[0] else held[0], force[0], slip, slipped, mean, step)
            wear_on(wear, force[0], sliding[1], seen[3], step, worn, pace)
        if book:
            rate = _loss_rate(power, drag, after)
            if struck.size:
                kicked[:] = 0.5 * (kicked + after)
                work[DAMPING] += step / 6 * (loss + 4 * _loss_rate(power, drag, kicked) + rate)
            else:
                work[DAMPING] += 0.5 * step * (loss + rate)
            loss = rate
            _see(input_rows, after, place_after)
            for i in range(count):
                work[INPUT] += 0.5 * (begin[i] + end[i]) * (place_after[i] - place[i])
                place[i] = place_after[i]
        pairs, after = after, pairs
        if number % every == 0:
            if not np.isfinite(np.sum(pairs)):
                return DIVERGED, number, 0
            _see(sensors, pairs, watched)
            stored = stored_energy(energy, pull, pairs) if book else 0.0
            _keep(watched, gap, stored, record, number // every, seen, summed, sliding[1], status, every, work)
            if special:
                _keep_elements(record.elongation, record.element_force, number // every, now, drawn)
            summed[:] = 0.0
    record.end[:] = pairs
    record.memory[:] = memory
    record.states[:] = value
    record.angle[0] = angle
    return SOLVED, 0, 0


@njit
def _account(response, jump, holds, held, force, free, seen, way, status, share, summed, work):
    """Observables at the end of the step into ``seen``; mean forces, their work, the status of the step.

    ``jump`` (2, c) m is the way along n and t that impulses work along, empty where there are none.
    """
    contacts = seen.shape[1]
    for i in range(contacts):
        moved, drawn = seen[0, i], seen[2, i]
        for o in range(4):
            total = free[o, i]
            for j in range(contacts):
                for f in range(2):
                    total += response[o, f, i, j] * force[f, j]
            seen[o, i] = total
        mean_n = force[0, i] if holds[0] else 0.5 * (held[0, i] + force[0, i])
        mean_t = force[1, i] if holds[1] else 0.5 * (held[1, i] + force[1, i])
        summed[0, i] += mean_n
        summed[1, i] += mean_t
        moved, drawn = seen[0, i] - moved, seen[2, i] - drawn
        if jump.size:
            moved = jump[0, i]
            drawn = jump[1, i] if holds[1] else drawn
        work[NORMAL] += mean_n * moved
        work[SLIDING] += mean_t * (way[i] - drawn)
        work[FRICTION] += mean_t * drawn
        share[i, status[i]] += 1.0
