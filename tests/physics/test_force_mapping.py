"""Resultant and moment are kept; mode shapes are read consistently, also while the disc turns."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.force_mapping import circle_table, gather, locate, resultant, spread, spread_rows

INNER, OUTER, TOP = 0.07, 0.15, 0.004
PLACE = np.array([
    (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
    (.5, 0, 0), (1, .5, 0), (.5, 1, 0), (0, .5, 0), (.5, 0, 1), (1, .5, 1), (.5, 1, 1), (0, .5, 1),
    (0, 0, .5), (1, 0, .5), (1, 1, .5), (0, 1, .5),
    (0, .5, .5), (1, .5, .5), (.5, 0, .5), (.5, 1, .5), (.5, .5, 0), (.5, .5, 1), (.5, .5, .5)])


def ring(kind, sectors=24, layers=3):
    """Nodes and elements of a flat ring, one element thick; nodes are not shared between elements."""
    places = PLACE[:20 if kind == "hexahedron20" else 27]
    cell = np.array([(i, j) for i in range(layers) for j in range(sectors)])
    radius = INNER + (OUTER - INNER) * (cell[:, :1] + places[:, 0]) / layers
    angle = 2 * np.pi * (cell[:, 1:] + places[:, 1]) / sectors
    height = TOP * np.broadcast_to(places[:, 2], radius.shape)
    node = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=2)
    return node.reshape(-1, 3), np.arange(radius.size).reshape(radius.shape)


def random_points(count=200):
    rng = np.random.default_rng(5)
    radius, angle = rng.uniform(INNER + 1e-3, OUTER - 1e-3, count), rng.uniform(-10, 10, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, TOP)], axis=1), rng


@pytest.mark.exact
@pytest.mark.parametrize("kind", ["hexahedron20", "hexahedron27"])
def test_resultant_and_moment_are_kept(kind):
    node, element = ring(kind)
    point, rng = random_points()
    force = rng.standard_normal((len(point), 3))
    nodal = spread(locate(node, element, kind, point), force, len(node))
    assert np.abs(nodal[node[:, 2] < TOP]).max() == 0
    for found, exact in zip(resultant(node, nodal), resultant(point, force), strict=True):
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("kind", ["hexahedron20", "hexahedron27"])
def test_quadratic_fields_are_read_to_third_order(kind):
    errors = []
    for sectors in (24, 48):
        node, element = ring(kind, sectors, layers=sectors // 8)
        point, _ = random_points()
        weights = locate(node, element, kind, point)
        field = np.sin(30 * node)
        errors.append(np.abs(gather(weights, field) - np.sin(30 * point))[:, :2].max())
        np.testing.assert_allclose(gather(weights, node), point, atol=1e-15)
    assert np.log2(errors[0] / errors[1]) > 2.7


@pytest.mark.exact
def test_work_is_the_same_at_points_and_nodes():
    node, element = ring("hexahedron20")
    point, rng = random_points()
    weights = locate(node, element, "hexahedron20", point)
    force, field = rng.standard_normal(point.shape), rng.standard_normal(node.shape)
    work = (spread(weights, force, len(node)) * field).sum()
    assert work == pytest.approx((force * gather(weights, field)).sum(), rel=1e-12)


@pytest.mark.exact
def test_circle_of_a_rigid_turn_and_a_rigid_shift():
    """Rotation about z is r along the tangent all around; a shift along x is its cosine radially."""
    node, element = ring("hexahedron20")
    turn, shift = np.cross([0, 0, 1], node), np.zeros_like(node)
    shift[:, 0] = 1
    table = [circle_table(node, element, "hexahedron20", np.stack([turn, shift]), 0.11, TOP, direction, 90)
             for direction in ((0, 1, 0), (1, 0, 0))]
    angle = 2 * np.pi * np.arange(90) / 90
    np.testing.assert_allclose(table[0][:, 0], 0.11, rtol=1e-12)
    np.testing.assert_allclose(table[0][:, 1], -np.sin(angle), atol=1e-12)
    np.testing.assert_allclose(table[1][:, 0], 0, atol=1e-12)
    np.testing.assert_allclose(table[1][:, 1], np.cos(angle), atol=1e-12)


@pytest.mark.exact
def test_turning_the_body_under_a_force():
    """A force at rest on the turned body works as the force turned back on the body at rest."""
    node, element = ring("hexahedron20")
    shape = np.random.default_rng(1).standard_normal((3, *node.shape))
    direction = np.array([0.3, -0.5, 0.8])
    table = circle_table(node, element, "hexahedron20", shape, 0.1, TOP, direction, 36)
    turned = 2 * np.pi * 5 / 36
    rotate = np.array([[np.cos(turned), -np.sin(turned), 0], [np.sin(turned), np.cos(turned), 0], [0, 0, 1]])
    point = np.array([[0.1, 0, TOP]])                       # in the laboratory, at angle 0
    weights = locate(node @ rotate.T, element, "hexahedron20", point)
    nodal = spread(weights, direction[None], len(node)) @ rotate      # back to the axes of the body
    np.testing.assert_allclose((nodal * shape).sum(axis=(1, 2)), table[-5], rtol=1e-10)


@pytest.mark.exact
def test_rows_transposed():
    """A row that reads a relative displacement pushes both sides apart with equal and opposite forces."""
    row, node, axis = np.array([0, 0, 0, 1]), np.array([0, 1, 2, 2]), np.array([2, 2, 2, 0])
    weight = np.array([1.0, -0.25, -0.75, 2.0])
    nodal = spread_rows(row, node, axis, weight, np.array([8.0, 3.0]), 3)
    np.testing.assert_array_equal(nodal, [[0, 0, 8], [0, 0, -2], [6, 0, -6]])


def test_points_beside_the_body_are_refused():
    node, element = ring("hexahedron20")
    for point, said in (([0.2, 0, TOP], "beside"), ([0.1, 0, 2 * TOP], "none")):
        with pytest.raises(ConfigError, match=said):
            locate(node, element, "hexahedron20", np.array([point]))
    with pytest.raises(ConfigError, match="one height"):
        locate(node, element, "hexahedron20", np.array([[0.1, 0, 0], [0.1, 0, TOP]]))
    with pytest.raises(ConfigError, match="tetra"):
        locate(node, element, "tetra", np.array([[0.1, 0, TOP]]))
