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
    for row in range(-1, rows):
        if row + 1 < rows:
            _mix(displacement, velocity, row + 1, grid.stiffness_damping, window[(row + 1) % 3])
        if row < 0:
            continue
        low, here, high = window[(row - 1) % 3], window[row % 3], window[(row + 1) % 3]
        if 0 < row < rows - 1:
            _inner_row(low[0], here[0], high[0], low[1], here[1], high[1], displacement[0, row], displacement[1, row],
                       velocity[0, row], velocity[1, row], centre, beside, above, corner, cross, rim.inner_gain, step)
        else:
            side, across, other = (0, 1, high) if row == 0 else (1, -1, low)
            keep, gain = rim.row_keep[side], rim.row_gain[side]
            _edge_row(grid, row, across, here, other, displacement, velocity, keep, gain, step)
        for side in range(2):
            _edge_node(grid, low, here, high, row, side * (columns - 1), displacement, velocity,
                       rim.column_keep[side, :, row], rim.column_gain[side, :, row], step)


@njit(error_model="numpy", fastmath={"contract"}, inline="always")
def _mix(displacement, velocity, row, damping, mixed):
    """u + beta v of one row."""
    for axis in range(2):
        source, rate, target = displacement[axis, row], velocity[axis, row], mixed[axis]
        for i in range(source.size):
            target[i] = source[i] + damping * rate[i]


@njit(error_model="numpy", fastmath={"contract"})
def _inner_row(xl, xh, xu, yl, yh, yu, ux, uy, vx, vy, centre, beside, above, corner, cross, gain, step):
    """All nodes of a row but its ends, by the nine-point stencil; x and y of the row below, this row, the row above.

    Values below and above are added first: both components share these sums.
    """
    for i in range(1, ux.size - 1):
        sum_left, sum_here, sum_right = xl[i - 1] + xu[i - 1], xl[i] + xu[i], xl[i + 1] + xu[i + 1]
        turned = (yu[i + 1] - yl[i + 1]) - (yu[i - 1] - yl[i - 1])
        force_x = (centre * xh[i] + beside * (xh[i - 1] + xh[i + 1]) + above * sum_here
                   + corner * (sum_left + sum_right) + cross * turned)
        sum_left, sum_here, sum_right = yl[i - 1] + yu[i - 1], yl[i] + yu[i], yl[i + 1] + yu[i + 1]
        turned = (xu[i + 1] - xl[i + 1]) - (xu[i - 1] - xl[i - 1])
        force_y = (centre * yh[i] + above * (yh[i - 1] + yh[i + 1]) + beside * sum_here
                   + corner * (sum_left + sum_right) + cross * turned)
        speed_x, speed_y = vx[i] - gain * force_x, vy[i] - gain * force_y
        vx[i], vy[i] = speed_x, speed_y
        ux[i] += step * speed_x
        uy[i] += step * speed_y


@njit(error_model="numpy", fastmath={"contract"})
def _edge_row(grid, row, across, here, other, displacement, velocity, keep, gain, step):
    """All nodes but the ends of the first or last row; ``other`` is the line next to it, ``across`` rows above."""
    first, shear = grid.first_modulus, grid.shear_modulus
    stiff = first + 2.0 * shear
    k_y, m_y, d_y, t_y = _line_element(row, grid.rows, 0)
    k_o, m_o, d_o, t_o = _line_element(row, grid.rows, across)
    # inside a line K is 2, M 2/3, D 0; beside it K is -1, M 1/6, D -1/2 to the right and 1/2 to the left
    xx, xx_side, xy = 2.0 * stiff * m_y + shear * k_y / 1.5, -stiff * m_y + shear * k_y / 6.0, 0.5 * (
        shear * d_y - first * t_y)
    yy, yy_side, yx = 2.0 * shear * m_y + stiff * k_y / 1.5, -shear * m_y + stiff * k_y / 6.0, 0.5 * (
        first * d_y - shear * t_y)
    xx_o, xx_side_o, xy_o = 2.0 * stiff * m_o + shear * k_o / 1.5, -stiff * m_o + shear * k_o / 6.0, 0.5 * (
        shear * d_o - first * t_o)
    yy_o, yy_side_o, yx_o = 2.0 * shear * m_o + stiff * k_o / 1.5, -shear * m_o + stiff * k_o / 6.0, 0.5 * (
        first * d_o - shear * t_o)
    xh, yh, xo, yo = here[0], here[1], other[0], other[1]
    ux, uy, vx, vy = displacement[0, row], displacement[1, row], velocity[0, row], velocity[1, row]
    for i in range(1, ux.size - 1):
        force_x = (xx * xh[i] + xx_side * (xh[i - 1] + xh[i + 1]) + xy * (yh[i + 1] - yh[i - 1])
                   + xx_o * xo[i] + xx_side_o * (xo[i - 1] + xo[i + 1]) + xy_o * (yo[i + 1] - yo[i - 1]))
        force_y = (yy * yh[i] + yy_side * (yh[i - 1] + yh[i + 1]) + yx * (xh[i + 1] - xh[i - 1])
                   + yy_o * yo[i] + yy_side_o * (yo[i - 1] + yo[i + 1]) + yx_o * (xo[i + 1] - xo[i - 1]))
        speed_x, speed_y = keep[0, i] * vx[i] - gain[0, i] * force_x, keep[1, i] * vy[i] - gain[1, i] * force_y
        vx[i], vy[i] = speed_x, speed_y
        ux[i] += step * speed_x
        uy[i] += step * speed_y


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
def _line_element(position, count, offset):
    """Entries (i, i + offset) of K, M, D and D^T of a line of unit elements."""
    if offset != 0:
        return -1.0, 1.0 / 6.0, -0.5 * offset, 0.5 * offset
    left, right = (1.0 if position > 0 else 0.0), (1.0 if position < count - 1 else 0.0)
    return left + right, (left + right) / 3.0, 0.5 * (left - right), 0.5 * (left - right)
