"""Compiled sums of elastic elements beside B^T C B point by point; symmetry, bits, elements turned inside out."""

import numpy as np
import pytest

from pipeline.physics.fem.elastic_sums import elastic_sums
from pipeline.physics.fem.elasticity import isotropic, orthotropic
from pipeline.physics.fem.mesh import revolve
from pipeline.physics.fem.reference_cells import quadrature, shape_functions

pytestmark = pytest.mark.exact
DENSITY = np.array([7000.0, 2500.0])
ELASTICITY = np.array([isotropic(1e11, 0.3), orthotropic((1e10, 2e10, 3e9), (0.2, 0.1, 0.25), (2e9, 1e9, 3e9))])


def ring(kind="hexahedron20"):
    mesh = revolve(np.array([0.1, 0.12, 0.15]), np.linspace(0, 2 * np.pi, 6), np.array([0, 0.02]), kind=kind)
    return mesh, np.arange(len(mesh.element)) % 2


def cell(kind, share=1.0):
    """Points of a rule, the first for the mass as well; with ``share`` < 1 a second rule of order 3 has the rest."""
    (point, weight), (fewer, reduced) = quadrature(kind), quadrature(kind, 3)
    shape, gradient = shape_functions(kind, point)
    every = np.concatenate((gradient, shape_functions(kind, fewer)[1]))
    return every, np.concatenate((share * weight, (1 - share) * reduced)), shape, weight


def by_points(mesh, material, points):
    """(stiffness, mass) dense, from the strains of every point of every element."""
    gradient, weight, shape, carried = points
    stiffness, mass = np.zeros((2, 3 * len(mesh.node), 3 * len(mesh.node)))
    for vertex, m in zip(mesh.element, material, strict=True):
        dof = (3 * vertex[:, None] + np.arange(3)).ravel()
        for q, (slope, w) in enumerate(zip(gradient, weight, strict=True)):
            jacobian = mesh.node[vertex].T @ slope
            x, y, z = (slope @ np.linalg.inv(jacobian)).T
            strain = np.zeros((6, len(vertex), 3))
            strain[0, :, 0], strain[1, :, 1], strain[2, :, 2] = x, y, z
            strain[3, :, 1], strain[3, :, 2], strain[4, :, 0], strain[4, :, 2] = z, y, z, x
            strain[5, :, 0], strain[5, :, 1] = y, x
            strain, volume = strain.reshape(6, -1), np.linalg.det(jacobian)
            stiffness[np.ix_(dof, dof)] += w * volume * strain.T @ ELASTICITY[m] @ strain
            if q < len(carried):
                matrix = np.kron(np.outer(shape[q], shape[q]), np.eye(3))
                mass[np.ix_(dof, dof)] += carried[q] * volume * DENSITY[m] * matrix
    return stiffness, mass


@pytest.mark.parametrize(("kind", "share"), [("hexahedron20", 0.4), ("hexahedron", 1.0)])
def test_sums_are_those_of_the_strains_at_every_point(kind, share):
    mesh, material = ring(kind)
    points = cell(kind, share)
    found = elastic_sums(mesh.node, mesh.element, material, points, ELASTICITY, DENSITY)
    for matrix, expected in zip(found, by_points(mesh, material, points), strict=True):
        np.testing.assert_allclose(matrix.toarray(), expected, atol=1e-12 * abs(expected).max())
        assert (matrix != matrix.T).nnz == 0 and matrix.has_sorted_indices


def test_the_same_mesh_gives_the_same_bits():
    mesh, material = ring()
    first, second = (elastic_sums(mesh.node, mesh.element, material, cell(mesh.kind), ELASTICITY, DENSITY)
                     for _ in range(2))
    assert all(np.array_equal(a.data, b.data) for a, b in zip(first, second, strict=True))


def test_an_element_turned_inside_out_is_told():
    mesh, material = ring()
    element = mesh.element.copy()
    element[3] = element[3][[4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19]]
    assert elastic_sums(mesh.node, element, material, cell(mesh.kind), ELASTICITY, DENSITY)[0] is None
    worst, volume = elastic_sums(mesh.node, element, material, cell(mesh.kind), ELASTICITY, DENSITY)[1]
    assert worst == 3 and volume < 0
