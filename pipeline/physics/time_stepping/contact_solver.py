"""Forces of several sliding contacts over one time step, compiled: normal laws with friction, solved together.

Every contact has four observables, (displacement, velocity) along its normal row n and along its tangent row t. At the
end of the step they are y = free + R x, linear in the contact forces x = (N, T) of the step. ``hard`` contacts and
rigid sticking are set on velocities, their forces constant over the step (Moreau-Jean; Jean, CMAME 177 (1999) 235):

    0 <= N  _|_  n q'(end) + e n q'(begin) >= 0        where the motion without force would close the gap,
    T such that the slip ends at 0, while |T| <= mu N;

``penalty`` and ``table``, the laws of ``closure_law``, hold at the end of the step, as do the elastic and the evolution
description of friction; ``lagrange`` asks n q(end) + gap >= 0. The contacts are visited in turn (Gauss-Seidel), the two
forces of one contact solved together, until no force changes. A friction joint has a normal force of its own that never
changes.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.contact.closure_law import penalty_law, table_law
from pipeline.physics.friction.dry_friction import (
    DELAYED,
    EVOLUTION,
    EXPONENT,
    LOAD_KEPT,
    LOAD_SHARE,
    RIGID,
    SLIDING_SLOPE,
    STATIC,
    STIFFNESS,
    coefficient,
    evolution_rule,
)
from pipeline.physics.numerics.compiled import borrowing

HARD, PENALTY, TABLE, LAGRANGE = 0, 1, 2, 3
OPEN, STICK, SLIP = 0, 1, 2
SOLVED, UNCONVERGED, JAMMED, TOO_LONG = 0, 1, 2, 3
SWEEPS, ITERATIONS, TOLERANCE, LOCAL_TOLERANCE = 2000, 100, 1e-9, 1e-13
#: share of the change of a reading, back and forth, above which a coefficient that rises over speed is bracketed
STEEP = 0.75
#: coefficient at the speed to which it turns a slip round, over that at rest, above which it cannot have done so
RISES = 1.1
#: largest product of a contact stiffness and its flexibility over one step: 8 steps in a period of the contact
LARGEST_STIFFNESS = 0.1


class NormalKernel(NamedTuple):
    """Normal law of c contacts: kind, gap at zero displacement (m), and what the kind needs."""

    kind: int
    gap: np.ndarray             # (c,) m
    fixed: np.ndarray           # (c,) N, normal force of a friction joint, below 0 for all other contacts
    area: np.ndarray            # (c,) m^2
    stiffness: np.ndarray       # (c,) N/m, penalty
    damping: np.ndarray         # (c,) N s/m, penalty
    closure: np.ndarray         # (k,) m, table
    pressure: np.ndarray        # (g k,) Pa, tables of g groups on the same closures, stacked
    first: np.ndarray           # (c,) where the table of a contact begins; below 0 for penalty among tables
    damping_speed: np.ndarray   # (c,) m/s, table
    restitution: float          # hard
    newmark: bool               # the linear part is stepped by Newmark's rule, contact and friction forces with it


class ContactStep(NamedTuple):
    """c contacts over one time step: what is given, and the forces and states that are solved for.

    Observables are displacement and velocity along n, then along t.
    """

    free: np.ndarray        # (4, c) observables at the end, without the contact forces of this step
    begin: np.ndarray       # (4, c) observables at the begin
    held: np.ndarray        # (2, c) N, forces N, T at the begin
    drive: np.ndarray       # (2, c) m/s, sliding velocity at begin and end
    way: np.ndarray         # (c,) m, its integral
    force: np.ndarray       # (2, c) N, forces N, T of the step; a guess, then the solution
    status: np.ndarray      # (c,) OPEN, STICK or SLIP; that of the last step, then of this one
    before: np.ndarray      # (c,) work: status at the begin, SLIP once a contact has broken loose


@borrowing(inline="always")
def yielding_force(law, i, closure, rate):
    """(N, dN/dclosure, dN/drate) of contact i of a NormalKernel, penalty or table."""
    if law.kind == PENALTY or law.first[i] < 0:
        return penalty_law(closure, rate, law.stiffness[i], law.damping[i])
    return table_law(closure, rate, law.area[i], law.closure, law.pressure, law.first[i], law.damping_speed[i])


@borrowing
def solve_contacts(law, friction, response, step):
    """(code, contact) after solving for force and status of a ContactStep.

    ``response`` (4, 2, c, c) of the observables to the forces. Nothing is accepted that has not converged: the code
    says what failed, in which contact.
    """
    free, begin, held, drive, force, status, before = (step.free, step.begin, step.held, step.drive, step.force,
                                                       step.status, step.before)
    count = free.shape[1]
    for i in range(count):
        before[i] = status[i]
    for _ in range(SWEEPS):
        change, size, where = 0.0, 0.0, 0
        for i in range(count):
            y0, y1, y2, y3 = free[0, i], free[1, i], free[2, i], free[3, i]
            for j in range(count):
                if j != i:
                    for f in range(2):
                        x = force[f, j]
                        if x != 0.0:
                            y0 += response[0, f, i, j] * x
                            y1 += response[1, f, i, j] * x
                            y2 += response[2, f, i, j] * x
                            y3 += response[3, f, i, j] * x
            active = before[i] != OPEN or law.gap[i] + free[0, i] <= 0.0
            normal, tangent, status[i], code = _solve_contact(
                law, friction, i, (y0, y1, y2, y3), _own_response(response, i),
                (begin[0, i], begin[1, i], begin[2, i], begin[3, i]), (held[0, i], held[1, i]),
                (drive[0, i], drive[1, i]), step.way[i], (force[0, i], force[1, i]), before[i], active)
            if code != SOLVED:
                return code, i
            moved = abs(normal - force[0, i]) + abs(tangent - force[1, i])
            if moved > change:
                change, where = moved, i
            size = max(size, abs(normal) + abs(tangent))
            force[0, i], force[1, i] = normal, tangent
            if status[i] == SLIP:
                before[i] = SLIP        # what has broken loose is no longer held by static friction in this step
        if count == 1 or change <= TOLERANCE * size:
            return SOLVED, 0
    return UNCONVERGED, where


@borrowing(inline="always")
def _own_response(response, i):
    """Pairs (to N, to T) of the four observables of contact i: tuples, which cost nothing to pass."""
    return ((response[0, 0, i, i], response[0, 1, i, i]), (response[1, 0, i, i], response[1, 1, i, i]),
            (response[2, 0, i, i], response[2, 1, i, i]), (response[3, 0, i, i], response[3, 1, i, i]))


@borrowing(inline="always")
def _solve_contact(law, friction, i, y, r, past, held, drive, way, guess, before, active):
    """(N, T, status, code) of contact i, its observables without its own forces being ``y``."""
    if law.kind == HARD and not active:
        return 0.0, 0.0, OPEN, SOLVED
    if friction.description == RIGID:
        return _rigid(law, friction, i, y, r, past, held, drive, way, guess, before)
    return _yielding(law, friction, i, y, r, past, held, drive, way, guess, before)


@borrowing
def _rigid(law, friction, i, y, r, past, held, drive, way, guess, before):
    """Sticks if the force that ends the slip (forward increments: allows none) stays below the limit, else slides."""
    share, kept = _mean_load(law, friction, i, held)
    missing, per_force = drive[1] - y[3], r[3]
    if law.kind == LAGRANGE and not law.newmark:
        missing, per_force = way + past[2] - y[2], r[2]
    sign = np.sign(missing)
    if per_force[1] > 0.0:
        fixed, slope = missing / per_force[1], -per_force[0] / per_force[1]
        normal, code = _normal(law, i, y, r, past, fixed, slope, guess[0])
        if code == SOLVED:
            tangent = fixed + slope * normal
            load = kept + share * normal
            limit = coefficient(friction, i, load / law.area[i], 0.0, tangent) * load
            if before == STICK:
                limit *= friction.contact[i, STATIC]
            if abs(tangent) <= limit:
                return normal, tangent, STICK if normal > 0.0 else OPEN, SOLVED
            sign = np.sign(tangent)
        elif code != JAMMED:
            return 0.0, 0.0, OPEN, code
    return _sliding(law, friction, i, y, r, past, drive, (share, kept), sign, guess[0])


@borrowing
def _sliding(law, friction, i, y, r, past, drive, loads, sign, normal):
    """(N, T, status, code) of a contact that slides against the ``sign`` of its friction.

    The coefficient is read at the mean speed of the step, which depends on it. Where it rises so steeply that this runs
    away, as a logarithm does near rest, it is that at the end of the step (implicit Euler: the mean would let the slip
    ring about zero), and bracketed: at 0 the slip is largest, and what is read above it; what turns the slip round is
    more than enough.
    """
    share, kept = loads
    pressure = (kept + share * normal) / law.area[i]
    mu = coefficient(friction, i, pressure, abs(drive[0] - past[3]), sign)
    highest, change = mu, 0.0
    for _ in range(ITERATIONS):
        normal, read, slip, code = _read(law, friction, i, y, r, past, drive, loads, sign, (mu, normal), 0.5)
        if code != SOLVED:
            return 0.0, 0.0, OPEN, code
        turned = slip * sign < 0.0 and read > RISES * coefficient(friction, i, pressure, 0.0, sign)
        if abs(read - mu) <= LOCAL_TOLERANCE and not turned:
            return normal, sign * mu * (kept + share * normal), SLIP if normal > 0.0 else OPEN, SOLVED
        steep = (read - mu) * change < 0.0 and abs(read - mu) > max(STEEP * abs(change), TOLERANCE)
        change, mu, highest = read - mu, read, max(highest, read)
        if steep or (turned and abs(change) <= LOCAL_TOLERANCE):
            break
    low, high = 0.0, 2.0 * highest
    for _ in range(ITERATIONS):
        mu = 0.5 * (low + high)
        normal, read, slip, code = _read(law, friction, i, y, r, past, drive, loads, sign, (mu, normal), 1.0)
        if code != SOLVED:
            return 0.0, 0.0, OPEN, code
        if (abs(read - mu) <= LOCAL_TOLERANCE and slip * sign >= 0.0) or high - low <= LOCAL_TOLERANCE * high:
            return normal, sign * mu * (kept + share * normal), SLIP if normal > 0.0 else OPEN, SOLVED
        if read > mu and slip * sign >= 0.0:
            low = mu
        else:
            high = mu
    return 0.0, 0.0, OPEN, UNCONVERGED


@borrowing(inline="always")
def _read(law, friction, i, y, r, past, drive, loads, sign, tried, end):
    """(N, coefficient at the slip to which the ``end`` of the step counts so much, that slip, code) of a step under the
    coefficient and about the N ``tried``."""
    share, kept = loads
    fixed, slope = sign * tried[0] * kept, sign * tried[0] * share
    normal, code = _normal(law, i, y, r, past, fixed, slope, tried[1])
    slip_end = drive[1] - (y[3] + (r[3][0] + r[3][1] * slope) * normal + r[3][1] * fixed)
    slip = (1.0 - end) * (drive[0] - past[3]) + end * slip_end
    return normal, coefficient(friction, i, (kept + share * normal) / law.area[i], abs(slip), sign), slip, code


@borrowing(inline="always")
def _mean_load(law, friction, i, held):
    """(share, kept): the normal force that carries rigid friction over the step is kept + share N."""
    if friction.contact[i, DELAYED] > 0.0:
        return friction.contact[i, LOAD_SHARE], friction.contact[i, LOAD_KEPT]
    if law.kind == HARD or law.kind == LAGRANGE or law.newmark:
        return 1.0, 0.0
    return 0.5, 0.5 * held[0]


@borrowing
def _yielding(law, friction, i, y, r, past, held, drive, way, guess, before):
    """Friction that is a function of the slip of the step, by Newton's method on T, N following T."""
    stiffness, tangent = friction.contact[i, STIFFNESS], guess[1]
    if not law.newmark and stiffness * r[2][1] > LARGEST_STIFFNESS:
        return 0.0, 0.0, OPEN, TOO_LONG
    normal, speed = guess[0], abs(drive[1] - past[3])
    for _ in range(ITERATIONS):
        normal, code = _normal(law, i, y, r, past, tangent, 0.0, normal)
        if code != SOLVED:
            return 0.0, 0.0, OPEN, code
        if normal == 0.0:
            tangent_new, slope, sliding = 0.0, 0.0, False
        else:
            slip = way + past[2] - (y[2] + r[2][0] * normal + r[2][1] * tangent)
            speed = abs(drive[1] - (y[3] + r[3][0] * normal + r[3][1] * tangent))
            load = friction.contact[i, LOAD_KEPT] + friction.contact[i, LOAD_SHARE] * normal
            tangent_new, slope, sliding = _drawn(friction, i, held[1], slip, load, load / law.area[i], speed, before)
            if sliding:
                before = SLIP       # once loose in this step, no longer held by static friction
        change = (tangent_new - tangent) / (1.0 + slope * r[2][1])
        tangent += change
        if abs(change) <= LOCAL_TOLERANCE * (abs(tangent) + normal):
            if normal == 0.0:
                return 0.0, 0.0, OPEN, SOLVED
            return normal, tangent, SLIP if sliding else STICK, SOLVED
    return 0.0, 0.0, OPEN, UNCONVERGED


@borrowing
def _drawn(friction, i, begin, slip, load, pressure, speed, before):
    """(T, dT/dslip, slides) of the elastic or the evolution description."""
    stiffness = friction.contact[i, STIFFNESS]
    if friction.description == EVOLUTION:
        limit = coefficient(friction, i, pressure, speed, slip) * load
        tangent, slope = evolution_rule(begin, slip, limit, stiffness, friction.contact[i, EXPONENT])
        return tangent, slope, slope < SLIDING_SLOPE * stiffness
    trial = begin + stiffness * slip
    hold = coefficient(friction, i, pressure, 0.0, trial) * load
    if before == STICK:
        hold *= friction.contact[i, STATIC]
    if abs(trial) <= hold:
        return trial, stiffness, False
    return np.sign(trial) * coefficient(friction, i, pressure, speed, trial) * load, 0.0, True


@borrowing
def _normal(law, i, y, r, past, fixed, slope, guess):
    """(N, code) of the normal law where the friction force is fixed + slope N."""
    if law.fixed[i] >= 0.0:
        return law.fixed[i], SOLVED
    gap, rate = law.gap[i] + y[0] + r[0][1] * fixed, y[1] + r[1][1] * fixed
    flexible, mobile = r[0][0] + r[0][1] * slope, r[1][0] + r[1][1] * slope
    if law.kind == HARD:
        missing = rate + law.restitution * past[1]
        if missing >= 0.0:
            return 0.0, SOLVED
        return (-missing / mobile, SOLVED) if mobile > 0.0 else (0.0, JAMMED)
    if gap >= 0.0:
        return 0.0, SOLVED
    if law.kind == LAGRANGE:
        return (-gap / flexible, SOLVED) if flexible > 0.0 else (0.0, JAMMED)
    if law.kind == PENALTY or law.first[i] < 0:
        k, d = law.stiffness[i], law.damping[i]
        if not law.newmark and k * r[0][0] > LARGEST_STIFFNESS:
            return 0.0, TOO_LONG
        against = 1.0 + k * flexible + d * mobile
        return (max(-(k * gap + d * rate) / against, 0.0), SOLVED) if against > 0.0 else (0.0, JAMMED)
    normal = guess
    for _ in range(ITERATIONS):
        force, k, d = table_law(-gap - flexible * normal, -rate - mobile * normal, law.area[i], law.closure,
                                law.pressure, law.first[i], law.damping_speed[i])
        against = 1.0 + k * flexible + d * mobile
        if k * r[0][0] > LARGEST_STIFFNESS:
            return 0.0, TOO_LONG
        if against <= 0.0:
            return 0.0, JAMMED
        change = (force - normal) / against
        normal = max(normal + change, 0.0)
        if abs(change) <= LOCAL_TOLERANCE * max(normal, abs(force)):
            return normal, SOLVED
    return 0.0, UNCONVERGED
