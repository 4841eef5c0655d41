"""The loop over time steps, compiled: linear step of the pairs, contact forces, bookkeeping.

Per step: the pairs go on with the forces known so far, the contacts see the motion that this leads to and find their
forces, these are added; nonlinear elements, where there are any, are solved together with them. Energies are summed at
every step: work is (mean force) x (displacement of the step), which is exact for forces constant over the step, or
(impulse) x (mean velocity across it); loss in dampers by the trapezoidal rule, between impulses, where velocities are
saw-teeth, by Simpson's.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.dry_friction import RIGID, FrictionKernel
from pipeline.physics.friction.state_kernels import StateKernel, expect, settle
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.time_stepping.contact_solver import SOLVED, ContactStep, NormalKernel, solve_contacts
from pipeline.physics.time_stepping.coupled_solver import (
    advance_wear,
    angle_after,
    element_work,
    first_forces,
    motion_at_end,
    recede,
    shift_work,
    solve_together,
    surface_shift,
)
from pipeline.physics.time_stepping.element_forces import (
    TURNING,
    UNSETTLED,
    ElementKernel,
    ElementStep,
    laws_of,
    solve_elements,
    update_turning_dampers,
)
from pipeline.physics.time_stepping.linear_step import (
    HistoryKernel,
    LinearKernel,
    add_forces,
    advance,
    copy,
    hold,
    interpolate,
    loss_rate,
    project_rows,
    stored_energy,
)
from pipeline.physics.time_stepping.rigid_friction import (
    Part,
    RigidKernel,
    begin_at_rest,
    margin,
    split_step,
    states_at_start,
    stop,
    switches,
)
from pipeline.physics.time_stepping.turning import TurningKernel, correct, turn, turning_force, turning_work

DIVERGED, UNTURNED = 4, 7
INPUT, DAMPING, NORMAL, FRICTION, SLIDING, ELEMENTS = range(6)


class System(NamedTuple):
    """A sliding model, as the loop steps it."""

    linear: LinearKernel
    law: NormalKernel
    friction: FrictionKernel
    elements: ElementKernel
    states: StateKernel
    lever: np.ndarray           # (c,) m, sliding velocity per speed of the drive
    turning: TurningKernel
    rigid: RigidKernel
    part: Part


class Schedule(NamedTuple):
    """What drives the model, and how it is stepped."""

    drive: HistoryKernel        # rad/s, speed of the drive
    inputs: HistoryKernel       # N, input forces
    age: float                  # s that passed before time 0
    step: float                 # s
    steps: int
    every: int                  # steps between records
    book: bool                  # whether energy is recorded, and work of inputs and dampers summed


class State(NamedTuple):
    """Where the motion stands; after the run, where it ended."""

    pairs: np.ndarray           # (2, m)
    force: np.ndarray           # (2, c) N, forces N, T
    status: np.ndarray          # (c,) OPEN, STICK or SLIP
    memory: np.ndarray          # (s,) of the elements
    friction: np.ndarray        # (k, 2) states of friction
    angle: np.ndarray           # (1,) rad of the drive
    worn: np.ndarray            # (c,) m that the contacts have receded by


class Record(NamedTuple):
    """What is recorded at r instants."""

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


@njit
def integrate(system, schedule, state, record):
    """(code, step number, contact or element) of the first step that fails, after filling ``record`` and ``state``."""
    linear, law, friction, elements, states, lever, turning, rigid, part = system
    (seen_displacement, seen_velocity, seen_gap, seen_normal, seen_friction, seen_slip, seen_status, seen_stored,
     seen_work, seen_elongation, seen_force, share) = record
    drive, inputs, age, step, steps, every, book = schedule
    pairs, force, status, memory, value = state.pairs, state.force, state.status, state.memory, state.friction
    contacts, count, count_e = law.gap.size, linear.input_rows.shape[0], elements.kind.size
    # functions of the loop take the arrays that they need: a whole tuple of arrays costs more than their work
    one_step, rows, response, gap = linear.step, linear.rows, linear.response, law.gap
    input_rows, power, damping, impulse = linear.input_rows, linear.power, linear.damping, linear.impulse_response
    sensor_rows, energy, omega_squared = linear.sensors, linear.energy, linear.omega_squared
    element_rows = elements.rows
    contact_first, contact_last = linear.first[:2 * contacts], linear.last[:2 * contacts]
    input_first, element_first = linear.first[2 * contacts:2 * contacts + count], linear.first[2 * contacts + count:]
    input_last, element_last = linear.last[2 * contacts:2 * contacts + count], linear.last[2 * contacts + count:]
    constant = (linear.constant_over_step[0] > 0, linear.constant_over_step[1] > 0)
    contact = ContactStep(np.zeros((4, contacts)), np.zeros((4, contacts)), force.copy(), np.zeros((2, contacts)),
                          np.zeros(contacts), force, status, status.copy())
    element = ElementStep(np.zeros((2, count_e)), np.zeros((2, count_e)), np.zeros((2, count_e)), memory.copy(), memory,
                          np.zeros(count_e), np.zeros(count_e), np.zeros((2, count_e)))
    free, observed, held, sliding, way = contact.free, contact.begin, contact.held, contact.drive, contact.way
    free_flat, observed_flat, held_flat, force_flat = free.ravel(), observed.ravel(), held.ravel(), force.ravel()
    elongation, elongation_flat, elongation_end = element.begin, element.begin.ravel(), element.end.ravel()
    element_free, element_pressed, element_response = element.free.ravel(), element.pressed.ravel(), elements.response
    element_force, element_force_begin = element.force, np.zeros(count_e)
    after, steady, kicked = np.zeros_like(pairs), np.zeros_like(pairs), np.zeros_like(pairs)
    pairs_flat, after_flat, kicked_flat = pairs.ravel(), after.ravel(), kicked.ravel()
    struck, jump = np.zeros((4, contacts)), np.zeros((2, contacts if impulse.size else 0))
    struck_flat, summed, work = struck.ravel(), force.copy(), np.zeros(6)
    input_begin, input_end, sensors = np.zeros(count), np.zeros(count), np.zeros(sensor_rows.shape[0])
    displacement, displacement_end, speed, angle = np.zeros(count), np.zeros(count), np.zeros(1), state.angle[0]
    alone, shift, shift_begin = np.zeros((4, contacts)), np.zeros((2, contacts)), np.zeros((2, contacts))
    alone_flat, shift_flat, shift_begin_flat = alone.ravel(), shift.ravel(), shift_begin.ravel()
    status_begin = status.copy()
    slip, slip_end, mean = np.zeros(contacts), np.zeros(contacts), np.zeros(contacts)
    laws, wear, worn, pace = laws_of(elements), elements.wear, state.worn, np.zeros(elements.wear.size)
    sticks, part_flat = rigid.index.size > 0, part.end.ravel()
    varies, turns, recalls = inputs.value.shape[0] > 1, drive.value.shape[0] > 1, states.kind.size > 0
    rotates, count_r = turns and turning.first.shape[0] > 0, turning.first.shape[0]
    turned, turned_begin, turned_change = np.zeros(count_r), np.zeros(count_r), np.zeros(count_r)
    seen, seen_begin = np.zeros(2 * count_r), np.zeros(2 * count_r)
    middle, dampers_turn = friction.description == RIGID and not law.newmark, False
    for k in range(count_e):
        dampers_turn = dampers_turn or elements.kind[k] == TURNING
    waviness = elements.waviness
    moves = waviness.shape[0] > 0 or wear.size > 0
    special = count_e > 0 or moves or recalls
    interpolate(inputs, 0.0, input_end)
    interpolate(drive, 0.0, speed)
    copy(input_end, input_begin)
    for i in range(contacts):
        sliding[0, i] = sliding[1, i] = speed[0] * lever[i]
        way[i] = step * speed[0] * lever[i]
    if not varies:
        add_forces(input_first, input_begin, steady)
        add_forces(input_last, input_begin, steady)
    project_rows(input_rows, pairs, displacement)
    project_rows(rows, pairs, observed_flat)
    if rotates:
        project_rows(turning.rows, pairs, seen)
        turning_force(turning, seen, speed[0], turned)
    if special:
        instant = (age, angle, speed[0])
        advance_wear(wear, force[0], sliding[1], observed[3], 0.0, worn, pace)
        surface_shift(elements.waviness, instant, shift)
        recede(worn, pace, 0.0, shift)
        for i in range(contacts):
            observed[0, i] += shift[0, i]
            observed[1, i] += shift[1, i]
            slip[i] = sliding[1, i] - observed[3, i]
        project_rows(element_rows, pairs, elongation_flat)
        update_turning_dampers(laws, force[1], slip, elongation[1])
        first_forces(laws, elongation, memory, element_force, instant)
        states_at_start(rigid, laws, memory, elongation, step)
    loss, recorded = loss_rate(power, damping, pairs) if book else 0.0, min(every, 1)
    for number in range(steps + 1):
        if number > 0:
            advance(one_step, steady, pairs, after)
            if varies:
                copy(input_end, input_begin)
                interpolate(inputs, number * step, input_end)
                hold(inputs, (number - 0.5) * step, input_begin, input_end)
                add_forces(input_first, input_begin, after)
                add_forces(input_last, input_end, after)
            speed_begin, angle_begin = speed[0], angle
            if turns or special:
                interpolate(drive, number * step, speed)
            if special:
                copy(memory, element.memory_begin)
                if sticks:
                    stop(rigid, laws, element.memory_begin, elongation, step)
                    if not begin_at_rest(rigid, laws, element.memory_begin, pairs, input_begin, element_force,
                                         part.inertia):
                        return UNSETTLED, number, rigid.index[0]
                copy(element_force, element_force_begin)
                copy(shift_flat, shift_begin_flat)
                angle = angle_after(angle, speed_begin, speed[0], step)
                instant = (age + number * step, angle, speed[0])
                add_forces(element_first, element_force, after)
            if rotates:
                copy(turned, turned_begin)
                copy(seen, seen_begin)
                if not turn(turning, after, speed[0], seen, turned, turned_change):
                    return UNTURNED, number, 0
            if contacts:
                if turns:
                    for i in range(contacts):
                        sliding[0, i], sliding[1, i] = sliding[1, i], lever[i] * speed[0]
                        way[i] = 0.5 * step * (sliding[0, i] + sliding[1, i])
                copy(force_flat, held_flat)
                if recalls or dampers_turn:
                    for i in range(contacts):
                        slip[i] = sliding[0, i] - observed[3, i]
                if dampers_turn:
                    update_turning_dampers(laws, held[1], slip, elongation[1])
                if recalls:
                    expect(states, value, friction, held[0], slip, held[1], angle_begin, angle, step, middle)
                if not (constant[0] and constant[1]):
                    add_forces(contact_first, held_flat, after)
                project_rows(rows, after, free_flat)
            if special:
                if moves:
                    surface_shift(waviness, instant, shift)
                    recede(worn, pace, step, shift)
                for i in range(contacts):
                    free[0, i] += shift[0, i]
                    free[1, i] += shift[1, i]
                    status_begin[i] = status[i]
                copy(free_flat, alone_flat)
                project_rows(element_rows, after, element_free)
                if contacts:
                    code, where = solve_together(law, friction, response, elements, laws, contact, element, alone,
                                                 status_begin, instant)
                else:
                    copy(element_free, element_pressed)
                    code, where = solve_elements(laws, element, instant)
                    motion_at_end(element_response, element)
                if code != SOLVED:
                    return code, number, where
                add_forces(element_last, element_force, after)
                if sticks and switches(margin(rigid, laws, element.memory_begin, after, input_end, element_force,
                                              element.end, step, part.needed, part.inertia)):
                    clock = instant[0] - step, 0.0, step, angle_begin, speed_begin, speed[0]
                    code, where, worked = split_step(rigid, element_rows, element, part, pairs, element_force_begin,
                                                     input_begin, input_end, clock)
                    if code != SOLVED:
                        return code, number, where
                    copy(part_flat, after_flat)
                    work[ELEMENTS] += worked
                else:
                    work[ELEMENTS] += element_work(elongation[0], element.end[0], element_force_begin, element_force)
                work[NORMAL] -= shift_work(shift_begin[0], shift[0], held, force, constant[0])
                copy(elongation_end, elongation_flat)
            elif contacts:
                code, where = solve_contacts(law, friction, response, contact)
                if code != SOLVED:
                    return code, number, where
            if contacts:
                add_forces(contact_last, force_flat, after)
                if impulse.size:
                    copy(pairs_flat, kicked_flat)
                    add_forces(impulse, force_flat, kicked)
                    project_rows(rows, kicked, struck_flat)
                    loss = loss_rate(power, damping, kicked) if book else 0.0
                    for i in range(contacts):
                        jump[0, i] = 0.5 * step * (observed[1, i] + struck[1, i])
                        jump[1, i] = 0.5 * step * (observed[3, i] + struck[3, i])
                _account(response, contact, jump, constant, share, summed, work)
                if recalls:
                    for i in range(contacts):
                        slip_end[i] = sliding[1, i] - observed[3, i]
                        mean[i] = force[1, i] if constant[1] else 0.5 * (held[1, i] + force[1, i])
                    settle(states, value, force[0] if constant[0] else held[0], force[0], slip, slip_end, mean, step)
                advance_wear(wear, force[0], sliding[1], observed[3], step, worn, pace)
            if rotates and (contacts or special):
                correct(turning, after, speed[0], seen, turned, turned_change)
            if book:
                rate = loss_rate(power, damping, after)
                if impulse.size:
                    for i in range(kicked_flat.size):
                        kicked_flat[i] = 0.5 * (kicked_flat[i] + after_flat[i])
                    work[DAMPING] += step / 6 * (loss + 4 * loss_rate(power, damping, kicked) + rate)
                else:
                    work[DAMPING] += 0.5 * step * (loss + rate)
                loss = rate
                project_rows(input_rows, after, displacement_end)
                work[INPUT] += turning_work(turned_begin, turned, seen_begin, seen)
                for i in range(count):
                    work[INPUT] += 0.5 * (input_begin[i] + input_end[i]) * (displacement_end[i] - displacement[i])
                    displacement[i] = displacement_end[i]
            copy(after_flat, pairs_flat)
        if number % every == 0:
            total = 0.0
            for i in range(pairs_flat.size):
                total += pairs_flat[i]
            if not np.isfinite(total):
                return DIVERGED, number, 0
            project_rows(sensor_rows, pairs, sensors)
            stored = stored_energy(energy, omega_squared, pairs) if book else 0.0
            row = number // every
            for s in range(sensors.size // 2):
                seen_displacement[s, row], seen_velocity[s, row] = sensors[s], sensors[sensors.size // 2 + s]
            for i in range(contacts):
                seen_gap[i, row] = gap[i] + observed[0, i]
                seen_normal[i, row], seen_friction[i, row] = summed[0, i] / recorded, summed[1, i] / recorded
                seen_slip[i, row], seen_status[i, row] = sliding[1, i] - observed[3, i], status[i]
                summed[0, i] = summed[1, i] = 0.0
            seen_stored[row] = stored
            for k in range(6):
                seen_work[k, row] = work[k]
            for k in range(count_e):
                seen_elongation[k, row], seen_force[k, row] = elongation[0, k], element_force[k]
            recorded = every
    state.angle[0] = angle
    return SOLVED, 0, 0


@njit
def _account(response, contact, jump, constant, share, summed, work):
    """Observables at the end of the step into those at its begin; mean forces, their work, the status of the step.

    ``jump`` (2, c) m is the distance along n and t over which impulses work, empty where there are none.
    """
    free, observed, held, force = contact.free, contact.begin, contact.held, contact.force
    contacts = observed.shape[1]
    for i in range(contacts):
        along_n, along_t = observed[0, i], observed[2, i]
        for o in range(4):
            total = free[o, i]
            for j in range(contacts):
                for f in range(2):
                    total += response[o, f, i, j] * force[f, j]
            observed[o, i] = total
        mean_n = force[0, i] if constant[0] else 0.5 * (held[0, i] + force[0, i])
        mean_t = force[1, i] if constant[1] else 0.5 * (held[1, i] + force[1, i])
        summed[0, i] += mean_n
        summed[1, i] += mean_t
        along_n, along_t = observed[0, i] - along_n, observed[2, i] - along_t
        if jump.size:
            along_n = jump[0, i]
            along_t = jump[1, i] if constant[1] else along_t
        work[NORMAL] += mean_n * along_n
        work[SLIDING] += mean_t * (contact.way[i] - along_t)
        work[FRICTION] += mean_t * along_t
        share[i, contact.status[i]] += 1.0
