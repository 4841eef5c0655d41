"""Elements within a time step, compiled: their forces and those of the contacts, found together.

The force of an element is linear between begin and end of a step, the value at its end belongs to the motion at the
end. Contacts and elements are solved in turn until the element forces stay; the waviness of a surface and its wear move
the gap of its contact.
"""

import numpy as np

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.time_stepping.contact_solver import SOLVED, solve_contacts
from pipeline.physics.time_stepping.element_forces import (
    MAXWELL,
    TOLERANCE,
    UNSETTLED,
    element_force,
    laws_of,
    solve_elements,
    wave,
)

ROUNDS = 200


@njit
def surface_shift(waviness, instant, shift):
    """Fill ``shift`` (2, c): what waviness adds to the gap and the opening rate of each contact."""
    shift[:] = 0.0
    for w in range(waviness.shape[0]):
        contact = int(waviness[w, 0])
        place, speed = wave(waviness[w, 1], waviness[w, 2], waviness[w, 3], waviness[w, 4], instant)
        grown, growing = 1.0, 0.0
        if waviness[w, 5] > 0.0:
            grown = -np.expm1(-instant[0] / waviness[w, 5])
            growing = (1.0 - grown) / waviness[w, 5]
        shift[0, contact] += grown * place
        shift[1, contact] += grown * speed + growing * place


@njit
def recede(worn, pace, step, shift):
    """Add to ``shift`` (2, c) the depth ``worn`` (c,) m that a step (s) begins with, going on at ``pace`` (c,) m/s."""
    for i in range(pace.size):
        shift[0, i] += worn[i] + step * pace[i]
        shift[1, i] += pace[i]


@njit
def wear_on(wear, force, drive, speed, step, worn, pace):
    """Wear over a step, by the trapezoidal rule: fill ``worn`` (c,) m and ``pace`` (c,) m/s = wear N |slip| at its end.

    ``force`` (c,) N, sliding velocity ``drive`` and velocity ``speed`` (c,) m/s along it are those at the end.
    """
    for i in range(wear.size):
        last = wear[i] * force[i] * abs(drive[i] - speed[i])
        worn[i] += 0.5 * step * (pace[i] + last)
        pace[i] = last


@njit
def first_forces(elements, place, memory, force, instant):
    """Fill ``force`` (e,) for elongation and rate ``place`` (2, e) at time 0; memory is as it stands there."""
    unchanged = memory.copy()
    for k in range(force.size):
        force[k] = element_force(elements, k, place[0, k], place[1, k], place[0, k], memory, unchanged, instant)[0]


@njit
def solve_together(law, friction, response, elements, alone, free, seen, held, sliding, way, force, status, earlier,
                   before, lonely, place, begin, remembered, memory, drawn, instant):
    """(code, number): forces of contacts and elements at the end of a step, as ``solve_contacts``.

    ``alone`` (4, c) are the observables of the contacts, ``lonely`` (2, e) those of the elements, without the forces
    at the end; ``free`` gets the former with the element forces, ``place`` (2, e) the latter with all. ``earlier``
    (c,) is the status at the begin, ``drawn`` (e,) the element forces.
    """
    contacts, count, laws = law.gap.size, drawn.size, laws_of(elements)
    loose, grain = place.copy(), np.zeros(count)
    for _ in range(ROUNDS):
        for i in range(contacts):
            for o in range(4):
                total = alone[o, i]
                for k in range(count):
                    total += elements.to_contacts[o, i, k] * drawn[k]
                free[o, i] = total
        if contacts:
            status[:] = earlier
            code, contact = solve_contacts(law, friction, response, free, seen, held, sliding, way, force, status,
                                           before)
            if code != SOLVED:
                return code, contact
        settled, size = True, 0.0
        for k in range(count):
            for o in range(2):
                total = lonely[o, k]
                for f in range(2):
                    for i in range(contacts):
                        total += elements.to_elements[o, k, f, i] * force[f, i]
                loose[o, k] = total
            place[0, k] = drawn[k]
        code, number = solve_elements(laws, loose, begin, remembered, memory, drawn, grain, instant)
        if code != SOLVED:
            return code, number
        for k in range(count):
            size = max(size, abs(drawn[k]))
        for k in range(count):
            settled = settled and abs(drawn[k] - place[0, k]) <= TOLERANCE * size + grain[k]
        if settled:
            pulled(laws.own, loose, drawn, place)
            return SOLVED, 0
    return UNSETTLED, 0


@njit
def pulled(own, loose, drawn, place):
    """Fill ``place`` (2, e): elongation and rate ``loose`` (2, e) with the element forces ``drawn`` (e,)."""
    for k in range(drawn.size):
        for o in range(2):
            place[o, k] = loose[o, k]
            for j in range(drawn.size):
                place[o, k] += own[o, k, j] * drawn[j]


@njit
def settle_element_books(now, after, drawn_before, drawn):
    """Work (J) of the elements on the bodies over a step: mean force times way."""
    total = 0.0
    for k in range(drawn.size):
        total -= 0.5 * (drawn_before[k] + drawn[k]) * (after[k] - now[k])
    return total


@njit
def shift_work(shift_before, shift, held, force, holds):
    """What the moving surface adds to the work of the normal forces over a step; it does not reach the bodies."""
    total = 0.0
    for i in range(shift.size):
        mean = force[0, i] if holds else 0.5 * (held[0, i] + force[0, i])
        total += mean * (shift[i] - shift_before[i])
    return total


@njit
def middle_angle(angle, before, turning, step):
    """Angle of the drive after a step over which its speed is linear."""
    return angle + 0.5 * step * (before + turning)


def no_memory(elements, time=0.0):
    """Memory (s,) of elements that have not yet moved at ``time`` s."""
    memory = np.zeros(int(elements.first[-1]))
    memory[elements.first[1:][elements.kind == MAXWELL] - 1] = time
    return memory
