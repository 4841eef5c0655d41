"""Static state of two plates pressed together and sheared by shifting one of them, with free side edges.

The far edge of the upper plate is held, that of the lower one is shifted by u0 along x and v0 along y. The interface
sticks (matched nodes, one displacement for both plates) except where |shear| would exceed friction * pressure or the
pressure would be negative: there slip and opening are unknowns, found by the response of the tractions to unit jumps.
The plates stick from the first contact on: the shear at every node comes from the elastic solution, not from a history.
"""

from typing import NamedTuple

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.rupture.plate_grid import elastic_force, nodal_share

_ROUNDS = 60


class Preload(NamedTuple):
    """Static tractions and jumps at the interface nodes, and the shifts that make them."""

    pressure: np.ndarray        # (columns,) Pa
    shear: np.ndarray           # (columns,) Pa, friction on the upper plate along x
    slip: np.ndarray            # (columns,) m, lower minus upper along x
    gap: np.ndarray             # (columns,) m
    shift_x: float              # m, u0
    shift_y: float              # m, v0


def solve_preload(lower, upper, friction, pressure, ratio, solver, everywhere=False):
    """Preload with mean ``pressure`` (Pa) and shear = ``ratio`` * pressure, both while every node sticks.

    ``friction``: one coefficient or (columns,); ``everywhere``: the ratio is that of the two forces on the interface,
    not that of the tractions at its middle. Raises ConfigError for unlike meshes or a ratio beyond friction,
    ConvergenceError where slip and opening find no state within the rounds.
    """
    if lower.columns != upper.columns or lower.spacing != upper.spacing:
        raise ConfigError("rupture.preload", "matched interface nodes", f"{lower.columns} against {upper.columns}",
                          "give both plates one spacing, or choose the uniform preload")
    if not 0.0 <= ratio < np.max(friction):
        raise ConfigError("rupture.preload", f"shear over pressure from 0 to below friction {np.max(friction):g}",
                          f"{ratio:g}")
    system = _System(lower, upper, solver)
    unit = [system.tractions(system.shifted(*shift)) for shift in ((1.0, 0.0), (0.0, 1.0))]
    middle = slice(lower.columns // 2 - 1, lower.columns // 2 + 2)
    length = nodal_share(lower.columns) / nodal_share(lower.columns).sum()

    def targets(tractions):
        excess = tractions[0] - ratio * tractions[1]
        return [length @ tractions[1], length @ excess if everywhere else np.mean(excess[middle])]

    shifts = np.linalg.solve(np.array([targets(t) for t in unit]).T, [pressure, 0.0])
    stuck = shifts[0] * unit[0] + shifts[1] * unit[1]
    tractions, jump = _relax(system, stuck, np.broadcast_to(friction, lower.columns))
    return Preload(tractions[1], tractions[0], jump[0], -jump[1], *map(float, shifts))


def _relax(system, stuck, friction):
    """(tractions, jumps), both (2, columns), where slip and opening relieve what friction cannot carry.

    A jump is lower minus upper: negative across the interface where it opens.
    """
    columns = stuck.shape[1]
    slipping, opened = np.zeros(columns), np.zeros(columns, dtype=bool)
    tractions, jump = stuck, np.zeros_like(stuck)
    for _ in range(_ROUNDS):
        limit = friction * np.maximum(tractions[1], 0.0)
        fault = 1e-9 * np.abs(stuck[1]).max()
        closing = opened & (jump[1] > 0.0)
        opening = ~opened & (tractions[1] < -fault)
        too_much = (slipping == 0.0) & ~opened & ~opening & (np.abs(tractions[0]) > limit + fault)
        back = (slipping != 0.0) & ~opened & (jump[0] * slipping < 0.0)
        if not (closing.any() or opening.any() or too_much.any() or back.any()):
            return tractions, jump
        slipping[too_much] = np.sign(tractions[0][too_much])
        slipping[back] = 0.0
        opened = (opened | opening) & ~closing
        slipping[opened] = 0.0
        tractions, jump = _with_jumps(system, stuck, friction, slipping, opened)
    raise ConvergenceError("rupture.preload", f"slip and opening at the edges within {_ROUNDS} rounds",
                           f"{int((slipping != 0).sum())} slipping and {int(opened.sum())} open nodes",
                           "lower the shear, or choose the uniform preload")


def _with_jumps(system, stuck, friction, slipping, opened):
    """Tractions and jumps for given sets: |shear| = friction * pressure where slipping, none where open."""
    moving = [(0, i) for i in np.flatnonzero((slipping != 0.0) | opened)] + [(1, i) for i in np.flatnonzero(opened)]
    response = np.array([system.response(axis, i) for axis, i in moving])       # (k, 2, columns)
    rows, wanted = [], []
    for axis, i in moving:
        weight = friction[i] * slipping[i] if axis == 0 else 0.0
        rows.append(response[:, axis, i] - weight * response[:, 1, i])
        wanted.append(weight * stuck[1, i] - stuck[axis, i])
    size = np.linalg.solve(np.array(rows), np.array(wanted))
    jump = np.zeros_like(stuck)
    for (axis, i), value in zip(moving, size, strict=True):
        jump[axis, i] = value
    return stuck + np.einsum("k,kac->ac", size, response), jump


class _System:
    """Both plates with one displacement on the interface, factorised once."""

    def __init__(self, lower, upper, solver):
        self.lower, self.upper, self.known = lower, upper, {}
        nodes = (lower.rows + upper.rows - 1) * lower.columns
        places = np.arange(2 * nodes).reshape(2, -1, lower.columns)
        self.parts = places[:, :lower.rows], places[:, lower.rows - 1:]
        self.free = places[:, 1:-1].ravel()
        matrix = sum((_spread(_stiffness(grid), part.ravel(), 2 * nodes)
                      for grid, part in zip((lower, upper), self.parts, strict=True)),
                     scipy.sparse.csr_matrix((2 * nodes,) * 2))
        self.size, self.factor = 2 * nodes, factorise(matrix[self.free][:, self.free], solver)

    def shifted(self, along, across):
        """Displacements of both plates (2, rows, columns) with the far edge of the lower one shifted."""
        jump = np.zeros((2, self.lower.rows, self.lower.columns))
        jump[0, 0], jump[1, 0] = along, across
        return self._solved(jump)

    def response(self, axis, column):
        """(2, columns) tractions that a unit jump (lower minus upper) at one interface node makes."""
        if (axis, column) not in self.known:
            jump = np.zeros((2, self.lower.rows, self.lower.columns))
            jump[axis, -1, column] = 1.0
            self.known[axis, column] = self.tractions(self._solved(jump))
        return self.known[axis, column]

    def tractions(self, displacements):
        """(2, columns): shear and pressure in Pa, from the forces on the upper plate."""
        force = elastic_force(self.upper, displacements[1])[:, 0]
        return force / (self.upper.spacing * nodal_share(self.upper.columns))

    def _solved(self, given):
        """Displacements of lower and upper plate, with ``given`` added to those of the lower one."""
        load = np.zeros(self.size)
        np.subtract.at(load, self.parts[0].ravel(), elastic_force(self.lower, given).ravel())
        solution = np.zeros(self.size)
        solution[self.free] = self.factor.solve(load[self.free])
        return solution[self.parts[0]] + given, solution[self.parts[1]]


def _spread(matrix, places, size):
    entries = matrix.tocoo()
    return scipy.sparse.csr_matrix((entries.data, (places[entries.row], places[entries.col])), (size, size))


def _stiffness(grid):
    """Sparse stiffness of one plate from products of one-dimensional matrices."""
    (k_y, m_y, d_y), (k_x, m_x, d_x) = (_line(count) for count in (grid.rows, grid.columns))
    p, g = grid.first_modulus + 2.0 * grid.shear_modulus, grid.shear_modulus
    along = p * scipy.sparse.kron(m_y, k_x) + g * scipy.sparse.kron(k_y, m_x)
    across = g * scipy.sparse.kron(m_y, k_x) + p * scipy.sparse.kron(k_y, m_x)
    mixed = grid.first_modulus * scipy.sparse.kron(d_y.T, d_x) + g * scipy.sparse.kron(d_y, d_x.T)
    return scipy.sparse.bmat([[along, mixed], [mixed.T, across]], format="csr")


def _line(count):
    """K, M, D of a line of unit elements, (count, count) sparse."""
    ends, inner = 2.0 * nodal_share(count), np.ones(count - 1)
    stiffness = scipy.sparse.diags([-inner, ends, -inner], [-1, 0, 1])
    mass = scipy.sparse.diags([inner / 6.0, ends / 3.0, inner / 6.0], [-1, 0, 1])
    slope = scipy.sparse.diags([0.5 * inner, np.r_[-0.5, np.zeros(count - 2), 0.5], -0.5 * inner], [-1, 0, 1])
    return stiffness, mass, slope
