"""Point forces to finite-element nodes, keeping their resultant and moment; also on a turning disc.

A force at a point of an element face is shared among the nodes of the face by the shape functions
of that face. These sum to one and reproduce the position of the point, so that resultant and
moment are kept exactly. The same weights read a mode shape at the point, which makes modal forces
and sensors consistent.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.physics.fem.face_averages import interpolation

#: how far beside its face a point may lie, in sizes of the face: edges are parabolas where a rim is a circle
_BESIDE = 0.01


@dataclass(frozen=True)
class Weights:
    """Nodes of the face under each point, and their shares: both (point, corner)."""

    node: np.ndarray
    share: np.ndarray


def locate(node, face, point):
    """Weights of the points (p, 3) [m] on the faces (f, corner) of a body with nodes (n, 3) [m].

    A point may lie a hundredth of a face or 1 um beside the faces, as points of a circular rim do; raises
    ConfigError beyond that.
    """
    nearest, share = interpolation(node, face, point, "force mapping", slack=_BESIDE)
    return Weights(face[nearest], share)


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


def circle_table(node, face, shape, radius, height, direction, angles):
    """Participation of mode shapes along a circle about the z axis, in ``angles`` equal steps from x.

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
    return np.einsum("mpx,px->pm", gather(locate(node, face, point), shape), along)
