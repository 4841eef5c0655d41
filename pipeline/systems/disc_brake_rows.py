"""Joints, contact patches, sensors and the piston of the disc brake as displacement rows.

What is not meshed is a spring with a damper between two surface means: fingers and piston on the backplates, pads in
their abutments, guide pins.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.fem.face_averages import along, face_points, surface_rows
from pipeline.physics.fem.mesh import boundary_faces, face_normals
from pipeline.systems.solids import Contacts, Joints, Rows

DISC, OUTER, INNER, CALIPER = range(4)
_AXES = {"radial": 0, "tangential": 1, "axial": 2}
#: points per direction that sample a spot
_SPOT_POINTS = 5


@dataclass(frozen=True)
class _Spot:
    """Mean displacement (1, n) of a small area of one body."""

    body: int
    mean: "scipy.sparse.csr_matrix"


def contacts(meshes, parameters):
    """Contacts of both pads; pad and disc are read at the same points, so forces keep resultant and moment."""
    read = [_pad_patches(meshes, parameters, pad) for pad in (OUTER, INNER)]
    pad, position, area = (np.concatenate([r[k] for r in read]) for k in range(3))
    radial = position * (1, 1, 0) / np.hypot(position[:, 0], position[:, 1])[:, None]
    normal = np.where(pad == OUTER, 1.0, -1.0)[:, None] * (0, 0, 1)
    rows = []
    for direction in (normal, np.cross((0, 0, 1), radial), radial):
        radii = [along(r[3], direction[pad == p]) for r, p in zip(read, (OUTER, INNER), strict=True)]
        parts = [scipy.sparse.csr_matrix((len(pad), 3 * len(m.node))) for m in meshes]
        parts[OUTER], parts[INNER] = _diagonal_blocks(*radii)
        parts[DISC] = -along(scipy.sparse.vstack([r[4] for r in read]), direction)
        rows.append(Rows(tuple(parts)))
    return Contacts(pad, position, area, *rows)


def _pad_patches(meshes, parameters, pad):
    """Body, centroids, areas and the (contacts, nodes) means on pad and disc of one pad, patches or single points."""
    p, mesh = parameters.pad, meshes[pad]
    face = faces_towards(mesh, -1 if pad == OUTER else 1)
    point, area = (a.reshape(-1, *a.shape[2:]) for a in face_points(mesh.node, face, p.contact_points))
    radius, angle = np.hypot(point[:, 0], point[:, 1]), np.arctan2(point[:, 1], point[:, 0])
    across = np.floor((radius - p.inner_radius) / (p.outer_radius - p.inner_radius) * p.patches_radial)
    along = np.floor((angle / p.angle + 0.5) * p.patches_angular)
    group = (along * p.patches_radial + across).astype(int) if p.contact_points is None else np.arange(len(point))
    total = np.bincount(group, area)
    centre = np.stack([np.bincount(group, area * x) for x in point.T], axis=1) / total[:, None]
    rows = surface_rows(mesh.node, face, point, area, group, "structure.pad: contact face")
    opposite = faces_towards(meshes[DISC], 1 if pad == OUTER else -1)
    met = surface_rows(meshes[DISC].node, opposite, point, area, group, "structure.pad: contact with the disc")
    return np.full(len(total), pad), centre, total, rows, met


def joints(meshes, parameters):
    """All declared joints; ``loss_time`` is damping over stiffness, loss factors those of the kinds of joint."""
    j, springs = parameters.joints, []
    for end, sign in (("leading", -1), ("trailing", 1)):
        springs += _guide_pin(meshes, parameters, end, sign)
        for name, pad in (("outer", OUTER), ("inner", INNER)):
            spot = _backplate_end(meshes, parameters, pad, sign)
            held = j.abutment_stiffness if end == "trailing" else j.clip_stiffness
            springs += [(f"abutment_{name}_{end}_tangential", held, spot, None, "tangential"),
                      (f"abutment_{name}_{end}_radial", j.abutment_radial_stiffness, spot, None, "radial")]
    for prefix, side, normal, shear in (("finger", OUTER, j.finger_stiffness, j.finger_shear_stiffness),
                                        ("piston", INNER, j.piston_stiffness, j.piston_shear_stiffness)):
        for corner, pad, body in _clamping_spots(meshes, parameters, prefix, side):
            springs += [(f"{prefix}_{kind}_{corner}", stiffness / 4, pad, body, axis) for kind, stiffness, axis in
                      (("normal", normal, "axial"), ("tangential", shear, "tangential"), ("radial", shear, "radial"))]
    name, stiffness, *_ = zip(*springs, strict=True)
    rows = _stacked([_relative(meshes, first, other, _AXES[axis]) for _, _, first, other, axis in springs])
    loss = np.array([getattr(j, f"{_kind(each)}_loss_factor") for each in name])
    return Joints(name, np.array(stiffness), np.array(stiffness) * j.loss_time, rows, loss)


def _kind(name):
    """Kind of a joint: abutment, finger, piston or guide_pin."""
    return next(kind for kind in ("abutment", "finger", "piston", "guide_pin") if name.startswith(kind))


def piston_rows(meshes, parameters):
    """One row: mean distance of inner backplate and cylinder; a unit force pushes the pad onto the disc."""
    relative = [_relative(meshes, pad, body, 2) for _, pad, body in
                _clamping_spots(meshes, parameters, "piston", INNER)]
    return Rows(tuple(scipy.sparse.csr_matrix(sum(parts) / len(relative)) for parts in zip(*relative, strict=True)))


def sensor_rows(meshes, parameters):
    """Rows, positions and unit directions of the sensors on the faces of the ring."""
    half, parts, position, direction = parameters.disc.ring_thickness / 2, [], [], []
    for s in parameters.sensors:
        side, c, z = (1 if s.face == "outer" else -1), np.cos(s.angle), np.sin(s.angle)
        point = np.array([s.radius * c, s.radius * z, side * half])
        unit = {"axial": (0, 0, 1), "radial": (c, z, 0), "tangential": (-z, c, 0)}[s.direction]
        mean = surface_rows(meshes[DISC].node, faces_towards(meshes[DISC], side), point[None], np.ones(1),
                            np.zeros(1, int), f"structure.sensors: {s.name}")
        row = [scipy.sparse.csr_matrix((1, 3 * len(m.node))) for m in meshes]
        row[DISC] = along(mean, np.array([unit], float))
        parts.append(row)
        position.append(point)
        direction.append(unit)
    return _stacked(parts), np.array(position), np.array(direction, float)


def faces_towards(mesh, side):
    """Boundary faces that look along +z or -z, whatever their height."""
    face = boundary_faces(mesh)
    return face[face_normals(mesh.node, face)[0][:, 2] * side > 0.99]


def _guide_pin(meshes, parameters, end, sign):
    """Axial, tangential and radial springs to ground on the end faces of the housing, at two depths."""
    c, j = parameters.caliper, parameters.joints
    front = meshes[CALIPER].node[:, 2].min() + c.housing_depth
    pins = []
    for end_name, depth in (("front", c.housing_depth / 6), ("rear", 5 * c.housing_depth / 6)):
        spot = _end_spot(meshes, CALIPER, sign * c.angle / 2, j.guide_pin_radius, front - depth, j.spot_size)
        pins += [(f"guide_pin_{end}_{kind}_{end_name}", stiffness / 2, spot, None, kind) for kind, stiffness in
                 (("axial", j.guide_pin_axial_stiffness), ("tangential", j.guide_pin_stiffness),
                  ("radial", j.guide_pin_stiffness))]
    return pins


def _backplate_end(meshes, parameters, pad, sign):
    p = parameters.pad
    height = (1 if pad == OUTER else -1) * (parameters.disc.ring_thickness / 2 + p.lining_thickness
                                            + p.backplate_thickness / 2)
    return _end_spot(meshes, pad, sign * p.angle / 2, (p.inner_radius + p.outer_radius) / 2, height,
                     p.backplate_thickness / 2)


def _end_spot(meshes, body, angle, radius, height, size):
    """Spot on the plane end of a body at ``angle``, centred on (radius, height)."""
    offset = np.linspace(-size / 2, size / 2, _SPOT_POINTS)
    r, z = (a.ravel() for a in np.meshgrid(radius + offset, height + offset))
    return _spot(meshes, body, np.column_stack((r * np.cos(angle), r * np.sin(angle), z)), "end face")


def _clamping_spots(meshes, parameters, prefix, pad):
    """(place, spot on the backplate, spot on the caliper) at four places of fingers or piston."""
    j, p, c = parameters.joints, parameters.pad, parameters.caliper
    side = 1 if pad == OUTER else -1
    back = side * (parameters.disc.ring_thickness / 2 + p.lining_thickness + p.backplate_thickness)
    caliper = back if pad == OUTER else back - c.piston_gap
    offset = np.linspace(-j.spot_size / 2, j.spot_size / 2, _SPOT_POINTS)
    for end, forward in (("leading", -1), ("trailing", 1)):
        for level, across in (("inner", -1), ("outer", 1)):
            x, y = (a.ravel() for a in np.meshgrid(
                j.clamping_radius + across * j.clamping_height / 2 + offset,
                forward * (j.finger_distance if prefix == "finger" else j.piston_distance) / 2 + offset))
            spots = (_spot(meshes, body, np.column_stack((x, y, np.full_like(x, z))), f"{prefix} {end} {level}")
                     for body, z in ((pad, back), (CALIPER, caliper)))
            yield f"{end}_{level}", *spots


def _spot(meshes, body, point, where):
    mean = surface_rows(meshes[body].node, boundary_faces(meshes[body]), point, np.ones(len(point)),
                        np.zeros(len(point), int), f"structure.joints: {where}")
    return _Spot(body, mean)


def _relative(meshes, first, other, axis):
    """Displacement of one spot less that of the other (or of the ground) along an axis, per body."""
    row = [scipy.sparse.csr_matrix((1, 3 * len(m.node))) for m in meshes]
    row[first.body] = along(first.mean, np.eye(3)[[axis]])
    if other is not None:
        row[other.body] = -along(other.mean, np.eye(3)[[axis]])
    return row


def _diagonal_blocks(first, second):
    """The rows of both, one after the other, each padded with zero rows in place of the other's."""
    below = scipy.sparse.csr_matrix((second.shape[0], first.shape[1]))
    above = scipy.sparse.csr_matrix((first.shape[0], second.shape[1]))
    return scipy.sparse.vstack((first, below), format="csr"), scipy.sparse.vstack((above, second), format="csr")


def _stacked(rows):
    return Rows(tuple(scipy.sparse.vstack(parts, format="csr") for parts in zip(*rows, strict=True)))
