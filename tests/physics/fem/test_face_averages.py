"""Surface rows conserve force and moment; foundations and points on curved faces; points off the surface."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.face_averages import face_mean, face_points, foundation, interpolation, surface_rows
from pipeline.physics.fem.mesh import block, boundary_faces, face_normals, revolve

pytestmark = pytest.mark.exact


def ring(kind="hexahedron20"):
    return revolve(np.linspace(0.06, 0.15, 4), np.linspace(0, 2 * np.pi, 25), np.linspace(0, 0.01, 2), kind=kind)


def top(mesh):
    face = boundary_faces(mesh)
    return face[face_normals(mesh.node, face)[0][:, 2] > 0.99]


@pytest.mark.parametrize("kind", ["hexahedron", "hexahedron20", "hexahedron27"])
def test_rows_conserve_force_and_moment(kind):
    """A force through a row acts on the nodes with its resultant and with its moment about any point."""
    mesh, random = ring(kind), np.random.default_rng(3)
    radius, angle = random.uniform(0.07, 0.14, 200), random.uniform(-0.5, 0.6, 200)
    point = np.column_stack((radius * np.cos(angle), radius * np.sin(angle), np.full(200, 0.01)))
    weight, group = random.uniform(0.5, 1, 200), np.arange(200) % 4
    rows = surface_rows(mesh.node, top(mesh), point, weight, group)
    assert rows.sum(axis=1) == pytest.approx(1)
    for k in range(4):
        centre = np.average(point[group == k], axis=0, weights=weight[group == k])
        force = rows[k].toarray().T * [3.0, -1.0, 2.0]
        assert force.sum(axis=0) == pytest.approx([3, -1, 2])
        assert np.cross(mesh.node, force).sum(axis=0) == pytest.approx(np.cross(centre, [3, -1, 2]), abs=1e-9)


def test_area_of_a_ring_and_its_foundation():
    """pi (b^2 - a^2); a foundation answers a rigid lift with stiffness times area."""
    mesh = ring()
    face = top(mesh)
    area = face_points(mesh.node, face)[1].sum()
    assert area == pytest.approx(np.pi * (0.15**2 - 0.06**2), rel=1e-5)
    matrix = foundation(mesh.node, face, np.diag([1e9, 2e9, 3e9]))
    for axis in range(3):
        lift = np.tile(np.eye(3)[axis], len(mesh.node))
        assert lift @ (matrix @ lift) == pytest.approx((axis + 1) * 1e9 * area)


@pytest.mark.parametrize("kind", ["hexahedron20", "hexahedron27"])
def test_mean_over_the_area_of_faces(kind):
    """Mean of x^2 + y over the unit square: 1/3 + 1/2."""
    mesh = block(np.array([0, 0.3, 1]), np.array([0, 0.6, 1]), np.array([0, 1.0]), kind=kind)
    x, y, _ = mesh.node.T
    assert (face_mean(mesh.node, top(mesh)) @ (x**2 + y)) == pytest.approx(5 / 6)


def test_quadratic_field_is_read_exactly():
    mesh = block(np.linspace(0, 1, 3), np.linspace(0, 1, 3), np.linspace(0, 1, 2), kind="hexahedron27")
    point = np.random.default_rng(0).uniform(0, 1, (50, 3)) * (1, 1, 0) + (0, 0, 1)
    face = top(mesh)
    found, shape = interpolation(mesh.node, face, point)
    x, y, _ = mesh.node.T
    read = (shape * (x**2 - 3 * x * y + y)[face[found]]).sum(axis=1)
    assert read == pytest.approx(point[:, 0]**2 - 3 * point[:, 0] * point[:, 1] + point[:, 1])


@pytest.mark.parametrize("point", [(0.2, 0, 0.01), (0.1, 0, 0.02)])
def test_point_off_the_surface_is_refused(point):
    mesh = ring()
    with pytest.raises(ConfigError, match="sensor one.*on the surface"):
        interpolation(mesh.node, top(mesh), np.array([point]), "sensor one")


def test_a_wide_face_beside_many_narrow_ones_is_found():
    mesh = block(np.r_[np.linspace(0, 0.02, 21), 1.0], np.linspace(0, 0.1, 2), np.linspace(0, 0.01, 2))
    point = np.array([[0.021, 0.05, 0.01], [0.9, 0.05, 0.01]])
    rows = surface_rows(mesh.node, top(mesh), point, np.ones(2), np.arange(2))
    np.testing.assert_allclose(rows @ mesh.node, point, atol=1e-12)


#: a plane triangle of six nodes, and one whose long side is bent
TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0]])
BENT = TRIANGLE + np.outer(np.arange(6) == 4, [0.1, 0.1, 0.0])


@pytest.mark.exact
@pytest.mark.parametrize(("count", "points"), [(None, 6), (1, 3), (2, 3), (3, 6), (4, 12)])
def test_points_of_a_triangle_stand_for_positive_areas(count, points):
    """Contacts stand at these points, and one of negative area would pull; moments are exact to the order of a rule."""
    point, area = face_points(TRIANGLE, np.arange(6)[None], count)
    assert area.shape == (1, points) and area.min() > 0.0
    for order in range(2 * (count or 2) - 1):
        assert (area * point[..., 0]**order).sum() == pytest.approx(1 / ((order + 1) * (order + 2)))


@pytest.mark.exact
def test_three_points_of_a_triangle_carry_what_a_linear_pressure_does():
    """On a bent side too its area; on straight ones force and moment, and those of a constant one to the middles."""
    bent = face_points(BENT, np.arange(6)[None], 2)[1].sum()
    assert bent == pytest.approx(0.5 + 2 / 3 * np.sqrt(2) * np.hypot(0.1, 0.1))     # two thirds of chord times height
    point, area = (each[0] for each in face_points(TRIANGLE, np.arange(6)[None], 2))
    rows = surface_rows(TRIANGLE, np.arange(6)[None], point, np.ones(3), np.arange(3))
    np.testing.assert_allclose(rows.T @ area, [0, 0, 0, 1 / 6, 1 / 6, 1 / 6], atol=1e-14)
    force = area * (2.0 + 3.0 * point[:, 0] - point[:, 1])
    assert force.sum() == pytest.approx(2 / 2 + 3 / 6 - 1 / 6)
    np.testing.assert_allclose((rows.T @ force) @ TRIANGLE[:, :2], [2 / 6 + 3 / 12 - 1 / 24, 2 / 6 + 3 / 24 - 1 / 12])
