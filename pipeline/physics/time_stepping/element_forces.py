"""Forces of nonlinear elements, compiled: one function for all kinds, and their solution over one time step.

F is the force that an element draws with at both ends of its row, positive where it resists elongation e = b q with
rate v; bodies feel -F b. Kinds with memory are functions of the elongation since the begin of the step and of what
they remember from there:

    polynomial  F = k1 e + k2 e^2 + k3 e^3
    power       F = c |v|^(p - 1) v
    sliders     F = k1 e + sum_j clip(F_j + k_j de, -L_j, L_j)      parallel Jenkins elements (Iwan 1966)
    dry         F = clip(F + k de, -L(v), L(v)), L = F_c (1 + r exp(-|v| / v_s)), F_c of each direction; rigid with k
                infinite: F = L(v) sgn(v), at v = 0 what keeps it there (``rigid_friction``)
    bouc_wen    F = k1 e + k z, dz = (1 - |z / d|^n (s + (1 - s) sgn(z de))) de       (Wen 1976, s = beta d^n)
    maxwell     F = k1 e + sum_j F_j, F_j' = k_j v - F_j / tau_j             v constant over the step
    gap         F = k_stop (e - i) + k_inner i, i = clip(e, -lower, upper)
    softening   F = -k (1 - exp(-t / tau)) e
    wave        F = -(k u + c u'), u = a cos(order * angle + 2 pi f t - phase)
    turning     F = share |T| v / |slip|, slip and T of a contact; |slip| with v, along the row, as its other part
    parametric  F = k cos(order * angle + 2 pi f t - phase) e
    detent      F = s sin(2 pi e / period) + c cos(2 pi e / period)
    stop        F = max(0, k (e - upper) + c v) beyond upper, min(0, k (e + lower) + c v) beyond -lower
    presliding, rate_state, positional: see ``physics.friction.joint_friction``
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.joint_friction import positional, presliding, rate_state
from pipeline.physics.numerics.compiled import borrowing, njit
from pipeline.physics.time_stepping.contact_solver import LARGEST_STIFFNESS, SOLVED

POLYNOMIAL, POWER, SLIDERS, DRY, BOUC_WEN, GAP, SOFTENING, WAVE, MAXWELL, TURNING = range(10)
#: state of a rigid element over a step at whose end it is decided whether it slides, beside 0 (at rest) and its sign
FREE = 2.0
PARAMETRIC, DETENT, STOP, PRESLIDING, RATE_STATE, POSITIONAL = range(10, 16)
#: friction, which has no force where a motion starts and none at rest
FRICTION = (DRY, PRESLIDING, RATE_STATE, POSITIONAL)
#: from this one on the forces of laws, which jump or have no slope of use, are enclosed, not found by Newton's method
ENCLOSED = STOP
#: codes of a step that has no solution, beside those of the contacts
TOO_STIFF, UNSETTLED = 5, 6
#: sizes of the way of a Bouc-Wen element after which nothing is left of where it started
FORGOTTEN = 40.0
#: largest product of a damper that turns with friction and the mobility along it over one step
STRONGEST_TURNING = 10.0
#: relative rounding of an elongation that is a sum of a few terms
ROUNDING = 4 * np.finfo(np.float64).eps
#: forces in N that count as none, far above the smallest numbers
SMALLEST = 1e-290
SWEEPS, ITERATIONS, TOLERANCE, LOCAL_TOLERANCE = 500, 100, 1e-10, 1e-13


class ElementKernel(NamedTuple):
    """e elements, as the compiled loops need them; memory and sliders of element k are ``first[k]:first[k + 1]``.

    The last memory of Maxwell branches is the time at which they had their forces.
    """

    kind: np.ndarray            # (e,)
    parameter: np.ndarray       # (e, 6) in the order of the law's fields
    first: np.ndarray           # (e + 1,)
    stiffness: np.ndarray       # (s,) N/m of sliders and Maxwell branches
    limit: np.ndarray           # (s,) N of sliders, s of Maxwell branches
    rows: np.ndarray            # (2 e, 2, m) elongation, then its rate, from the pairs
    response: np.ndarray        # (2, e, e) of elongation and rate to the forces at the end of the step
    to_contacts: np.ndarray     # (4, c, e) of the observables of the contacts to these forces
    to_elements: np.ndarray     # (2, e, 2, c) of elongation and rate to the contact forces
    waviness: np.ndarray        # (w, 6) contact, amplitude (m), order, frequency (Hz), phase (rad), growth (s)
    wear: np.ndarray            # (c,) 1/N, depth per normal force and way; empty where nothing wears


class LawKernel(NamedTuple):
    """What the forces alone need of an ElementKernel: fewer arrays, which every compiled call has to hand on."""

    kind: np.ndarray
    parameter: np.ndarray
    first: np.ndarray
    stiffness: np.ndarray
    limit: np.ndarray
    response: np.ndarray


class ElementStep(NamedTuple):
    """e elements over one time step: what is given, and the forces that are solved for."""

    free: np.ndarray            # (2, e) elongation and rate at the end without forces of contacts and elements there
    pressed: np.ndarray         # (2, e) the same with the forces of the contacts
    begin: np.ndarray           # (2, e) elongation and rate at the begin
    memory_begin: np.ndarray    # (s,) what the elements remember from there
    memory: np.ndarray          # (s,) what they remember at the end
    force: np.ndarray           # (e,) N at the end; a guess, then the solution
    rounding: np.ndarray        # (e,) N, what rounding of elongation and rate makes of it
    end: np.ndarray             # (2, e) elongation and rate at the end


@njit
def laws_of(kernel):
    """LawKernel of an ElementKernel."""
    return LawKernel(kernel.kind, kernel.parameter, kernel.first, kernel.stiffness, kernel.limit, kernel.response)


@borrowing
def wave(amplitude, order, frequency, phase, instant):
    """(u, u') at ``instant``: (time s, angle rad and speed rad/s of the drive)."""
    time, angle, turning = instant
    argument = order * angle + 2 * np.pi * frequency * time - phase
    return (amplitude * np.cos(argument),
            -amplitude * (order * turning + 2 * np.pi * frequency) * np.sin(argument))


@borrowing
def element_force(kernel, k, elongation, rate, begin, remembered, memory, instant):
    """(F, dF/de, dF/dv) of element ``k``; ``memory`` (s,) is filled with what it remembers at the end.

    ``begin`` is the elongation where it remembered ``remembered``.
    """
    kind, p, start, last = kernel.kind[k], kernel.parameter[k], kernel.first[k], kernel.first[k + 1]
    moved = elongation - begin
    if kind == POLYNOMIAL:
        return (elongation * (p[0] + elongation * (p[1] + elongation * p[2])),
                p[0] + elongation * (2 * p[1] + 3 * elongation * p[2]), 0.0)
    if kind == POWER:
        steep = p[0] * abs(rate) ** (p[1] - 1)
        return steep * rate, 0.0, p[1] * steep
    if kind == SLIDERS:
        force, slope = p[0] * elongation, p[0]
        for s in range(start, last):
            trial = remembered[s] + kernel.stiffness[s] * moved
            memory[s] = min(max(trial, -kernel.limit[s]), kernel.limit[s])
            force += memory[s]
            if abs(trial) <= kernel.limit[s]:
                slope += kernel.stiffness[s]
        return force, slope, 0.0
    if kind == DRY:
        rise = 1.0 + p[3] * np.exp(-abs(rate) / p[4])
        if np.isinf(p[0]):
            memory[start] = np.sign(rate)
            return rise * (p[1] * max(memory[start], 0.0) + p[2] * min(memory[start], 0.0)), 0.0, 0.0
        trial = remembered[start] + p[0] * moved
        memory[start] = min(max(trial, -p[2] * rise), p[1] * rise)
        return memory[start], p[0] if memory[start] == trial else 0.0, 0.0
    if kind == BOUC_WEN:
        memory[start], slope = _bouc_wen(remembered[start], moved, p[2], p[3], p[4])
        return p[0] * elongation + p[1] * memory[start], p[0] + p[1] * slope, 0.0
    if kind == GAP:
        inner = min(max(elongation, -p[2]), p[3])
        return (p[0] * (elongation - inner) + p[1] * inner, p[1] if -p[2] < elongation < p[3] else p[0], 0.0)
    if kind == SOFTENING:
        slope = -p[0] * (1.0 - np.exp(-instant[0] / p[1]))
        return slope * elongation, slope, 0.0
    if kind == TURNING:
        return p[2] * rate, 0.0, p[2]
    if kind == PARAMETRIC:
        slope = p[0] * np.cos(p[1] * instant[1] + 2 * np.pi * p[2] * instant[0] - p[3])
        return slope * elongation, slope, 0.0
    if kind == DETENT:
        turn = 2 * np.pi / p[2]
        sine, cosine = np.sin(turn * elongation), np.cos(turn * elongation)
        return p[0] * sine + p[1] * cosine, turn * (p[0] * cosine - p[1] * sine), 0.0
    if kind == STOP:
        return _stop(elongation, rate, p)
    if kind > STOP:
        return _friction(kind, elongation, rate, moved, remembered[start:last], memory[start:last], p, instant[0])
    if kind == MAXWELL:
        force, slope = _maxwell(kernel, start, last - 1, moved, remembered, memory, instant[0])
        return p[0] * elongation + force, p[0] + slope, 0.0
    height, speed = wave(p[2], p[3], p[4], p[5], instant)
    return -(p[0] * height + p[1] * speed), 0.0, 0.0


@borrowing
def _stop(elongation, rate, p):
    """(F, dF/de, dF/dv) of stops."""
    beyond = max(0.0, elongation - p[3]) + min(0.0, elongation + p[2])
    force = p[0] * beyond + p[1] * rate
    return (force, p[0], p[1]) if force * beyond > 0.0 else (0.0, 0.0, 0.0)


@borrowing
def _friction(kind, elongation, rate, moved, remembered, memory, p, time):
    """(F, 0, 0) of friction, which has no slope of use where it turns."""
    if kind == PRESLIDING:
        return presliding(moved, rate, remembered, memory, p), 0.0, 0.0
    if kind == RATE_STATE:
        return rate_state(rate, time, remembered, memory, p), 0.0, 0.0
    return positional(elongation, rate, p), 0.0, 0.0


@borrowing
def update_turning_dampers(kernel, friction, slip, rate):
    """Set the damping of all ``turning`` elements by friction forces and slip speeds (c,), and their own rates (e,).

    As it is taken at the begin of a step, it resists whatever the step; where friction all but stops the slip, it is
    no stronger than what stops the motion along the row within the step.
    """
    for k in range(kernel.kind.size):
        if kernel.kind[k] == TURNING:
            p = kernel.parameter[k]
            i, mobile = int(p[0]), abs(kernel.response[1, k, k])
            speed = np.hypot(slip[i], rate[k])
            p[2] = p[1] * abs(friction[i]) / speed if speed > 0.0 else 0.0
            if p[2] * mobile > STRONGEST_TURNING:
                p[2] = STRONGEST_TURNING / mobile


@borrowing
def _maxwell(kernel, start, clock, moved, remembered, memory, time):
    """(F, dF/de) of the branches ``start:clock`` after ``moved`` m; exact where the rate is constant over the step."""
    passed, force, slope = time - remembered[clock], 0.0, 0.0
    memory[clock] = time
    for s in range(start, clock):
        relaxed = -np.expm1(-passed / kernel.limit[s])
        share = kernel.stiffness[s] * relaxed * kernel.limit[s] / passed if passed > 0.0 else 0.0
        memory[s] = (1.0 - relaxed) * remembered[s] + share * moved
        force += memory[s]
        slope += share
    return force, slope


@borrowing
def _bouc_wen_slope(z, way, size, exponent, shape):
    return 1.0 - (abs(z) / size) ** exponent * (shape + (1.0 - shape) * np.sign(z * way))


@borrowing
def _bouc_wen(z, way, size, exponent, shape):
    """(z, dz/de) after ``way`` m, by classical Runge-Kutta steps over a quarter of the size at most."""
    way = min(max(way, -FORGOTTEN * size), FORGOTTEN * size)
    parts = int(np.ceil(4 * abs(way) / size)) if way != 0.0 else 1
    h = way / parts
    for _ in range(parts):
        a = _bouc_wen_slope(z, way, size, exponent, shape)
        b = _bouc_wen_slope(z + 0.5 * h * a, way, size, exponent, shape)
        c = _bouc_wen_slope(z + 0.5 * h * b, way, size, exponent, shape)
        d = _bouc_wen_slope(z + h * c, way, size, exponent, shape)
        z += h * (a + 2 * b + 2 * c + d) / 6
    return z, _bouc_wen_slope(z, way, size, exponent, shape)


@borrowing
def solve_elements(laws, step, instant):
    """(code, element) after solving for force and memory of an ElementStep with ``pressed`` as it stands.

    Elements are visited in turn, each solved by Newton's method, until no force changes by more than a tolerance or
    by more than the rounding of its elongation and rate.
    """
    force, rounding = step.force, step.rounding
    count = force.size
    for _ in range(SWEEPS):
        settled, size, where = True, 0.0, 0
        for k in range(count):
            size = max(size, abs(force[k]))
        for k in range(count):
            elongation, rate = step.pressed[0, k], step.pressed[1, k]
            for j in range(count):
                if j != k:
                    elongation += laws.response[0, k, j] * force[j]
                    rate += laws.response[1, k, j] * force[j]
            if laws.kind[k] >= ENCLOSED:
                result, rounding[k], code = _enclose(laws, k, elongation, rate, step.begin[0, k], step.memory_begin,
                                                     step.memory, force[k], instant)
            else:
                result, rounding[k], code = _solve_element(laws, k, elongation, rate, step.begin[0, k],
                                                           step.memory_begin, step.memory, force[k], instant)
            if code != SOLVED:
                return code, k
            if abs(result - force[k]) > TOLERANCE * max(size, abs(result)) + rounding[k]:
                settled, where = False, k
            force[k] = result
        if count == 1 or settled:
            return SOLVED, 0
    return UNSETTLED, where


@borrowing(inline="always")
def _solve_element(laws, k, elongation_free, rate_free, begin, memory_begin, memory, guess, instant):
    """(F, its rounding, code) of element ``k``, from elongation and rate without its own force."""
    give, mobile, force = laws.response[0, k, k], laws.response[1, k, k], guess
    if laws.kind[k] == DRY and np.isinf(laws.parameter[k, 0]):
        return _solve_rigid(laws, k, rate_free, memory_begin, memory, guess)
    carried = laws.kind[k] in (SLIDERS, BOUC_WEN, MAXWELL)      # a linear part that may nearly cancel the others
    terms = max(1.0, (laws.first[k + 1] - laws.first[k]) / 4)   # ROUNDING is that of a sum of four
    cancels = 2 * abs(laws.parameter[k, 0]) * terms if carried else 0.0
    for _ in range(ITERATIONS):
        elongation, rate = elongation_free + give * force, rate_free + mobile * force
        value, slope, drag = element_force(laws, k, elongation, rate, begin, memory_begin, memory, instant)
        rounding = ROUNDING * ((abs(slope) + cancels) * abs(elongation) + abs(drag * rate))
        against = 1.0 - slope * give - drag * mobile
        if abs(slope * give) > LARGEST_STIFFNESS or against <= 0.0:
            return 0.0, 0.0, TOO_STIFF
        change = (value - force) / against
        force += change
        if abs(change) <= LOCAL_TOLERANCE * max(abs(force), abs(value)) + rounding:
            return force, rounding, SOLVED
    return 0.0, 0.0, UNSETTLED


@borrowing
def _solve_rigid(laws, k, rate_free, memory_begin, memory, guess):
    """The same of rigid dry friction in the state that ``memory_begin`` says: at rest, or sliding whatever its rate."""
    p, start, mobile = laws.parameter[k], laws.first[k], laws.response[1, k, k]
    state, free = memory_begin[start], p[5] > 0.0 or memory_begin[start] == FREE
    memory[start] = 0.0
    if max(p[1], p[2]) == 0.0:
        return 0.0, 0.0, SOLVED
    if state == 0.0 or free:
        force = -rate_free / mobile
        if not free or -p[2] * (1.0 + p[3]) <= force <= p[1] * (1.0 + p[3]):
            return force, ROUNDING * abs(force), SOLVED
        state = np.sign(force)
    memory[start], force, size = state, guess, state * (p[1] if state > 0.0 else p[2])
    for _ in range(ITERATIONS):
        grown = p[3] * np.exp(-max(state * (rate_free + mobile * force), 0.0) / p[4])
        against = 1.0 + abs(size) / p[4] * grown * mobile
        if against <= 0.0:
            return 0.0, 0.0, TOO_STIFF
        change = (size * (1.0 + grown) - force) / against
        force += change
        if abs(change) <= LOCAL_TOLERANCE * abs(size):
            return force, 0.0, SOLVED
    return 0.0, 0.0, UNSETTLED


@borrowing
def _enclose(laws, k, elongation_free, rate_free, begin, memory_begin, memory, guess, instant):
    """(F, width of its bracket, code) of element ``k``, whose force at the end of the step resists the motion there.

    What a force leaves to be desired, law(F) - F, changes sign between any F and law(F) where the law resists; a law
    that weakens with speed may need a wider bracket. The bracket is narrowed by the method of Anderson and Bjoerck (BIT
    13 (1973) 253), by halves where that is slow.
    """
    give, mobile = laws.response[0, k, k], laws.response[1, k, k]
    low = guess
    value = element_force(laws, k, elongation_free + give * low, rate_free + mobile * low, begin, memory_begin, memory,
                          instant)[0]
    low_left = value - low
    if abs(low_left) <= LOCAL_TOLERANCE * max(abs(low), abs(value)) + SMALLEST:
        return value, abs(low_left), SOLVED
    high, wider = value, low_left
    for _ in range(ITERATIONS):
        value = element_force(laws, k, elongation_free + give * high, rate_free + mobile * high, begin, memory_begin,
                              memory, instant)[0]
        high_left = value - high
        if abs(high_left) <= LOCAL_TOLERANCE * max(abs(high), abs(value)) + SMALLEST:
            return value, abs(high_left), SOLVED
        if (high_left > 0.0) != (low_left > 0.0):
            return _narrow(laws, k, elongation_free, rate_free, begin, memory_begin, memory, instant, low, low_left,
                           high, high_left)
        low, low_left, wider = high, high_left, 2 * wider
        high += wider
    return 0.0, 0.0, UNSETTLED


@borrowing
def _narrow(laws, k, elongation_free, rate_free, begin, memory_begin, memory, instant, low, low_left, high, high_left):
    """The same from a bracket ``low`` ... ``high`` with what is left at its ends."""
    give, mobile, slow = laws.response[0, k, k], laws.response[1, k, k], False
    smallest = LOCAL_TOLERANCE * max(abs(low), abs(high)) + SMALLEST
    for _ in range(2 * ITERATIONS):
        width = abs(high - low)
        force = high - high_left * (high - low) / (high_left - low_left)
        if slow or not min(low, high) < force < max(low, high):
            force = 0.5 * (low + high)
        value = element_force(laws, k, elongation_free + give * force, rate_free + mobile * force, begin, memory_begin,
                              memory, instant)[0]
        left = value - force
        if abs(left) <= smallest or width <= smallest:
            return force, width if abs(left) > smallest else abs(left), SOLVED
        if (left > 0.0) != (high_left > 0.0):
            low, low_left = high, high_left
        else:
            shrink = 1.0 - left / high_left
            low_left *= shrink if shrink > 0.0 else 0.5
        high, high_left = force, left
        slow = abs(high - low) > 0.5 * width
    return 0.0, 0.0, UNSETTLED
