"""Tied unlike meshes: uniform stress passes, a bar of two meshes stretches and vibrates as one, surfaces that miss."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import Mesh, block, boundary_faces, face_normals
from pipeline.physics.fem.supports import free_modes
from pipeline.physics.fem.ties import refuse_loose, tie, tie_stiffness
from tests.physics.fem.mixed_meshes import cut

pytestmark = pytest.mark.exact
YOUNG, POISSON, DENSITY = 100e9, 0.3, 7000.0
LINES = {4: np.array([0, 0.4, 0.7, 1.0]), 5: np.linspace(0, 1, 6), 6: np.array([0, 0.25, 0.5, 0.75, 1.0])}


def faces(mesh, axis, side, first=0):
    face = boundary_faces(mesh)
    return face[face_normals(mesh.node, face)[0][:, axis] * side > 0.99] + first


def halves(below=("hexahedron20", 4), above=("tetra10", 5)):
    """Two cubes of 10 mm on each other, of their kinds and lattice lines: nodes, [(kind, elements)], their tie."""
    meshes = []
    for (kind, lines), z in ((below, 0.0), (above, 1.0)):
        line = LINES[lines]
        plain = block(0.01 * line, 0.01 * line, 0.01 * (z + np.linspace(0, 1, 3)), kind="hexahedron27")
        meshes.append(plain if kind == plain.kind else cut(plain, kind))
    low, high = meshes
    node = np.vstack((low.node, high.node))
    blocks = [(low.kind, low.element), (high.kind, high.element + len(low.node))]
    held = tie(node, faces(high, 2, -1, len(low.node)), faces(low, 2, 1), YOUNG, "tie")
    return node, blocks, held


def matrices(node, blocks, held):
    total = [0, 0]
    for kind, element in blocks:
        parts = assemble(node, element, kind, np.zeros(len(element), int), [DENSITY], [isotropic(YOUNG, POISSON)])
        total = [a + b for a, b in zip(total, parts, strict=True)]
    return total[0] + tie_stiffness([held], len(node)), total[1]


KINDS = [(("hexahedron20", 4), ("hexahedron20", 5)), (("hexahedron20", 5), ("tetra10", 4)),
         (("tetra10", 5), ("hexahedron20", 4)), (("hexahedron27", 4), ("wedge15", 6))]


@pytest.mark.parametrize("below, above", KINDS)
def test_patch(below, above):
    """A column under tension: stress sigma in all of it, sigma / k of jump, to rounding."""
    node, blocks, held = halves(below, above)
    assert held.share == pytest.approx(1) and held.area.sum() == pytest.approx(1e-4)
    matrix, _ = matrices(node, blocks, held)
    stress, (x, y, z) = 1e6, node.T
    jump = stress / held.stiffness * (np.arange(len(node)) >= blocks[1][1].min())
    exact = np.column_stack((-POISSON * x, -POISSON * y, z)) * stress / YOUNG + jump[:, None] * (0, 0, 1)
    outer = np.flatnonzero((z < 1e-9) | (z > 0.02 - 1e-9))
    fixed = (3 * outer[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(3 * len(node)), fixed)
    solved = exact.ravel().copy()
    solved[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), -matrix[free][:, fixed] @ solved[fixed])
    error = np.abs(solved - exact.ravel()).max() / np.abs(exact).max()
    assert error < 1e-9


def test_rigid_motions_cost_nothing_and_opening_does():
    node, blocks, held = halves()
    matrix = tie_stiffness([held], len(node))
    x, y, z = node.T
    for motion in (0 * node + (1.0, 2.0, 3.0), np.column_stack((-y, x, 0 * z)), np.column_stack((z, 0 * y, -x))):
        moved = np.ravel(motion)
        assert abs(moved @ (matrix @ moved)) < 1e-12 * matrix.diagonal().max() * (moved @ moved)
    moved = np.outer(np.arange(len(node)) >= blocks[1][1].min(), (0, 0, 1.0)).ravel()
    assert moved @ (matrix @ moved) == pytest.approx(held.stiffness * 1e-4, rel=1e-9)
    assert tie_stiffness((), 4).nnz == 0


def test_modes_are_those_of_the_whole_bar():
    """Free modes of a bar of 10 x 10 x 20 mm, halves of unlike meshes, against one mesh."""
    node, blocks, held = halves(("hexahedron20", 5), ("hexahedron20", 6))
    frequency, _ = free_modes(*matrices(node, blocks, held), "superlu", 130e3, "bar")
    whole = block(*[0.01 * np.linspace(0, 1, 5)] * 2, 0.01 * np.linspace(0, 2, 5))
    plain = assemble(whole.node, whole.element, whole.kind, np.zeros(len(whole.element), int), [DENSITY],
                     [isotropic(YOUNG, POISSON)])
    expected, _ = free_modes(*plain, "superlu", 130e3, "bar")
    assert len(expected) == len(frequency) > 8 and frequency == pytest.approx(expected, rel=2e-3)


def test_parts_that_a_tie_does_not_reach():
    """Of two cubes beside each other, only one lies below the tied surface of a third one."""
    line = 0.01 * np.linspace(0, 1, 3)
    low, beside = block(line, line, line), block(line + 0.015, line + 0.015, line - 0.01)
    high = block(*[0.01 * np.linspace(0, 1, 4)] * 2, np.array([0.01, 0.02]))
    node = np.vstack([each.node for each in (low, beside, high)])
    first = np.cumsum([0, len(low.node), len(beside.node)])
    mesh = Mesh(node, np.vstack([each.element + f for each, f in zip((low, beside, high), first, strict=True)]),
                low.kind, np.zeros((0, 3)))
    under = np.vstack((faces(low, 2, 1), faces(beside, 2, 1, first[1])))
    held = tie(node, faces(high, 2, -1, first[2]), under, YOUNG, "tie")
    with pytest.raises(ConfigError, match="a pad: expected ties that hold all parts .* found 81 nodes about"):
        refuse_loose(mesh, [held], "a pad")
    joined = Mesh(node, mesh.element[[k for k in range(len(mesh.element)) if not 8 <= k < 16]], low.kind, mesh.cell)
    used, compact = np.unique(joined.element, return_inverse=True)
    kept = replace(held, rows=held.rows[:, used])
    refuse_loose(Mesh(node[used], compact.reshape(joined.element.shape), low.kind, mesh.cell), [kept], "a pad")


def test_surfaces_that_do_not_meet():
    mesh = block(*[np.linspace(0, 0.01, 3)] * 3)
    with pytest.raises(ConfigError, match="tie GLUE: expected two surfaces that lie on each other, found ones that meet"
                                          " over 0.0%"):
        tie(mesh.node, faces(mesh, 2, 1), faces(mesh, 2, -1), YOUNG, "tie GLUE")
