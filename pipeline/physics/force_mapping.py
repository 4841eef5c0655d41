"""Point forces to finite-element nodes, keeping their resultant and moment; also on a turning disc.

A force at a point of an element face is shared among the nodes of the face by the shape functions
of that face. These sum to one and reproduce the position of the point, so that resultant and
moment are kept exactly. The same weights read a mode shape at the point, which makes modal forces
and sensors consistent.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from pipeline.contract.errors import ConfigError

#: corners, then edge middles of each face of a second-order hexahedron, then its middle; order of meshio
_FACES = np.array([[0, 1, 2, 3, 8, 9, 10, 11, 24], [4, 5, 6, 7, 12, 13, 14, 15, 25], [0, 1, 5, 4, 8, 17, 12, 16, 22],
                   [3, 2, 6, 7, 10, 18, 14, 19, 23], [0, 3, 7, 4, 11, 19, 15, 16, 20], [1, 2, 6, 5, 9, 18, 13, 17, 21]])
#: nodes of a face
_FACE_NODES = {"hexahedron20": 8, "hexahedron27": 9}
#: the same nine places on the square -1..1
_PLACE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)])
_CANDIDATES, _ITERATIONS, _OUTSIDE, _FLATNESS = 12, 20, 1e-6, 1e-9


@dataclass(frozen=True)
class Weights:
    """Nodes of the face under each point, and their shares: both (point, corner)."""

    node: np.ndarray
    share: np.ndarray


def locate(node, element, kind, point):
    """Weights of the points on flat element faces across z.

    Parameters
    ----------
    node : (n, 3) node positions [m]
    element : (e, 20 or 27) vertices in the order of meshio
    kind : "hexahedron20" or "hexahedron27"
    point : (p, 3) [m], all at one height z, where the body has faces

    Raises ConfigError where a point lies on no such face.
    """
    face = _faces_across_z(node, element, kind, point)
    tree = KDTree(node[face].mean(axis=1)[:, :2])
    near = face[tree.query(point[:, :2], k=np.arange(1, 1 + min(_CANDIDATES, len(face))))[1]]
    place = _invert(node[near][..., :2], point[:, None, :2])
    outside = np.nan_to_num(np.abs(place).max(axis=2), nan=np.inf)
    best = outside.argmin(axis=1)
    rows = np.arange(len(point))
    far = outside[rows, best] > 1 + _OUTSIDE
    if far.any():
        raise ConfigError("force mapping", "points on the faces of the body", f"{point[far][0]} m beside them",
                          "check the contact and sensor positions")
    return Weights(near[rows, best], _shape_functions(place[rows, best], near.shape[2])[0])


def spread(weights, force, nodes):
    """(nodes, 3) nodal forces of the point forces (p, 3): the transpose of ``gather``."""
    nodal = np.zeros((nodes, 3))
    np.add.at(nodal, weights.node, weights.share[..., None] * force[:, None, :])
    return nodal


def gather(weights, field):
    """(..., p, 3) values at the points of a nodal field (..., n, 3)."""
    return np.einsum("...pcx,pc->...px", field[..., weights.node, :], weights.share)


def spread_rows(row, node, axis, weight, force, nodes):
    """(nodes, 3) nodal forces of row forces (r,): sparse rows ``weight`` at (row, node, axis), transposed."""
    nodal = np.zeros((nodes, 3))
    np.add.at(nodal, (node, axis), weight * force[row])
    return nodal


def resultant(position, force):
    """Resultant (3,) [N] and moment about the origin (3,) [N m] of forces (n, 3) at positions (n, 3)."""
    return force.sum(axis=0), np.cross(position, force).sum(axis=0)


def circle_table(node, element, kind, shape, radius, height, direction, angles):
    """Participation of mode shapes along a circle about the z axis, ``angles`` equal steps from x.

    ``shape`` (mode, n, 3) [1/kg^0.5]; ``direction`` (3,) radial, tangential and axial component, the
    same all around, as of a force or a sensor that stays in place while the body turns under it.
    Returns (angles, mode) [1/kg^0.5].
    """
    angle = 2 * np.pi * np.arange(angles) / angles
    cosine, sine = np.cos(angle), np.sin(angle)
    point = np.stack([radius * cosine, radius * sine, np.full(angles, height)], axis=1)
    radial, tangential, axial = direction
    along = np.stack([radial * cosine - tangential * sine, radial * sine + tangential * cosine,
                      np.full(angles, axial)], axis=1)
    return np.einsum("mpx,px->pm", gather(locate(node, element, kind, point), shape), along)


def _faces_across_z(node, element, kind, point):
    """(f, corner) nodes of the element faces in the plane of the points."""
    if kind not in _FACE_NODES:
        raise ConfigError("force mapping", f"cells of type {' or '.join(_FACE_NODES)}", repr(kind))
    height, size = point[0, 2], np.ptp(node, axis=0).max()
    if np.ptp(point[:, 2]) > _FLATNESS * size:
        raise ConfigError("force mapping", "points at one height", f"{np.ptp(point[:, 2]):.3g} m between them")
    face = np.concatenate([element[:, f[:_FACE_NODES[kind]]] for f in _FACES])
    flat = (np.abs(node[face][..., 2] - height) <= _FLATNESS * size).all(axis=1)
    if not flat.any():
        raise ConfigError("force mapping", f"faces of the body at z = {height:.6g} m", "none",
                          "check the contact and sensor positions")
    return face[flat]


def _invert(corner, point):
    """(..., 2) places on the square whose position is ``point``, by Newton's method."""
    place = np.zeros((*corner.shape[:-2], 2))
    for _ in range(_ITERATIONS):
        shape, gradient = _shape_functions(place, corner.shape[-2])
        miss = np.einsum("...c,...cx->...x", shape, corner) - point
        slope = np.einsum("...cr,...cx->...xr", gradient, corner)
        place = np.clip(place - np.linalg.solve(slope, miss[..., None])[..., 0], -2, 2)
    return place


def _shape_functions(place, nodes):
    """Shape functions (..., c) and gradients (..., c, 2) of the face with 8 or 9 nodes."""
    (along, along_slope), (across, across_slope) = (_quadratic(place[..., i, None], _PLACE[:, i]) for i in (0, 1))
    shape = along * across
    gradient = np.stack([along_slope * across, along * across_slope], axis=-1)
    if nodes == 9:
        return shape, gradient
    # the middle node of the nine-node face follows the eight others: -1/4 of each corner, +1/2 of each edge
    follow = np.where(np.arange(8) < 4, -0.25, 0.5)
    return (shape[..., :8] + follow * shape[..., 8:], gradient[..., :8, :] + follow[:, None] * gradient[..., 8:, :])


def _quadratic(x, place):
    """Lagrange polynomials on -1, 0, 1 that are one at ``place``, and their slopes."""
    middle = place == 0
    return np.where(middle, 1 - x**2, x * (x + place) / 2), np.where(middle, -2 * x, x + place / 2)
