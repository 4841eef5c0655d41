"""Quadrature on what two unlike surfaces have in common: areas, moments, partial cover, distance."""

import numpy as np
import pytest

from pipeline.physics.fem.mesh import block, boundary_faces, face_normals, revolve
from pipeline.physics.fem.overlaps import overlaps
from tests.physics.fem.mixed_meshes import cut

pytestmark = pytest.mark.exact


def pair(low, high):
    """Nodes of both, the faces of ``low`` towards +z and those of ``high`` towards -z."""
    faces = []
    for mesh, side, first in ((low, 1, 0), (high, -1, len(low.node))):
        face = boundary_faces(mesh)
        faces.append(face[face_normals(mesh.node, face)[0][:, 2] * side > 0.99] + first)
    return np.vstack((low.node, high.node)), *faces


def plate(cells, x=(0.0, 1.0), z=(0.0, 1.0), kind="hexahedron20"):
    made = block(np.linspace(*x, cells + 1), np.linspace(0, 1, cells + 2), np.array(z), kind="hexahedron27")
    return made if kind == made.kind else cut(made, kind)


@pytest.mark.parametrize("kinds", [("hexahedron20", "tetra10"), ("tetra10", "hexahedron27"), ("wedge15", "mixed")])
def test_area_and_moments_of_what_is_common(kinds):
    """The plates share 0.3 to 1 by 0 to 1: area, and both interpolate x at the same points."""
    node, first, second = pair(plate(3, kind=kinds[0]), plate(4, (0.3, 1.5), (1.0, 2.0), kinds[1]))
    area, moment = 0.0, 0.0
    for part in overlaps(node, first, second, 0.01):
        x, below = (np.einsum("pv,pv->p", shape, node[face[number, :shape.shape[1]], 0]) for shape, face, number in (
            (part.shape, first, part.first), (part.below, second, part.second)))
        assert x == pytest.approx(below, abs=1e-9)
        area, moment = area + part.area.sum(), moment + part.area @ x**2
    assert area == pytest.approx(0.7) and moment == pytest.approx((1 - 0.3**3) / 3)


def test_sectors_of_a_ring():
    """Arcs count as chords: the error falls with the square of the size of the faces."""
    errors = []
    for times in (1, 2):
        low, high = (revolve(np.linspace(0.1, 0.15, n + 1), np.linspace(-0.4, 0.4, 2 * n + 1), np.array(z))
                     for n, z in ((3 * times, (0, 0.01)), (4 * times, (0.01, 0.02))))
        area = sum(part.area.sum() for part in overlaps(*pair(low, high), 1e-4))
        errors.append(1 - area / (0.4 * (0.15**2 - 0.1**2)))
    assert 0 < errors[0] < 6e-3 and errors[0] / errors[1] == pytest.approx(4, rel=0.1)


def test_faces_apart_have_nothing_in_common():
    assert overlaps(*pair(plate(2), plate(2, z=(1.2, 2.0))), 0.01) == []
    assert overlaps(*pair(plate(2), plate(2, (1.5, 2.0), (1.0, 2.0))), 0.01) == []
