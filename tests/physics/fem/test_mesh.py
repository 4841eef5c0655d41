"""Lattices: counts, outward faces, masks, of all kinds of cells; clear errors."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.face_averages import face_points
from pipeline.physics.fem.mesh import block, boundary_faces, corners, divided, face_normals, graded, revolve
from tests.physics.fem.mixed_meshes import cut

pytestmark = pytest.mark.exact
LINES = np.linspace(0.1, 0.2, 3), np.linspace(0, 2 * np.pi, 13), np.linspace(-0.01, 0.01, 3)


@pytest.mark.parametrize("kind, nodes", [("hexahedron", 3 * 12 * 3), ("hexahedron27", 5 * 24 * 5)])
def test_closed_ring_has_no_seam(kind, nodes):
    mesh = revolve(*LINES, kind=kind)
    assert len(mesh.node) == nodes and len(mesh.element) == 2 * 12 * 2
    assert len(boundary_faces(mesh)) == 2 * 12 * (2 + 2)


@pytest.mark.parametrize("kind", ["hexahedron", "hexahedron20", "hexahedron27"])
def test_faces_look_outwards(kind):
    """By the divergence theorem, the flux of the position through the surface is three volumes."""
    mask = np.ones((2, 12, 2), bool)
    mask[1, 3:5] = False
    mesh = revolve(*LINES, mask, kind)
    face = boundary_faces(mesh)
    point, area = face_points(mesh.node, face)
    normal, middle = face_normals(mesh.node, face)
    flux = (normal * middle).sum(axis=1) @ area.sum(axis=1)
    whole = np.pi * (0.2**2 - 0.1**2) * 0.02
    cut = np.pi * (0.2**2 - 0.15**2) * 0.02 * 2 / 12
    assert flux / 3 == pytest.approx(whole - cut, rel=0.06 if kind == "hexahedron" else 0.03)


def test_middle_nodes_lie_on_the_circle():
    mesh = revolve(*LINES)
    radius = np.hypot(*mesh.node[:, :2].T)
    assert np.unique(radius.round(9)) == pytest.approx([0.1, 0.125, 0.15, 0.175, 0.2])


@pytest.mark.parametrize("kind", ["tetra10", "wedge15", "mixed"])
def test_tetrahedra_wedges_and_both_have_the_surface_of_the_hexahedra(kind):
    whole = revolve(*LINES, kind="hexahedron27")
    mesh = cut(whole, kind)
    face = boundary_faces(mesh)
    normal, middle = face_normals(mesh.node, face)
    corner = mesh.node[corners(face)]
    area = np.linalg.norm(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]), axis=1) / 2
    square = whole.node[corners(boundary_faces(whole))]
    flat = np.cross(square[:, 2] - square[:, 0], square[:, 3] - square[:, 1])
    assert area.sum() == pytest.approx(np.linalg.norm(flat, axis=1).sum() / 2, rel=1e-9)
    assert (area @ (normal * middle).sum(axis=1)) / 3 == pytest.approx(3 * (0.2**2 - 0.1**2) * 0.02, rel=1e-9)
    assert set(np.unique(np.isin(np.arange(len(mesh.node)), face))) == {False, True}


def test_negative_thickness_and_missing_bore_are_refused():
    with pytest.raises(ConfigError, match="third lattice direction"):
        revolve(LINES[0], LINES[1], np.array([0.01, -0.01]))
    with pytest.raises(ConfigError, match="bore"):
        revolve(np.array([0.0, 0.1]), LINES[1], LINES[2])
    with pytest.raises(ConfigError, match="at least one cell"):
        block(*LINES, mask=np.zeros((2, 12, 2), bool))


def test_divided_lines_keep_their_edges_and_are_no_wider_than_asked():
    line = divided((0.0, 1.0, 1.2, 4.0), 0.5)
    assert {0.0, 1.0, 1.2, 4.0} <= set(line) and np.diff(line).max() <= 0.5 + 1e-12
    assert line == pytest.approx([0, 0.5, 1, 1.2, *np.linspace(1.2, 4, 7)[1:]])
    assert list(divided((-1.0, 1.0), 5.0)) == [-1.0, 1.0]


def test_graded_lines_shrink_as_squares_towards_inner_edges_alone():
    line = graded((0.0, 1.0, 1.2, 4.0), 0.5, 2)
    assert line == pytest.approx([0, 0.75, 1, 1.025, 1.1, 1.175, 1.2, *(1.2 + 2.8 * (np.arange(1, 7) / 6) ** 2)])
    assert list(graded((-1.0, 1.0), 5.0, 3)) == [-1.0, 1.0]
