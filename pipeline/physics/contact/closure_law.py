"""Normal force of a contact that yields, over its closure and closing speed, compiled: one law for every solver.

    table      N = A p(c) (1 + c' / v0)         p piecewise linear over the closure c, from 0
    penalty    N = k c + d c'

0 where the contact is open, c <= 0, and never negative: contacts do not pull. The damping of the table follows Hunt &
Crossley (J. Appl. Mech. 42 (1975) 440): it vanishes with the pressure, so that no force jumps where contact opens.
Beyond the last row of the table its last slope continues.
"""

import numpy as np

from pipeline.physics.numerics.compiled import borrowing, njit


@borrowing(inline="always")
def pressure_at(closure, closures, pressures, first=0):
    """(p in Pa, dp/dc in Pa/m) of a table ``closures`` (k,) m, from 0, and ``pressures[first:first + k]`` Pa."""
    if closure <= 0.0:
        return 0.0, 0.0
    low, high = 0, closures.size - 1
    while high - low > 1:       # in a fraction of the time of np.searchsorted
        middle = (low + high) // 2
        if closures[middle] <= closure:
            low = middle
        else:
            high = middle
    row = first + low
    slope = (pressures[row + 1] - pressures[row]) / (closures[low + 1] - closures[low])
    return pressures[row] + slope * (closure - closures[low]), slope


@borrowing(inline="always")
def table_law(closure, rate, area, closures, pressures, first, damping_speed):
    """(N, dN/dc in N/m, dN/dc' in N s/m) of a contact of ``area`` m^2 at ``closure`` m and closing ``rate`` m/s.

    The table is that of ``pressure_at``; ``damping_speed`` v0 in m/s, infinite for no damping.
    """
    pressure, slope = pressure_at(closure, closures, pressures, first)
    if slope == 0.0:
        return 0.0, 0.0, 0.0
    return damped(area * pressure, area * slope, rate, damping_speed)


@borrowing(inline="always")
def damped(force, stiffness, rate, damping_speed):
    """(N, dN/dc, dN/dc') of a contact that carries ``force`` N, rising by ``stiffness`` N/m, where it is not moving."""
    factor = 1.0 + rate / damping_speed
    if factor <= 0.0:
        return 0.0, 0.0, 0.0
    return force * factor, stiffness * factor, force / damping_speed


@borrowing(inline="always")
def penalty_law(closure, rate, stiffness, damping):
    """(N, dN/dc, dN/dc') of a spring and damper, ``stiffness`` N/m and ``damping`` N s/m."""
    force = stiffness * closure + damping * rate
    if closure <= 0.0 or force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, stiffness, damping


def force_at_rest(closure, area, closures, pressures):
    """(N (c,), dN/dc (c,) N/m) of contacts of ``area`` (c,) m^2 that share a table, at ``closure`` (c,) m."""
    closure, area, closures, pressures = (np.array(a, float) for a in (closure, area, closures, pressures))
    return table_forces(closure, np.zeros_like(closure), area, closures, pressures, np.inf)[:2]


def damping_at_rest(force, damping_speed):
    """dN/dc' (c,) N s/m of contacts with a table that carry a ``force`` (c,) N at rest."""
    return force / damping_speed


@njit
def table_forces(closure, rate, area, closures, pressures, damping_speed):
    """(3, n): ``table_law`` at closures, rates and areas (n,) of contacts that share one table."""
    result = np.empty((3, closure.size))
    for i in range(closure.size):
        result[0, i], result[1, i], result[2, i] = table_law(closure[i], rate[i], area[i], closures, pressures, 0,
                                                             damping_speed)
    return result


@njit
def penalty_forces(closure, rate, stiffness, damping):
    """(3, n): ``penalty_law`` at closures and rates (n,)."""
    result = np.empty((3, closure.size))
    for i in range(closure.size):
        result[0, i], result[1, i], result[2, i] = penalty_law(closure[i], rate[i], stiffness, damping)
    return result
