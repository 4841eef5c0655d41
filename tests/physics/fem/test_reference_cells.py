"""Shape functions, quadrature and faces of the reference cells; rows of several kinds."""

from itertools import product
from math import factorial

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.reference_cells import (
    MIXED,
    by_kind,
    cell_faces,
    padded,
    quadrature,
    reference_vertices,
    shape_functions,
)

pytestmark = pytest.mark.exact
SOLID = ("hexahedron", "hexahedron20", "hexahedron27", "tetra10", "wedge15")
KINDS = (*SOLID, "quad", "quad8", "quad9", "triangle6")


@pytest.mark.parametrize("kind", KINDS)
def test_each_shape_function_is_one_at_its_vertex_alone_and_they_reproduce_what_is_linear(kind):
    vertices = reference_vertices(kind)
    assert np.allclose(shape_functions(kind, vertices)[0], np.eye(len(vertices)))
    point = np.random.default_rng(0).random((7, vertices.shape[1])) / 3
    shape, gradient = shape_functions(kind, point)
    assert np.allclose(shape.sum(axis=1), 1) and np.allclose(shape @ vertices, point)
    assert np.allclose(np.einsum("pvd,vx->pdx", gradient, vertices), np.eye(vertices.shape[1]))


@pytest.mark.parametrize("kind", ["tetra10", "wedge15", "triangle6"])
def test_gradients_are_those_of_the_shape_functions(kind):
    point, step = np.full((1, reference_vertices(kind).shape[1]), 0.2), 1e-6
    gradient = shape_functions(kind, point)[1]
    for axis, unit in enumerate(np.eye(point.shape[1])):
        sides = [shape_functions(kind, point + side * step * unit)[0] for side in (-1, 1)]
        assert np.allclose(gradient[..., axis], (sides[1] - sides[0]) / (2 * step), atol=1e-8)


@pytest.mark.parametrize("kind, most", [("tetra10", 4), ("wedge15", 4), ("triangle6", 4)])
def test_quadrature_is_exact_for_the_mass_of_straight_cells(kind, most):
    """Of x^a y^b z^c over a simplex: a! b! c! / (a + b + c + d)!; over a wedge a triangle's times 1 / (c + 1)."""
    point, weight = quadrature(kind)
    assert (weight > 0).all()
    for power in product(range(most + 1), repeat=point.shape[1]):
        flat = power[:2] if kind == "wedge15" else power
        if sum(flat) > most:
            continue
        exact = np.prod([factorial(k) for k in flat]) / factorial(sum(flat) + len(flat))
        exact = exact / (power[2] + 1) if kind == "wedge15" else exact
        assert weight @ (point ** np.array(power)).prod(axis=1) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("kind", SOLID)
def test_faces_look_outwards_and_hold_their_edge_middles(kind):
    vertices = reference_vertices(kind)
    for face in cell_faces(kind):
        corner = vertices[face[:{6: 3}.get(len(face), 4)]]
        normal = np.cross(corner[1] - corner[0], corner[2] - corner[0])
        assert normal @ (corner.mean(axis=0) - vertices.mean(axis=0)) > 0
        if len(face) > 4:
            middle = (corner + np.roll(corner, -1, axis=0)) / 2
            assert np.array_equal(vertices[face[len(corner):2 * len(corner)]], middle)


def test_rows_of_several_kinds_are_told_apart():
    tetra, wedge, cube = np.arange(10)[None], np.arange(30).reshape(2, 15), np.arange(20)[None]
    cells = np.concatenate([padded(wedge, 20), cube, padded(tetra, 20)])
    blocks = {kind: (rows, each) for kind, rows, each in by_kind(MIXED, cells)}
    assert [blocks[kind][0].tolist() for kind in ("tetra10", "wedge15", "hexahedron20")] == [[3], [0, 1], [2]]
    assert np.array_equal(blocks["wedge15"][1], wedge) and np.array_equal(blocks["tetra10"][1], tetra)


def test_cells_not_served_are_refused():
    with pytest.raises(ConfigError, match="hexahedron20.*pyramid13.*second order"):
        reference_vertices("pyramid13")
