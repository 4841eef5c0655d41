"""Elements within a time step, compiled: their forces and those of the contacts, solved together.

The force of an element is linear between begin and end of a step, the value at its end belongs to the motion at the
end. Contacts and elements are solved in turn until the element forces stay; the waviness of a surface and its wear move
the gap of its contact.
"""

import numpy as np

from pipeline.physics.numerics.compiled import borrowing, njit
from pipeline.physics.time_stepping.contact_solver import SOLVED, solve_contacts
from pipeline.physics.time_stepping.element_forces import (
    MAXWELL,
    TOLERANCE,
    UNSETTLED,
    element_force,
    solve_elements,
    wave,
)

ROUNDS = 200


@borrowing
def surface_shift(waviness, instant, shift):
    """Fill ``shift`` (2, c): what waviness adds to the gap and the opening rate of each contact."""
    shift[:] = 0.0
    for w in range(waviness.shape[0]):
        contact = int(waviness[w, 0])
        height, speed = wave(waviness[w, 1], waviness[w, 2], waviness[w, 3], waviness[w, 4], instant)
        grown, growing = 1.0, 0.0
        if waviness[w, 5] > 0.0:
            grown = -np.expm1(-instant[0] / waviness[w, 5])
            growing = (1.0 - grown) / waviness[w, 5]
        shift[0, contact] += grown * height
        shift[1, contact] += grown * speed + growing * height


@borrowing
def recede(worn, pace, step, shift):
    """Add to ``shift`` (2, c) the depth ``worn`` (c,) m that a step (s) begins with, going on at ``pace`` (c,) m/s."""
    for i in range(pace.size):
        shift[0, i] += worn[i] + step * pace[i]
        shift[1, i] += pace[i]


@borrowing
def advance_wear(wear, force, drive, speed, step, worn, pace):
    """Wear over a step, by the trapezoidal rule: fill ``worn`` (c,) m and ``pace`` (c,) m/s = wear N |slip| at its end.

    ``force`` (c,) N, sliding velocity ``drive`` and velocity ``speed`` (c,) m/s along it are those at the end.
    """
    for i in range(wear.size):
        last = wear[i] * force[i] * abs(drive[i] - speed[i])
        worn[i] += 0.5 * step * (pace[i] + last)
        pace[i] = last


@njit
def first_forces(laws, motion, memory, force, instant):
    """Fill ``force`` (e,) for elongation and rate ``motion`` (2, e) at time 0; memory is as it stands there."""
    unchanged = memory.copy()
    for k in range(force.size):
        force[k] = element_force(laws, k, motion[0, k], motion[1, k], motion[0, k], memory, unchanged, instant)[0]


@borrowing
def solve_together(law, friction, response, elements, laws, contacts, step, free, status, instant):
    """(code, number): forces of contacts and elements at the end of a step, as ``solve_contacts``.

    ``laws`` are those of the ``elements``; ``contacts`` is a ContactStep and ``step`` an ElementStep; ``free`` (4, c)
    are the observables of the contacts without the forces at the end, to which the element forces come; ``status``
    (c,) those at the begin.
    """
    count = step.force.size
    for _ in range(ROUNDS):
        for i in range(status.size):
            contacts.status[i] = status[i]
            for o in range(4):
                total = free[o, i]
                for k in range(count):
                    total += elements.to_contacts[o, i, k] * step.force[k]
                contacts.free[o, i] = total
        code, number = solve_contacts(law, friction, response, contacts)
        if code != SOLVED:
            return code, number
        for k in range(count):
            for o in range(2):
                total = step.free[o, k]
                for f in range(2):
                    for i in range(status.size):
                        total += elements.to_elements[o, k, f, i] * contacts.force[f, i]
                step.pressed[o, k] = total
            step.end[0, k] = step.force[k]
        code, number = solve_elements(laws, step, instant)
        if code != SOLVED:
            return code, number
        settled, size = True, 0.0
        for k in range(count):
            size = max(size, abs(step.force[k]))
        for k in range(count):
            settled = settled and abs(step.force[k] - step.end[0, k]) <= TOLERANCE * size + step.rounding[k]
        if settled:
            motion_at_end(laws.response, step)
            return SOLVED, 0
    return UNSETTLED, 0


@borrowing
def motion_at_end(response, step):
    """Fill the elongation and rate at the end: those without the element forces, and what the forces add."""
    for k in range(step.force.size):
        for o in range(2):
            total = step.pressed[o, k]
            for j in range(step.force.size):
                total += response[o, k, j] * step.force[j]
            step.end[o, k] = total


@borrowing
def element_work(begin, end, force_begin, force_end):
    """Work (J) of the elements on the bodies over a step: mean force times change of the elongation."""
    total = 0.0
    for k in range(begin.size):
        total -= 0.5 * (force_begin[k] + force_end[k]) * (end[k] - begin[k])
    return total


@borrowing
def shift_work(begin, end, held, force, holds):
    """What the moving surface adds to the work of the normal forces over a step; it does not reach the bodies."""
    total = 0.0
    for i in range(begin.size):
        mean = force[0, i] if holds else 0.5 * (held[0, i] + force[0, i])
        total += mean * (end[i] - begin[i])
    return total


@borrowing
def angle_after(angle, speed_begin, speed_end, step):
    """Angle of the drive after a step over which its speed is linear."""
    return angle + 0.5 * step * (speed_begin + speed_end)


def no_memory(elements, time=0.0):
    """Memory (s,) of elements that have not yet moved at ``time`` s."""
    memory = np.zeros(int(elements.first[-1]))
    memory[elements.first[1:][elements.kind == MAXWELL] - 1] = time
    return memory
