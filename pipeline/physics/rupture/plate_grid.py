"""A rectangular elastic plate of square bilinear elements (Q4) with lumped mass.

On a regular grid the stiffness is a sum of products of one-dimensional matrices of linear elements: with
K = int N' N', M = int N N, D = int N' N,
    f_x = ((lambda + 2 G) K_x M_y + G M_x K_y) u_x + (lambda D_x D_y^T + G D_x^T D_y) u_y,   f_y likewise,
exactly that of fully integrated Q4 elements (Zienkiewicz and Taylor, The Finite Element Method, volume 1).
Arrays over a plate are (2, rows, columns): component x, y; rows from bottom to top, columns from left to right.
Depth (thickness across the plane) is one metre: forces are N/m.
"""

from typing import NamedTuple

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.wave_speeds import checked

FREE, FIXED, ABSORBING = 0, 1, 2
EDGES = ("left", "right", "bottom", "top")
#: elements of a plate, at most: beyond, memory and time are those of no workstation
_MOST = 1e9


class Plate(NamedTuple):
    """Grid, moduli and edges of one plate, in SI units."""

    rows: int
    columns: int
    spacing: float              # m, edge of the square elements
    density: float              # kg/m^3
    first_modulus: float        # Pa, lambda of the plane problem
    shear_modulus: float        # Pa
    stiffness_damping: float    # s, beta in damping = beta * stiffness
    edges: np.ndarray           # (4, 2) FREE, FIXED or ABSORBING of each edge (left, right, bottom, top) along x, y


def plate(solid, length, height, spacing, damping_share, edges, where="rupture"):
    """Plate of ``solid``; stiffness damping = ``damping_share`` * spacing / dilatational speed.

    ``edges``: four pairs, codes along x and y. ConfigError where the sides are no whole number of elements.
    """
    checked(solid, where)
    counts = [round(side / spacing) for side in (length, height)]
    for side, count in zip((length, height), counts, strict=True):
        if count < 2 or abs(count * spacing - side) > 1e-6 * side:
            raise ConfigError(f"{where}: side of {side:g} m", f"two or more whole elements of {spacing:g} m",
                              f"{side / spacing:.6g}", "choose a spacing that divides the sides")
    if counts[0] * counts[1] > _MOST:
        raise ConfigError(f"{where}: elements of {spacing:g} m", f"at most {_MOST:.0e} of them",
                          f"{float(counts[0]) * counts[1]:.1e}", "choose a coarser spacing")
    return Plate(counts[1] + 1, counts[0] + 1, spacing, solid.density, solid.first_modulus, solid.shear_modulus,
                 damping_share * spacing / solid.dilatational_speed, np.array(edges, dtype=np.int64))


def dilatational_speed(grid):
    """cP of the plate in m/s."""
    return np.sqrt((grid.first_modulus + 2.0 * grid.shear_modulus) / grid.density)


def largest_step(grid):
    """Longest stable time step in s of central differences with damping from the last half step.

    The highest frequency is bounded by that of one free element, omega = 2.31 cP / spacing at nu = 1/4;
    dt = 2 / omega (sqrt(1 + xi^2) - xi), xi = beta omega / 2 (Belytschko, Liu and Moran, Nonlinear Finite Elements).
    """
    stiffness = element_stiffness(grid.first_modulus, grid.shear_modulus)
    omega = np.sqrt(np.linalg.eigvalsh(stiffness)[-1] * 4.0 / grid.density) / grid.spacing
    damping = 0.5 * grid.stiffness_damping * omega
    return 2.0 / omega * (np.sqrt(1.0 + damping**2) - damping)


def element_stiffness(first_modulus, shear_modulus):
    """(8, 8) stiffness in Pa (per depth) of a square Q4 element; order component x 2, row x 2, column x 2."""
    k, m, d = np.array([[1, -1], [-1, 1]]), np.array([[2, 1], [1, 2]]) / 6.0, np.array([[-1, -1], [1, 1]]) / 2.0
    p = first_modulus + 2.0 * shear_modulus
    xx, yy = (np.kron(m, k) * a + np.kron(k, m) * b for a, b in ((p, shear_modulus), (shear_modulus, p)))
    xy = first_modulus * np.kron(d.T, d) + shear_modulus * np.kron(d, d.T)
    return np.block([[xx, xy], [xy.T, yy]])


def nodal_share(count):
    """(count,) share of an element edge that belongs to each node: one half at both ends."""
    return np.r_[0.5, np.ones(count - 2), 0.5]


def lumped_mass(grid):
    """(rows, columns) nodal mass in kg/m."""
    return grid.density * grid.spacing**2 * np.outer(nodal_share(grid.rows), nodal_share(grid.columns))


def edge_impedance(grid):
    """(2, rows, columns) damping in N s/m^2 of absorbing edges: density * wave speed * length, P across, S along.

    Lysmer and Kuhlemeyer, ASCE J. Eng. Mech. 95 (1969) EM4 859.
    """
    pressure = grid.density * dilatational_speed(grid) * grid.spacing
    shear = np.sqrt(grid.density * grid.shear_modulus) * grid.spacing
    impedance = np.zeros((2, grid.rows, grid.columns))
    for edge, (nodes, count) in enumerate(_edge_nodes(grid)):
        for axis in (0, 1):
            if grid.edges[edge, axis] == ABSORBING:
                impedance[axis][nodes] += (pressure if (edge < 2) == (axis == 0) else shear) * nodal_share(count)
    return impedance


def held(grid):
    """(2, rows, columns) True where an edge holds the node."""
    mask = np.zeros((2, grid.rows, grid.columns), dtype=bool)
    for edge, (nodes, _) in enumerate(_edge_nodes(grid)):
        for axis in (0, 1):
            if grid.edges[edge, axis] == FIXED:
                mask[axis][nodes] = True
    return mask


def _edge_nodes(grid):
    every = slice(None)
    return ((every, 0), grid.rows), ((every, -1), grid.rows), ((0, every), grid.columns), ((-1, every), grid.columns)


def elastic_force(grid, displacement):
    """(2, rows, columns) K u in N/m, by array slices: the plain reference of the compiled step."""
    stiffness = element_stiffness(grid.first_modulus, grid.shear_modulus)
    corners = [(slice(r, r + grid.rows - 1), slice(c, c + grid.columns - 1)) for r in (0, 1) for c in (0, 1)]
    force = np.zeros_like(displacement)
    for i, row in enumerate(stiffness):
        target = force[i // 4][corners[i % 4]]
        for j, value in enumerate(row):
            if value != 0.0:
                target += value * displacement[j // 4][corners[j % 4]]
    return force


def strain_energy(grid, displacement):
    """Elastic energy in J/m of a displacement field."""
    return 0.5 * float(np.vdot(displacement, elastic_force(grid, displacement)))


def kinetic_energy(grid, velocity):
    """Kinetic energy in J/m of a velocity field."""
    return 0.5 * float((lumped_mass(grid) * velocity**2).sum())
