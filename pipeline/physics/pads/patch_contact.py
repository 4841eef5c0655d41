"""Contact of flexible pads with a rigid turning disc whose faces are tessellated by four sub-discs.

The disc is cut into equal sectors that are dealt to four rigidly joined sub-discs in turn, as in the
multibody model of the disc-brake paper (2021, section 2.1.5, Figure 5). Every sub-disc has slid its own
distance and therefore has its own friction. A contact patch overlaps one sector or two: its force is
shared by overlap, so that all forces stay continuous while the disc turns.

At contact i, with the rows n_i (positive opens), t_i (along sliding) and l_i (lateral) of the pad's motion:
    closure c = -(n_i q + gap_i),  N by ``closure_law``,
    slip of the disc against the pad v = (Omega r_i - t_i q', -l_i q'),
    friction on the pad F = ramp(t) N sum_d w_id(t) mu(p, |v|, s_d(t)) g(|v|) v / |v| by ``sliding_friction``.
Waves of the disc's surface add to the gap, scatter of friction around it is a factor on mu; both turn with it.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.dry_friction import (
    FACTOR,
    FIRST,
    LOAD_KEPT,
    LOAD_SHARE,
    SPEED_KEPT,
    SPEED_SHARE,
    FrictionKernel,
)
from pipeline.physics.friction.friction_table import mean_friction_at
from pipeline.physics.friction.sliding_friction import sliding_friction
from pipeline.physics.friction.state_kernels import StateKernel
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.time_stepping.contact_solver import NormalKernel, yielding_force
from pipeline.physics.time_stepping.coupled_solver import surface_shift

SUB_DISCS = 4
#: sums may be reordered to use the width of the processor; nothing else is relaxed
_FAST = {"reassoc", "contract", "nsz"}


class PatchContact(NamedTuple):
    """Contact points of pads on the sub-discs, all in SI units; c contacts, n coordinates."""

    rows: np.ndarray            # (3, c, n) rows of the motion: normal (positive opens), along sliding, lateral
    law: NormalKernel           # of contacts that yield; its gap belongs to coordinates of zero
    dry: FrictionKernel         # friction, read at the distance of the sub-discs
    radius: np.ndarray          # (c,) m, distance from the disc axis
    angle: np.ndarray           # (c,) rad, position on the disc face
    half_angle: np.ndarray      # (c,) rad, half of the angle that the patch spans
    bedding: np.ndarray         # (4,) m, distance on the friction map of each sub-disc at time 0
    bedding_speed: float        # m/s, gain of that distance with time
    disc_speed: float           # rad/s
    sectors: int                # per revolution, a multiple of 4
    ramp: float                 # s, time in which friction rises from nothing
    stick_speed: float          # m/s, slip below which friction is regularised
    waviness: np.ndarray        # (w, 6) waves of the surface, as of ``wave_table``
    scatter: np.ndarray         # (s, 4) contact, amplitude, order, phase (rad) of friction around the disc
    states: StateKernel         # what friction remembers
    wear: np.ndarray            # (c,) 1/N, depth by which a contact recedes per normal force and way
    receded: np.ndarray         # (2, c) m and m/s: what wear adds to the gap at the end of the step, and to its rate


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
def friction_share(time, ramp):
    """Part of the friction that acts ``time`` seconds after the friction-free start; smooth, from 0 to 1."""
    if time >= ramp:
        return 1.0
    return 0.5 * (1.0 - np.cos(np.pi * max(time, 0.0) / ramp))


@njit(inline="always")
def sub_disc_friction(friction, i, pressure, slip, share, distance):
    """(mu, dmu/dpressure, dmu/dslip) of patch ``i`` with ``share`` (4,) on sub-discs that have slid ``distance`` (4,).

    ``friction`` is a FrictionKernel.
    """
    contact = friction.contact
    factor, heard = contact[i, FACTOR], contact[i, SPEED_KEPT] + contact[i, SPEED_SHARE] * slip
    mu, by_pressure, by_slip = mean_friction_at(pressure, heard, distance, share, friction.pressure, friction.speed,
                                                friction.distance, friction.table, int(contact[i, FIRST]))
    return factor * mu, factor * by_pressure, factor * contact[i, SPEED_SHARE] * by_slip


@njit
def surface(contact, time):
    """(2, c): what waves and wear of the surface add to the gap of each contact, in m, and to its rate, in m/s."""
    shift = np.zeros((2, contact.law.area.size))
    if contact.waviness.shape[0] > 0:
        surface_shift(contact.waviness, (time, contact.disc_speed * time, contact.disc_speed), shift)
    for i in range(contact.receded.shape[1]):
        shift[0, i] += contact.receded[0, i]
        shift[1, i] += contact.receded[1, i]
    return shift


@njit
def scattered(contact, time):
    """(c,) factor on the friction of each contact after ``time`` s of turning."""
    factor = np.ones(contact.law.area.size)
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
    law, dry = contact.law, contact.dry
    normal, stiffness, damping = np.zeros(size), np.zeros(size), np.zeros(size)
    friction, coupling, drag = np.zeros((size, 2)), np.zeros((size, 2)), np.zeros((size, 3))
    for i in range(size):
        moved, opening, along, aside = _motion_at(rows[0, i], rows[1, i], rows[2, i], displacement, velocity)
        normal[i], stiffness[i], damping[i] = yielding_force(law, i, -(moved + law.gap[i] + shift[0, i]),
                                                             -(opening + shift[1, i]))
        if stiffness[i] == 0.0:
            continue
        share, slip_x, slip_y = dry.contact[i, LOAD_SHARE], contact.disc_speed * contact.radius[i] - along, -aside
        heard = dry.contact[i, LOAD_KEPT] + share * normal[i]
        pressure = heard / law.area[i]
        slip = np.sqrt(slip_x * slip_x + slip_y * slip_y)
        mu, by_pressure, by_slip = sub_disc_friction(dry, i, pressure, slip, shares[i], distance)
        grown = ramp * factor[i]
        force = sliding_friction(heard, pressure, slip, slip_x, slip_y, grown * mu, grown * by_pressure,
                                 grown * by_slip, contact.stick_speed)
        friction[i, 0], friction[i, 1] = force.x, force.y
        coupling[i, 0], coupling[i, 1] = share * force.x_by_normal, share * force.y_by_normal
        drag[i, 0], drag[i, 1], drag[i, 2] = force.xx, force.xy, force.yy
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
