"""Dry friction that really sticks, compiled: rate 0 below its limit, and switches that are located inside a step.

A rigid element slides, its force L(v) against the motion, or sticks, its force whatever keeps it at rest within its
limits. Where sliding stops, or a holding force reaches its limit, the step is split at the root, so that every part is
smooth. At a switch the forces of all elements at rest follow together from their accelerations a:

    -L <= F <= L,  a = 0 or F = +-L against a                                   (complementarity, by sweeps)

Within a part of a step the force of a sticking element is linear: it begins with what takes its acceleration away, and
ends with what takes its rate away, so that no error is carried on. Where switches follow each other too closely, and
beside contacts, whose forces are constant over a step, the force is constant over the step and judged at its end
(Moreau 1988): of first order at switches.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import borrowing, njit
from pipeline.physics.time_stepping.contact_solver import SOLVED
from pipeline.physics.time_stepping.coupled_solver import angle_after, motion_at_end
from pipeline.physics.time_stepping.element_forces import (
    DRY,
    FREE,
    UNSETTLED,
    LawKernel,
    solve_elements,
)
from pipeline.physics.time_stepping.linear_step import add_forces, advance, copy, project_rows
from pipeline.physics.time_stepping.normal_laws import contiguous
from pipeline.physics.time_stepping.step_part import part_of_step

#: margin to a switch that counts as none, as a share of the limit; that of a located one; that of a slide to come
_PASSED, _LOCATED, _SLIDES = 1e-9, 1e-11, 1e-9
#: switches located in one step, before the rest of it is taken as one, and trial parts until there is an error
_SWITCHES, _TRIALS = 24, 1000
#: sweeps in which forces at rest settle, and the change that counts as settled
_SWEEPS, _SETTLED = 200, 1e-13
#: parts of a step below which no switch is looked for, and at which a bracket is closed
_SHORTEST, _CLOSEST = 1e-9, 1e-15


class RigidKernel(NamedTuple):
    """r rigid elements whose switches are located, and what parts of a step need of m pairs, i inputs, e elements."""

    index: np.ndarray           # (r,) among the elements
    blocks: np.ndarray          # (m, 2, 2) A of the pairs
    driven: np.ndarray          # (i + e, 2, m) rates of the pairs per unit of input and element force
    acceleration: np.ndarray    # (r, 2, m) along the elements, from the pairs
    by_input: np.ndarray        # (r, i) and per unit of input force
    by_element: np.ndarray      # (r, e) and of element force


class Part(NamedTuple):
    """Room for a part of a step; forces are those of the inputs, then of the elements."""

    step: np.ndarray            # (2, 2, m)
    first: np.ndarray           # (i + e, 2, m)
    last: np.ndarray            # (i + e, 2, m)
    laws: LawKernel             # of the elements, with the response over the part
    begin: np.ndarray           # (2, m) pairs
    end: np.ndarray             # (2, m)
    steady: np.ndarray          # (2, m) zeros
    force: np.ndarray           # (i + e,) N at its begin
    force_end: np.ndarray       # (i + e,) N at its end
    given: np.ndarray           # (2, i) N at the begin and end of the step
    inputs: np.ndarray          # (i,) N at the end of the part
    seen: np.ndarray            # (2 e,) elongations and rates without the forces at the end
    needed: np.ndarray          # (e,) N
    inertia: np.ndarray         # (r,) m/s^2
    bracket: np.ndarray         # (5,) see ``_narrowed``


def rigid_kernel(model, system, captured):
    """RigidKernel of a SlidingModel and its ModalSystem; without elements where they are ``captured`` instead."""
    rows = np.array([e.row for e in model.elements], float).reshape(-1, model.size)
    index = np.array([k for k, e in enumerate(model.elements) if located(e) and not captured], np.int64)
    if not len(index):
        return RigidKernel(index, *(np.zeros(shape) for shape in ((0, 2, 2), *[(0, 2, 0)] * 2, *[(0, 0)] * 2)))
    driven = system.driven(np.vstack((model.input_rows, -rows)))
    rate = system.observed(rows[index])[1]
    by_force, inputs = np.einsum("rbm,fbm->rf", rate, driven), len(model.input_rows)
    arrays = (system.blocks, driven, np.einsum("ram,mab->rbm", rate, system.blocks), by_force[:, :inputs],
              by_force[:, inputs:])
    return RigidKernel(index, *(contiguous(a) for a in arrays))


def located(element):
    """Whether an Element is rigid dry friction of some size."""
    law = element.law
    return bool(np.isinf(getattr(law, "stiffness", 0.0)).any()) and max(law.forward, law.backward) > 0


def part_of(rigid, elements):
    """Part of the steps of a RigidKernel and its ElementKernel."""
    forces, pairs, count, inputs = len(rigid.driven), len(rigid.blocks), len(elements.kind), rigid.by_input.shape[1]
    laws = LawKernel(elements.kind, elements.parameter, elements.first, elements.stiffness, elements.limit,
                     np.zeros((2, count, count)))
    return Part(np.zeros((2, 2, pairs)), np.zeros((forces, 2, pairs)), np.zeros((forces, 2, pairs)), laws,
                *np.zeros((3, 2, pairs)), *np.zeros((2, forces)), np.zeros((2, inputs)), np.zeros(inputs),
                np.zeros(2 * count), np.zeros(count), np.zeros(len(rigid.index)), np.zeros(5))


@borrowing
def _limits(laws, k):
    """(forward, backward) largest holding force of element ``k``, N."""
    p = laws.parameter[k]
    return p[1] * (1.0 + p[3]), p[2] * (1.0 + p[3])


@borrowing
def _reach(rigid, laws, n, step):
    """Change of the rate (m/s) of rigid element ``n`` by its own friction within a ``step``."""
    k = rigid.index[n]
    return max(*_limits(laws, k)) * abs(rigid.by_element[n, k]) * step


@borrowing
def _hold(rigid, laws, memory, pairs, inputs, force, limited, inertia):
    """Whether the ``force`` (e,) of all elements at rest settles at what takes their accelerations away.

    ``limited``: within their limits.
    """
    project_rows(rigid.acceleration, pairs, inertia)
    for n in range(rigid.index.size):
        for i in range(inputs.size):
            inertia[n] += rigid.by_input[n, i] * inputs[i]
    for _ in range(_SWEEPS):
        change, size = 0.0, 0.0
        for n in range(rigid.index.size):
            k = rigid.index[n]
            if memory[laws.first[k]] == 0.0:
                total = inertia[n]
                for j in range(force.size):
                    total += rigid.by_element[n, j] * force[j]
                wanted = force[k] - total / rigid.by_element[n, k]
                if limited:
                    forward, backward = _limits(laws, k)
                    wanted = min(max(wanted, -backward), forward)
                change, size = max(change, abs(wanted - force[k])), max(size, abs(wanted), abs(force[k]))
                force[k] = wanted
        if change <= _SETTLED * size:
            return True
    return False


@borrowing
def begin_at_rest(rigid, laws, memory, pairs, inputs, force, inertia):
    """Forces and states of the elements at rest, at the begin of a step or after a switch; whether they settle.

    The state of an element, in its ``memory``: 0 at rest, else the sign of its sliding. ``force`` (e,) holds those of
    all others.
    """
    rests = False
    for n in range(rigid.index.size):
        rests = rests or memory[laws.first[rigid.index[n]]] == 0.0
    if not rests:
        return True
    settled = _hold(rigid, laws, memory, pairs, inputs, force, True, inertia)
    for n in range(rigid.index.size):
        k = rigid.index[n]
        if memory[laws.first[k]] == 0.0:
            forward, backward = _limits(laws, k)
            if force[k] >= (1.0 - _SLIDES) * forward:
                memory[laws.first[k]] = 1.0
            elif force[k] <= -(1.0 - _SLIDES) * backward:
                memory[laws.first[k]] = -1.0
    return settled


@borrowing
def margin(rigid, laws, memory, pairs, inputs, force, motion, step, needed, inertia):
    """The least margin to a switch at ``pairs``, below 0 beyond it, as a share of the limit.

    ``motion`` (2, e); the rate of a sliding element counts by what its friction changes in a ``step``. ``memory`` as of
    ``begin_at_rest``; ``needed`` (e,) and ``inertia`` (r,) are scratch.
    """
    least, rests = np.inf, False
    for n in range(rigid.index.size):
        k = rigid.index[n]
        if memory[laws.first[k]] == 0.0:
            rests = True
        else:
            least = min(least, memory[laws.first[k]] * motion[1, k] / _reach(rigid, laws, n, step))
    if not rests:
        return least
    copy(force, needed)
    _hold(rigid, laws, memory, pairs, inputs, needed, False, inertia)
    for n in range(rigid.index.size):
        k = rigid.index[n]
        if memory[laws.first[k]] == 0.0:
            forward, backward = _limits(laws, k)
            least = min(least, min(forward - needed[k], backward + needed[k]) / max(forward, backward))
    return least


@borrowing
def switches(least):
    """Whether a margin says that a switch lies behind."""
    return least < -_PASSED


@borrowing
def states_at_start(rigid, laws, memory, motion, step):
    """Put the sign of the rate into the ``memory`` of rigid elements that move at all; others keep their state."""
    for n in range(rigid.index.size):
        k = rigid.index[n]
        if abs(motion[1, k]) > _PASSED * _reach(rigid, laws, n, step):
            memory[laws.first[k]] = np.sign(motion[1, k])


@borrowing
def stop(rigid, laws, memory, motion, step):
    """Bring to rest, in their ``memory``, the sliding elements whose rate has vanished; ``motion`` (2, e)."""
    for n in range(rigid.index.size):
        k = rigid.index[n]
        if memory[laws.first[k]] * motion[1, k] <= _PASSED * _reach(rigid, laws, n, step):
            memory[laws.first[k]] = 0.0


@borrowing
def _response(rows, part, inputs):
    """Fill the response of elongations and rates to the forces at the end of a Part."""
    count = part.needed.size
    for j in range(count):
        for r in range(2 * count):
            total = 0.0
            for a in range(2):
                for m in range(part.end.shape[1]):
                    total += rows[r, a, m] * part.last[inputs + j, a, m]
            part.laws.response[r // count, r % count, j] = total


@borrowing
def _release(rigid, element, part, inputs):
    """Let the forces of rigid elements be constant over a Part, and judged at its end."""
    for n in range(rigid.index.size):
        k = rigid.index[n]
        for a in range(2):
            for m in range(part.end.shape[1]):
                part.last[inputs + k, a, m] += part.first[inputs + k, a, m]
                part.first[inputs + k, a, m] = 0.0
        element.memory_begin[part.laws.first[k]] = FREE


@njit
def _take(rigid, rows, element, part, length, clock, crowded):
    """(code, element): take a Part over ``length`` s, from where it and the ElementStep begin.

    ``clock``: time s at the begin of the step, s of it that are done, its duration s; angle rad of the drive at its
    begin, speeds rad/s at begin and end.
    """
    begun, done, step, angle, speed, last_speed = clock
    inputs, count = part.inputs.size, element.force.size
    part_of_step(rigid.blocks, rigid.driven, length, part.step, part.first, part.last)
    if crowded:
        _release(rigid, element, part, inputs)
    _response(rows, part, inputs)
    for i in range(inputs):
        rise = (part.given[1, i] - part.given[0, i]) / step
        part.force[i] = part.given[0, i] + done * rise
        part.inputs[i] = part.force_end[i] = part.given[0, i] + (done + length) * rise
    for k in range(count):
        part.force_end[inputs + k] = 0.0
        element.force[k] = part.force[inputs + k]
    advance(part.step, part.steady, part.begin, part.end)
    add_forces(part.first, part.force, part.end)
    add_forces(part.last, part.force_end, part.end)
    project_rows(rows, part.end, part.seen)
    for k in range(count):
        for o in range(2):
            element.free[o, k] = element.pressed[o, k] = part.seen[o * count + k]
    now = speed + (done + length) / step * (last_speed - speed)
    instant = (begun + done + length, angle_after(angle, speed, now, done + length), now)
    code, where = solve_elements(part.laws, element, instant)
    if code == SOLVED:
        motion_at_end(part.laws.response, element)
        for i in range(inputs):
            part.force_end[i] = 0.0
        for k in range(count):
            part.force_end[inputs + k] = element.force[k]
        add_forces(part.last, part.force_end, part.end)
    return code, where


@borrowing
def _margin_of_part(rigid, element, part, step):
    """Margin at the end of a Part."""
    return margin(rigid, part.laws, element.memory_begin, part.end, part.inputs, element.force, element.end, step,
                  part.needed, part.inertia)


@borrowing
def _narrowed(bracket, length, share, step):
    """Length of the next trial part once one of ``length`` s has the margin ``share``: 0 where the root is located,
    below 0 where there is none apart from the begin.

    ``bracket`` (5,): lengths with a margin above and below 0, these margins, and the side of the last trial. First
    halving, until a margin lies above 0, as at a switch it begins at 0; then secants (Illinois).
    """
    if share > _LOCATED:
        bracket[0], bracket[2] = length, share
        bracket[3] *= 0.5 if bracket[4] > 0.0 else 1.0
        bracket[4] = 1.0
    else:
        bracket[1], bracket[3] = length, min(share, 0.0)
        bracket[2] *= 0.5 if bracket[4] < 0.0 and bracket[0] > 0.0 else 1.0
        bracket[4] = -1.0
    if bracket[0] == 0.0:
        return 0.5 * length if length > _SHORTEST * step else -1.0
    if abs(share) <= _LOCATED or bracket[1] - bracket[0] <= _CLOSEST * step:
        return 0.0
    return bracket[0] + (bracket[1] - bracket[0]) * bracket[2] / (bracket[2] - bracket[3])


@borrowing
def _go_on(rigid, element, part, step):
    """Let the next part begin where a Part ended; whether the forces at rest settle there."""
    count, inputs = element.force.size, part.inputs.size
    for m in range(part.end.shape[1]):
        part.begin[0, m], part.begin[1, m] = part.end[0, m], part.end[1, m]
    for k in range(count):
        element.begin[0, k], element.begin[1, k] = element.end[0, k], element.end[1, k]
    copy(element.memory, element.memory_begin)
    stop(rigid, part.laws, element.memory_begin, element.begin, step)
    settled = begin_at_rest(rigid, part.laws, element.memory_begin, part.begin, part.inputs, element.force,
                            part.inertia)
    for k in range(count):
        part.force[inputs + k] = element.force[k]
    return settled


@borrowing
def _part_work(element, part, crowded):
    """Work (J) of the elements on the bodies over a Part."""
    total, inputs = 0.0, part.inputs.size
    for k in range(element.force.size):
        rigid = crowded and part.laws.kind[k] == DRY and np.isinf(part.laws.parameter[k, 0])
        first = element.force[k] if rigid else part.force[inputs + k]
        total -= 0.5 * (first + element.force[k]) * (element.end[0, k] - element.begin[0, k])
    return total


@njit
def split_step(rigid, rows, element, part, pairs, force, begin_inputs, end_inputs, clock):
    """(code, element, work J): take a step in parts between its switches, and the work of the elements over it.

    ``pairs`` (2, m) and element forces ``force`` (e,) are those at its begin, ``rows`` (2 e, 2, m) of the ElementStep,
    which is led to its end as is ``part.end``; ``clock`` as of ``_take``.
    """
    begun, _, step, angle, speed, last_speed = clock
    done, work, count, part.bracket[:] = 0.0, 0.0, 0, 0.0
    for m in range(pairs.shape[1]):
        part.begin[0, m], part.begin[1, m] = pairs[0, m], pairs[1, m]
    for k in range(force.size):
        part.force[part.inputs.size + k] = force[k]
    for i in range(part.inputs.size):
        part.given[0, i], part.given[1, i] = begin_inputs[i], end_inputs[i]
    length, trials, crowded = step, 0, step < 0.0
    while trials < _TRIALS:
        now = begun, done, step, angle, speed, last_speed
        code, where = _take(rigid, rows, element, part, length, now, crowded)
        if code != SOLVED:
            return code, where, work
        least, trials = 0.0 if crowded else _margin_of_part(rigid, element, part, step), trials + 1
        if part.bracket[1] > 0.0 or switches(least):
            length_next = _narrowed(part.bracket, length, least, step)
            if length_next != 0.0:
                crowded = length_next < 0.0
                length = step - done if crowded else length_next
                part.bracket[1] = 0.0 if crowded else part.bracket[1]
                continue
        work += _part_work(element, part, crowded)
        done += length
        count += 1
        if step - done <= _SHORTEST * step:
            return SOLVED, 0, work
        if not _go_on(rigid, element, part, step):
            break
        length, crowded, part.bracket[:] = step - done, count >= _SWITCHES, 0.0
    return UNSETTLED, rigid.index[0], work
