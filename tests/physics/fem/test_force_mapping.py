"""Resultant and moment are kept; mode shapes are read consistently, also while the disc turns."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.force_mapping import circle_table, gather, locate, resultant, spread, spread_rows
from pipeline.physics.fem.mesh import boundary_faces, revolve

INNER, OUTER, TOP = 0.07, 0.15, 0.004


def ring(kind="hexahedron20", sectors=24):
    """Nodes and outer faces of a flat ring, one element thick."""
    mesh = revolve(np.linspace(INNER, OUTER, sectors // 8 + 1), np.linspace(0, 2 * np.pi, sectors + 1),
                   np.array([0, TOP]), kind=kind)
    return mesh.node, boundary_faces(mesh)


def random_points(count=200):
    """Points on the upper face."""
    rng = np.random.default_rng(5)
    radius, angle = rng.uniform(INNER + 1e-3, OUTER - 1e-3, count), rng.uniform(-10, 10, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, TOP)], axis=1), rng


@pytest.mark.exact
@pytest.mark.parametrize("kind", ["hexahedron20", "hexahedron27"])
def test_resultant_and_moment_are_kept(kind):
    node, face = ring(kind)
    point, rng = random_points()
    force = rng.standard_normal((len(point), 3))
    nodal = spread(locate(node, face, point), force, len(node))
    assert np.abs(nodal[node[:, 2] < TOP]).max() == 0
    for found, exact in zip(resultant(node, nodal), resultant(point, force), strict=True):
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("kind", ["hexahedron20", "hexahedron27"])
def test_fields_are_read_to_third_order(kind):
    errors = []
    for sectors in (24, 48):
        node, face = ring(kind, sectors)
        point, _ = random_points()
        weights = locate(node, face, point)
        errors.append(np.abs(gather(weights, np.sin(30 * node)) - np.sin(30 * point))[:, :2].max())
        np.testing.assert_allclose(gather(weights, node), point, atol=1e-12)
    assert np.log2(errors[0] / errors[1]) > 2.7


@pytest.mark.exact
def test_work_is_the_same_at_points_and_nodes():
    node, face = ring()
    point, rng = random_points()
    weights = locate(node, face, point)
    force, field = rng.standard_normal(point.shape), rng.standard_normal(node.shape)
    work = (spread(weights, force, len(node)) * field).sum()
    assert work == pytest.approx((force * gather(weights, field)).sum(), rel=1e-12)


@pytest.mark.exact
def test_circle_of_a_rigid_turn_and_a_rigid_shift():
    """Rotation about z is r along the tangent all around; a shift along x is its cosine radially."""
    node, face = ring()
    turn, shift = np.cross([0, 0, 1], node), np.zeros_like(node)
    shift[:, 0] = 1
    tangential, radial = (circle_table(node, face, np.stack([turn, shift]), 0.11, TOP, direction, 90)
                          for direction in ((0, 1, 0), (1, 0, 0)))
    angle = 2 * np.pi * np.arange(90) / 90
    np.testing.assert_allclose(tangential[:, 0], 0.11, rtol=1e-9)
    np.testing.assert_allclose(tangential[:, 1], -np.sin(angle), atol=1e-12)
    np.testing.assert_allclose(radial[:, 0], 0, atol=1e-9)
    np.testing.assert_allclose(radial[:, 1], np.cos(angle), atol=1e-12)


@pytest.mark.exact
def test_turning_the_body_under_a_force():
    """A force at rest on the turned body works as the force turned back on the body at rest."""
    node, face = ring()
    shape = np.random.default_rng(1).standard_normal((3, *node.shape))
    direction = np.array([0.3, -0.5, 0.8])
    table = circle_table(node, face, shape, 0.1, TOP, direction, 36)
    turned = 2 * np.pi * 5 / 36
    rotate = np.array([[np.cos(turned), -np.sin(turned), 0], [np.sin(turned), np.cos(turned), 0], [0, 0, 1]])
    point = np.array([[0.1, 0, TOP]])                       # in the laboratory, at angle 0
    weights = locate(node @ rotate.T, face, point)
    nodal = spread(weights, direction[None], len(node)) @ rotate      # back to the axes of the body
    np.testing.assert_allclose((nodal * shape).sum(axis=(1, 2)), table[-5], rtol=1e-8)


@pytest.mark.exact
def test_rows_transposed():
    """A row that reads a relative displacement pushes both sides apart with equal and opposite forces."""
    row, node, axis = np.array([0, 0, 0, 1]), np.array([0, 1, 2, 2]), np.array([2, 2, 2, 0])
    weight = np.array([1.0, -0.25, -0.75, 2.0])
    nodal = spread_rows(row, node, axis, weight, np.array([8.0, 3.0]), 3)
    np.testing.assert_array_equal(nodal, [[0, 0, 8], [0, 0, -2], [6, 0, -6]])


@pytest.mark.parametrize("radius", [INNER, OUTER])
def test_rims_are_circles_beside_the_parabolas_of_the_mesh(radius):
    node, face = ring()
    angle = np.linspace(0, 7, 100)
    point = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(100, TOP)], axis=1)
    np.testing.assert_allclose(gather(locate(node, face, point), node), point, atol=2e-6)


def test_points_beside_the_body_are_refused():
    node, face = ring()
    for point in ([0.2, 0, TOP], [0.1, 0, 2 * TOP]):
        with pytest.raises(ConfigError, match="force mapping"):
            locate(node, face, np.array([point]))
