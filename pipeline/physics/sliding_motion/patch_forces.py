"""Contact forces of patches in a given motion, compiled: normal law and friction.

Patch i moves by u along its normal (positive opens), at the velocities (u', v, w) along its normal, tangent and lateral
rows. Its contacts j carry

    N = (1 - u' / vd) sum_j A_j p_j(c_j - u),      F = N mu(p, |s|) g(|s|) s / |s|,      s = (v0 - v, -w),

w counting only where friction turns, p being the mean pressure of its closed contacts and g = 1 except for sticking,
which is creep slower than ``stick_speed``. The sum is a table over u, finer than the law grows by more than a few per
mille in a row. Friction that remembers hears of N and s what its states leave of them (``friction.state_kernels``).
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.contact.closure_law import damped
from pipeline.physics.friction.dry_friction import (
    FACTOR,
    LOAD_KEPT,
    LOAD_SHARE,
    READ_AT,
    FrictionKernel,
    characteristic,
)
from pipeline.physics.friction.sliding_friction import sliding_friction
from pipeline.physics.friction.state_kernels import MEMORY, StateKernel, advanced, expect, factor, settle
from pipeline.physics.numerics.compiled import njit


class PatchKernel(NamedTuple):
    """p patches, SI units."""

    lowest: float           # m, displacement at which the tables of the normal force begin
    interval: float         # m, between their rows
    normal: np.ndarray      # (p, k) N, normal force without damping
    closed: np.ndarray      # (p, k) contacts that are closed
    contacts: int           # of all patches
    damping_speed: np.ndarray   # (p,) m/s, vd
    load: np.ndarray        # (p,) N, N in steady sliding
    drawn: np.ndarray       # (p,) N, friction along the tangent rows in steady sliding
    speed: np.ndarray       # (p,) m/s, v0, signed
    pressure_per_load: np.ndarray   # (p,) 1/m^2
    friction: FrictionKernel    # of the patches
    states: StateKernel     # what their friction remembers
    linear: np.ndarray      # (6, p) slopes: see ``linear_forces``
    stick_speed: float      # m/s
    turns: float            # 1 where friction turns with the slip, 0 where it stays along the tangents
    scale: float            # m, closure in which the law grows by e


@njit(inline="always")
def normal_at(k, i, moved, rate):
    """(N, dN/dmoved, dN/drate) of patch i displaced by ``moved``, opening at ``rate``."""
    position = (moved - k.lowest) / k.interval
    low = min(max(int(position), 0), k.normal.shape[1] - 2)
    rise = k.normal[i, low + 1] - k.normal[i, low]
    normal = k.normal[i, low] + rise * (position - low)
    if normal <= 0.0:
        return 0.0, 0.0, 0.0
    force, stiffness, damping = damped(normal, -rise / k.interval, -rate, k.damping_speed[i])
    return force, -stiffness, -damping


@njit(inline="always")
def patch_friction(friction, i, normal, pressure_per_load, along, aside, stick_speed):
    """SlidingForce of patch i under ``normal`` N at slip velocities ``along`` and ``aside`` of the drive, m/s."""
    share, slip = friction.contact[i, LOAD_SHARE], np.sqrt(along * along + aside * aside)
    heard = friction.contact[i, LOAD_KEPT] + share * normal
    pressure = heard * pressure_per_load
    mu, by_pressure, by_speed, _ = characteristic(friction, i, pressure, slip, friction.contact[i, READ_AT], along)
    return sliding_friction(heard, pressure, slip, along, aside, mu, by_pressure, by_speed, stick_speed, share)


@njit
def foresee(k, value, seen, step):
    """Let friction hear what its states ``value`` (s, 2) will leave at the end of a ``step`` s.

    ``seen`` (2, 3, p): N, slip m/s and friction N at its begin, and one step before, from which those of its middle
    follow along a line: factors would be late by half a step otherwise.
    """
    states, contact = k.states, k.friction.contact
    expect(states, value, k.friction, seen[0, 0], seen[0, 1], seen[0, 2], 0.0, 0.0, step, False)
    contact[:, FACTOR] = 1.0
    for s in range(states.kind.size):
        kind, i, p = states.kind[s], states.contact[s], states.parameter[s]
        if kind != MEMORY:
            middle = 1.5 * seen[0, :, i] - 0.5 * seen[1, :, i]
            after = advanced(kind, p, value[s, 0], middle[0], states.area[i], abs(middle[1]), middle[2], step)
            contact[i, FACTOR] *= factor(kind, p, after, 0.0)


@njit
def remember(k, value, seen, y, step):
    """Bring states ``value`` (s, 2) to the end of a ``step`` s with the motion ``y`` (4, p), and what was ``seen``."""
    seen[1] = seen[0]
    for i in range(k.load.size):
        load = normal_at(k, i, y[0, i], y[1, i])[0]
        along, aside = k.speed[i] - y[2, i], -k.turns * y[3, i]
        force = patch_friction(k.friction, i, load, k.pressure_per_load[i], along, aside, k.stick_speed)
        seen[0, :, i] = load, np.sqrt(along * along + aside * aside), np.sqrt(force.x**2 + force.y**2)
    settle(k.states, value, seen[1, 0], seen[0, 0], seen[1, 1], seen[0, 1], 0.5 * (seen[0, 2] + seen[1, 2]), step)


@njit(inline="always")
def linear_forces(k, i, y):
    """Deviations (N, T, L) of the forces of patch i in the linearised system; ``y`` (4, p): u, u', v, w."""
    a = k.linear
    return (-a[0, i] * y[0, i] - a[1, i] * y[1, i],
            -a[2, i] * y[0, i] - a[3, i] * y[1, i] - a[4, i] * y[2, i], -a[5, i] * y[3, i])


@njit
def beyond_linear(k, y, rest, slope):
    """Fill ``rest`` (3, p) with what the forces at ``y`` (4, p) hold beyond steady and linear ones, and ``slope``
    (3, 4, p) with its derivatives."""
    a, friction, speed, per_load, turns = k.linear, k.friction, k.speed, k.pressure_per_load, k.turns   # once each
    for i in range(k.load.size):
        normal, rise, drag = normal_at(k, i, y[0, i], y[1, i])
        force = patch_friction(friction, i, normal, per_load[i], speed[i] - y[2, i], -turns * y[3, i], k.stick_speed)
        linear = linear_forces(k, i, y)
        rest[0, i] = normal - k.load[i] - linear[0]
        rest[1, i] = force.x - k.drawn[i] - linear[1]
        rest[2, i] = force.y - linear[2]
        slope[0, 0, i], slope[0, 1, i] = rise + a[0, i], drag + a[1, i]
        slope[1, 0, i], slope[1, 1, i] = force.x_by_normal * rise + a[2, i], force.x_by_normal * drag + a[3, i]
        slope[1, 2, i], slope[1, 3, i] = a[4, i] - force.xx, -turns * force.xy
        slope[2, 0, i], slope[2, 1, i] = force.y_by_normal * rise, force.y_by_normal * drag
        slope[2, 2, i], slope[2, 3, i] = -force.xy, a[5, i] - turns * force.yy
