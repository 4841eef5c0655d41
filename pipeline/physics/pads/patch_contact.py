"""Contact of flexible pads with a rigid turning disc whose faces are tessellated by four sub-discs.

The disc is cut into equal sectors that are dealt to four rigidly joined sub-discs in turn, as in the
multibody model of the disc-brake paper (2021, section 2.1.5, Figure 5). Every sub-disc has slid its own
distance and therefore has its own friction. A contact patch overlaps one sector or two: its force is
shared by overlap, so that all forces stay continuous while the disc turns.

At contact i, with the rows n_i (positive opens), t_i (along sliding) and l_i (lateral) of the pad's motion:
    closure c = -(n_i q + opening),  N = A p(c) (1 + c' / damping_speed), never negative,
    slip of the disc against the pad v = (Omega r_i - t_i q', -l_i q'),
    friction on the pad F = ramp(t) N sum_d w_id(t) mu(p, |v|, s_d(t)) g(|v|) v / |v|.
Waves of the disc's surface add to the opening, scatter of friction around it is a factor on mu; both turn with it.
g = 1 except for |v| < stick_speed, where it is the cubic x (3 - x^2) / 2 of x = |v| / stick_speed: sticking is replaced
by creep slower than that. The damping of the normal law follows Hunt & Crossley (J. Appl. Mech. 42 (1975) 440): it
vanishes with the pressure, so that no force jumps where contact opens.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.friction_table import friction_at
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.time_stepping.coupled_solver import surface_shift

SUB_DISCS = 4
#: sums may be reordered to use the width of the processor; nothing else is relaxed
_FAST = {"reassoc", "contract", "nsz"}


class PatchContact(NamedTuple):
    """Contact points of pads on the sub-discs, all in SI units; c contacts, n coordinates."""

    rows: np.ndarray            # (3, c, n) rows of the motion: normal (positive opens), along sliding, lateral
    opening: np.ndarray         # (c,) m, normal displacement where all coordinates are zero
    area: np.ndarray            # (c,) m^2
    radius: np.ndarray          # (c,) m, distance from the disc axis
    angle: np.ndarray           # (c,) rad, position on the disc face
    half_angle: np.ndarray      # (c,) rad, half of the angle that the patch spans
    closure: np.ndarray         # (k,) m, from 0: axis of the normal laws
    pressure: np.ndarray        # (g k,) Pa, each law from 0, rising
    law_first: np.ndarray       # (c,) where the law of each contact begins
    friction_pressure: np.ndarray   # (P,) Pa, axes of the friction table
    friction_speed: np.ndarray      # (V,) m/s
    friction_distance: np.ndarray   # (S,) m
    friction: np.ndarray        # (g P, V, S) coefficient of friction
    friction_first: np.ndarray  # (c,) row where the table of each contact begins
    bedding: np.ndarray         # (4,) m, distance on the friction map of each sub-disc at time 0
    bedding_speed: float        # m/s, gain of that distance with time
    disc_speed: float           # rad/s
    sectors: int                # per revolution, a multiple of 4
    ramp: float                 # s, time in which friction rises from nothing
    stick_speed: float          # m/s, slip below which friction is regularised
    damping_speed: np.ndarray   # (c,) m/s, closing speed that doubles the contact pressure
    waviness: np.ndarray        # (w, 6) waves of the surface, as of ``wave_table``
    scatter: np.ndarray         # (s, 4) contact, amplitude, order, phase (rad) of friction around the disc


class ContactState(NamedTuple):
    """Forces of all contacts on the pads and their slopes at one instant."""

    normal: np.ndarray          # (c,) N
    friction: np.ndarray        # (c, 2) N, along sliding and laterally
    stiffness: np.ndarray       # (c,) N/m, dN/dclosure
    damping: np.ndarray         # (c,) N s/m, dN/d(closing speed)
    coupling: np.ndarray        # (c, 2) d friction / dN = (mu + p dmu/dp) v / |v|
    drag: np.ndarray            # (c, 3) N s/m, d friction / dv: along-along, along-lateral, lateral-lateral
    share: np.ndarray           # (c, 4) part of the patch on each sub-disc


@njit
def normal_law(closure, closures, pressures):
    """(pressure in Pa, slope in Pa/m) of a piecewise linear law: zero in separation, last slope beyond the table."""
    if closure <= 0.0:
        return 0.0, 0.0
    low = min(np.searchsorted(closures, closure, side="right"), closures.size - 1) - 1
    slope = (pressures[low + 1] - pressures[low]) / (closures[low + 1] - closures[low])
    return pressures[low] + slope * (closure - closures[low]), slope


@njit
def patch_shares(angle, half_angle, turned, sectors):
    """(c, 4) share of each patch on each sub-disc after the disc has turned by ``turned`` rad; rows sum to one."""
    shares = np.empty((angle.size, SUB_DISCS))
    per_angle = sectors / (2.0 * np.pi)
    for i in range(angle.size):
        begin = (angle[i] - half_angle[i] - turned) * per_angle
        end = (angle[i] + half_angle[i] - turned) * per_angle
        for d in range(SUB_DISCS):
            shares[i, d] = (_length_on(d, end) - _length_on(d, begin)) / (end - begin)
    return shares


@njit
def _length_on(sub_disc, position):
    """Sectors of one sub-disc between 0 and ``position`` sectors."""
    cycles = np.floor(position / SUB_DISCS)
    return cycles + min(max(position - SUB_DISCS * cycles - sub_disc, 0.0), 1.0)


@njit
def sliding_part(slip, stick_speed):
    """(g, dg/dslip in s/m): 1 from the stick speed on, a cubic without kinks below it; slip >= 0."""
    x = slip / stick_speed
    if x >= 1.0:
        return 1.0, 0.0
    return x * (3.0 - x * x) / 2.0, 1.5 * (1.0 - x * x) / stick_speed


@njit
def friction_share(time, ramp):
    """Part of the friction that acts ``time`` seconds after the friction-free start; smooth, from 0 to 1."""
    if time >= ramp:
        return 1.0
    return 0.5 * (1.0 - np.cos(np.pi * max(time, 0.0) / ramp))


@njit
def sub_disc_friction(pressure, slip, share, distance, pressures, speeds, distances, table, first):
    """(mu, dmu/dpressure, dmu/dslip) of a patch with ``share`` (4,) on sub-discs that have slid ``distance`` (4,).

    ``first`` is the row where its table begins.
    """
    if distance[0] == distance[1] == distance[2] == distance[3]:
        mu, over_pressure, over_slip, _ = friction_at(pressure, slip, distance[0], pressures, speeds, distances, table,
                                                      first)
        return mu, over_pressure, over_slip
    mu, over_pressure, over_slip = 0.0, 0.0, 0.0
    for d in range(SUB_DISCS):
        if share[d] > 0.0:
            value, pressure_slope, slip_slope, _ = friction_at(
                pressure, slip, distance[d], pressures, speeds, distances, table, first)
            mu += share[d] * value
            over_pressure += share[d] * pressure_slope
            over_slip += share[d] * slip_slope
    return mu, over_pressure, over_slip


@njit
def surface(contact, time):
    """(2, c): what waves of the surface add to the opening of each contact, in m, and to its rate, in m/s."""
    shift = np.zeros((2, contact.area.size))
    if contact.waviness.shape[0] > 0:
        surface_shift(contact.waviness, (time, contact.disc_speed * time, contact.disc_speed), shift)
    return shift


@njit
def scattered(contact, time):
    """(c,) factor on the friction of each contact after ``time`` s of turning."""
    factor = np.ones(contact.area.size)
    for k in range(contact.scatter.shape[0]):
        i, amplitude, order, phase = contact.scatter[k]
        factor[int(i)] *= 1.0 + amplitude * np.cos(order * contact.disc_speed * time - phase)
    return factor


@njit(fastmath=_FAST)
def _motion_at(normal, tangent, lateral, displacement, velocity):
    """(displacement along the normal row, speeds along the normal, tangent and lateral row), (n,) each, in one pass."""
    moved, opening, along, aside = 0.0, 0.0, 0.0, 0.0
    for k in range(displacement.size):
        moved += normal[k] * displacement[k]
        opening += normal[k] * velocity[k]
        along += tangent[k] * velocity[k]
        aside += lateral[k] * velocity[k]
    return moved, opening, along, aside


@njit
def contact_state(contact, time, displacement, velocity):
    """ContactState at generalised ``displacement`` (n,) and ``velocity`` (n,)."""
    size = contact.rows.shape[1]
    shift, factor = surface(contact, time), scattered(contact, time)
    rows = contact.rows
    shares = patch_shares(contact.angle, contact.half_angle, contact.disc_speed * time, contact.sectors)
    ramp, distance = friction_share(time, contact.ramp), np.empty(SUB_DISCS)
    for d in range(SUB_DISCS):
        distance[d] = contact.bedding[d] + contact.bedding_speed * time
    pressures, speeds = contact.friction_pressure, contact.friction_speed
    distances, table = contact.friction_distance, contact.friction
    normal, stiffness, damping = np.zeros(size), np.zeros(size), np.zeros(size)
    friction, coupling, drag = np.zeros((size, 2)), np.zeros((size, 2)), np.zeros((size, 3))
    for i in range(size):
        first = contact.law_first[i]
        moved, opening, along, aside = _motion_at(rows[0, i], rows[1, i], rows[2, i], displacement, velocity)
        elastic, slope = normal_law(-(moved + contact.opening[i] + shift[0, i]), contact.closure,
                                    contact.pressure[first:first + contact.closure.size])
        growth = 1.0 - (opening + shift[1, i]) / contact.damping_speed[i]
        if slope == 0.0 or growth <= 0.0:
            continue
        pressure, damping[i] = elastic * growth, contact.area[i] * elastic / contact.damping_speed[i]
        normal[i], stiffness[i] = contact.area[i] * pressure, contact.area[i] * slope * growth
        slip_x, slip_y = contact.disc_speed * contact.radius[i] - along, -aside
        slip = np.hypot(slip_x, slip_y)
        mu, over_pressure, over_slip = sub_disc_friction(
            pressure, slip, shares[i], distance, pressures, speeds, distances, table, contact.friction_first[i])
        mu, over_pressure, over_slip = factor[i] * mu, factor[i] * over_pressure, factor[i] * over_slip
        part, part_slope = sliding_part(slip, contact.stick_speed)
        x, y = (slip_x / slip, slip_y / slip) if slip > 0.0 else (1.0, 0.0)
        force, slide = ramp * normal[i] * mu * part, ramp * part * (mu + pressure * over_pressure)
        radial = ramp * normal[i] * (mu * part_slope + over_slip * part)
        turning = force / slip if slip > 0.0 else radial
        friction[i, 0], friction[i, 1], coupling[i, 0], coupling[i, 1] = force * x, force * y, slide * x, slide * y
        drag[i, 0], drag[i, 2] = radial * x * x + turning * y * y, radial * y * y + turning * x * x
        drag[i, 1] = (radial - turning) * x * y
    return ContactState(normal, friction, stiffness, damping, coupling, drag, shares)


@njit(inline="always")
def contact_force(contact, time, displacement, velocity):
    """Generalised force (n,) of all contacts on the pads."""
    state, rows = contact_state(contact, time, displacement, velocity), contact.rows
    result = np.zeros(displacement.size)
    for i in range(rows.shape[1]):
        if state.normal[i] != 0.0:
            normal, along, aside = state.normal[i], state.friction[i, 0], state.friction[i, 1]
            for k in range(result.size):
                result[k] += normal * rows[0, i, k] + along * rows[1, i, k] + aside * rows[2, i, k]
    return result


@njit(inline="always")
def contact_tangent(contact, time, displacement, velocity):
    """(stiffness, damping), both (n, n): minus the derivatives of ``contact_force``; exact, unsymmetric."""
    state = contact_state(contact, time, displacement, velocity)
    size, n = contact.rows.shape[1:]
    pressed, damped = np.empty((size, n)), np.empty((size, n))
    slid_x, slid_y = np.empty((size, n)), np.empty((size, n))
    for i in range(size):
        for k in range(n):
            along, aside = contact.rows[1, i, k], contact.rows[2, i, k]
            row = contact.rows[0, i, k] + state.coupling[i, 0] * along + state.coupling[i, 1] * aside
            pressed[i, k], damped[i, k] = state.stiffness[i] * row, state.damping[i] * row
            slid_x[i, k] = state.drag[i, 0] * along + state.drag[i, 1] * aside
            slid_y[i, k] = state.drag[i, 1] * along + state.drag[i, 2] * aside
    damping = damped.T @ contact.rows[0]
    add(damping, slid_x.T @ contact.rows[1])
    add(damping, slid_y.T @ contact.rows[2])
    return pressed.T @ contact.rows[0], damping


@njit
def add(target, matrix):
    """Add ``matrix`` (n, m) to ``target`` (n, m). Loops: numba compiles them in a tenth of the time of ``+=``."""
    for i in range(target.shape[0]):
        for k in range(target.shape[1]):
            target[i, k] += matrix[i, k]
