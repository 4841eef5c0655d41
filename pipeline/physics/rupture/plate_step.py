"""One central-difference step of a plate, compiled: force, velocity and displacement in a single pass over memory.

    v(n+1/2) = keep v(n-1/2) - gain K (u(n) + beta v(n-1/2)),   u(n+1) = u(n) + dt v(n+1/2),
gain = dt / mass inside; absorbing edges add their impedance in the middle of the step, held nodes have gain 0.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.rupture.plate_grid import edge_impedance, elastic_force, held, lumped_mass


class Rims(NamedTuple):
    """Update factors of the edge nodes, and of all others; velocity = keep * velocity + gain * force."""

    inner_gain: float           # m s/N per depth: step / mass
    row_keep: np.ndarray        # (2, 2, columns) of the bottom and the top row, along x and y
    row_gain: np.ndarray
    column_keep: np.ndarray     # (2, 2, rows) of the left and the right column
    column_gain: np.ndarray


def rims(grid, step):
    """Rims of a plate for a time step in s."""
    mass, impedance, still = lumped_mass(grid), edge_impedance(grid), held(grid)
    half = 0.5 * step * impedance / mass
    keep, gain = (1.0 - half) / (1.0 + half), step / mass / (1.0 + half)
    keep[still] = gain[still] = 0.0
    rows = (np.ascontiguousarray(a[:, [0, -1]].swapaxes(0, 1)) for a in (keep, gain))
    columns = (np.ascontiguousarray(a[:, :, [0, -1]].transpose(2, 0, 1)) for a in (keep, gain))
    return Rims(step / (grid.density * grid.spacing**2), *rows, *columns)


def plain_step(grid, rim, displacement, velocity, step):
    """The same step by numpy slices, in place: the reference of ``step_plate``."""
    force = -elastic_force(grid, displacement + grid.stiffness_damping * velocity)
    keep, gain = np.ones_like(force), np.full_like(force, rim.inner_gain)
    for side, column in enumerate((0, -1)):
        keep[:, :, column], gain[:, :, column] = rim.column_keep[side], rim.column_gain[side]
    for side, row in enumerate((0, -1)):
        keep[:, row], gain[:, row] = rim.row_keep[side], rim.row_gain[side]
    velocity *= keep
    velocity += gain * force
    displacement += step * velocity


@njit(error_model="numpy", fastmath={"contract"})
def step_plate(grid, rim, displacement, velocity, step, window):
    """Advance ``displacement`` and ``velocity`` (2, rows, columns) in place; ``window`` (3, 2, columns) is scratch."""
    rows, columns = grid.rows, grid.columns
    first, shear = grid.first_modulus, grid.shear_modulus
    stiff = first + 2.0 * shear
    centre = (stiff + shear) * 4.0 / 3.0
    beside, above = (shear - 2.0 * stiff) / 3.0, (stiff - 2.0 * shear) / 3.0
    corner, cross = -(stiff + shear) / 6.0, -(first + shear) / 4.0
    _mix(displacement, velocity, 0, grid.stiffness_damping, window[0])
    for row in range(rows):
        if row + 1 < rows:
            _mix(displacement, velocity, row + 1, grid.stiffness_damping, window[(row + 1) % 3])
        low, here, high = window[(row - 1) % 3], window[row % 3], window[(row + 1) % 3]
        if 0 < row < rows - 1:
            _inner_row(low, here, high, displacement[0, row], displacement[1, row], velocity[0, row], velocity[1, row],
                       centre, beside, above, corner, cross, rim.inner_gain, step)
            for side in range(2):
                _edge_node(grid, low, here, high, row, side * (columns - 1), displacement, velocity,
                           rim.column_keep[side, :, row], rim.column_gain[side, :, row], step)
        else:
            side = 0 if row == 0 else 1
            for column in range(columns):
                _edge_node(grid, low, here, high, row, column, displacement, velocity,
                           rim.row_keep[side, :, column], rim.row_gain[side, :, column], step)


@njit(error_model="numpy", fastmath={"contract"}, inline="always")
def _mix(displacement, velocity, row, damping, mixed):
    """u + beta v of one row."""
    for axis in range(2):
        source, rate, target = displacement[axis, row], velocity[axis, row], mixed[axis]
        for i in range(source.size):
            target[i] = source[i] + damping * rate[i]


@njit(error_model="numpy", fastmath={"contract"})
def _inner_row(low, here, high, ux, uy, vx, vy, centre, beside, above, corner, cross, gain, step):
    """All nodes of a row but its ends, by the nine-point stencil."""
    xl, xh, xu, yl, yh, yu = low[0], here[0], high[0], low[1], here[1], high[1]
    for i in range(1, ux.size - 1):
        turned_y = yu[i + 1] - yu[i - 1] - yl[i + 1] + yl[i - 1]
        turned_x = xu[i + 1] - xu[i - 1] - xl[i + 1] + xl[i - 1]
        force_x = (centre * xh[i] + beside * (xh[i - 1] + xh[i + 1]) + above * (xl[i] + xu[i])
                   + corner * (xl[i - 1] + xl[i + 1] + xu[i - 1] + xu[i + 1]) + cross * turned_y)
        force_y = (centre * yh[i] + above * (yh[i - 1] + yh[i + 1]) + beside * (yl[i] + yu[i])
                   + corner * (yl[i - 1] + yl[i + 1] + yu[i - 1] + yu[i + 1]) + cross * turned_x)
        vx[i] -= gain * force_x
        vy[i] -= gain * force_y
        ux[i] += step * vx[i]
        uy[i] += step * vy[i]


@njit(error_model="numpy")
def _edge_node(grid, low, here, high, row, column, displacement, velocity, keep, gain, step):
    """One node of the rim, by the products of one-dimensional matrices that end there."""
    force_x, force_y = 0.0, 0.0
    for across in range(-1, 2):
        if not 0 <= row + across < grid.rows:
            continue
        line = low if across < 0 else (here if across == 0 else high)
        k_y, m_y, d_y, t_y = _line_element(row, grid.rows, across)
        for along in range(-1, 2):
            i = column + along
            if not 0 <= i < grid.columns:
                continue
            k_x, m_x, d_x, t_x = _line_element(column, grid.columns, along)
            stiff = grid.first_modulus + 2.0 * grid.shear_modulus
            force_x += (stiff * k_x * m_y + grid.shear_modulus * m_x * k_y) * line[0, i]
            force_x += (grid.first_modulus * d_x * t_y + grid.shear_modulus * t_x * d_y) * line[1, i]
            force_y += (grid.shear_modulus * k_x * m_y + stiff * m_x * k_y) * line[1, i]
            force_y += (grid.first_modulus * t_x * d_y + grid.shear_modulus * d_x * t_y) * line[0, i]
    velocity[0, row, column] = keep[0] * velocity[0, row, column] - gain[0] * force_x
    velocity[1, row, column] = keep[1] * velocity[1, row, column] - gain[1] * force_y
    displacement[0, row, column] += step * velocity[0, row, column]
    displacement[1, row, column] += step * velocity[1, row, column]


@njit(error_model="numpy", inline="always")
def _line_element(place, count, offset):
    """Entries (place, place + offset) of K, M, D and D^T of a line of unit elements."""
    if offset != 0:
        return -1.0, 1.0 / 6.0, -0.5 * offset, 0.5 * offset
    left, right = (1.0 if place > 0 else 0.0), (1.0 if place < count - 1 else 0.0)
    return left + right, (left + right) / 3.0, 0.5 * (left - right), 0.5 * (left - right)
