"""Contact patches and sensors of the disc brake as displacement rows, and the numbers of its bodies."""

from types import SimpleNamespace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.face_averages import along, face_points, mean_rows, nearest_faces, surface_rows
from pipeline.physics.fem.mesh import boundary_faces, face_kind, face_normals
from pipeline.physics.fem.reference_cells import by_kind
from pipeline.systems.disc_brake_pad import shim_thickness
from pipeline.systems.mesh_files.bodies import CONTACT, measured
from pipeline.systems.solids import Contacts, Rows

DISC, OUTER, INNER, CALIPER = range(4)
#: faces of lining and disc touch where they are nearer than so many m
TOUCHING = 1e-4
#: most of a lining that may lie over holes
_HOLES = 0.5


def body_names(parameters):
    """Names of the bodies in order: those of every brake, then bracket and piston where they are bodies."""
    others = [name for name in ("bracket", "piston") if getattr(parameters, name).kind == "body"]
    return ("disc", "pad_outer", "pad_inner", "caliper", *others)


def pad_height(parameters):
    """Distance of the back of the pads, shims included, from the middle plane of the disc."""
    pad = parameters.pad
    return parameters.disc.ring_thickness / 2 + pad.lining_thickness + pad.backplate_thickness + shim_thickness(pad)


def placed(parameters, meshes):
    """``parameters`` with the dimensions of the pads as their mesh has them, where it is of a file."""
    if meshes[OUTER].groups is None:
        return parameters
    names = ("disc", "pad", "caliper", "bracket", "piston", "joints", "sensors")
    sections = {name: getattr(parameters, name) for name in names if hasattr(parameters, name)}
    return SimpleNamespace(**sections | {"pad": measured(parameters.pad, meshes[OUTER],
                                                         parameters.disc.ring_thickness)})


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
    """Body, centroids, areas and the (contacts, nodes) means on pad and disc of one pad, patches or single points.

    What lies over holes of the disc bears nothing.
    """
    p, mesh = parameters.pad, meshes[pad]
    face = mesh.groups[CONTACT] if mesh.groups else _front(mesh, pad)
    point, area = _points(mesh.node, face, p.contact_points)
    disc, below, shape = _disc_below(meshes[DISC], pad, point)
    point, area, below, shape = (each[below >= 0] for each in (point, area, below, shape))
    group = _patches(point, p, mesh.node[np.unique(face)]) if p.contact_points is None else np.arange(len(point))
    total = np.bincount(group, area)
    centre = np.stack([np.bincount(group, area * x) for x in point.T], axis=1) / total[:, None]
    rows = surface_rows(mesh.node, face, point, area, group, "structure.pad: contact face")
    on_disc = mean_rows(len(meshes[DISC].node), disc, below, shape, area, group)
    return np.full(len(total), pad), centre, total, rows, on_disc


def _front(mesh, pad):
    """Faces of a pad that touch the disc: those towards it that lie in front, without the floor of a slot."""
    face = faces_towards(mesh, -1 if pad == OUTER else 1)
    height = abs(face_normals(mesh.node, face)[1][:, 2])
    return face[height < abs(mesh.node[:, 2]).min() + TOUCHING]


def _points(node, face, count):
    """Points (p, 3) and areas (p,) on faces, which may be of several kinds."""
    parts = [face_points(node, cells, count) for _, _, cells in by_kind(face_kind(face), face)]
    return tuple(np.concatenate([each[k].reshape(-1, *each[k].shape[2:]) for each in parts]) for k in (0, 1))


def _patches(point, p, node):
    """(n,) number of the patch that each point lies in; ``node`` (k, 3) of the contact face, which patches divide."""
    radius, angle, ends = np.hypot(*point[:, :2].T), np.arctan2(point[:, 1], point[:, 0]), np.hypot(*node[:, :2].T)
    half = np.abs(np.arctan2(node[:, 1], node[:, 0])).max()
    across = np.floor((radius - ends.min()) / np.ptp(ends) * p.patches_radial)
    along = np.floor((angle / half + 1) / 2 * p.patches_angular)
    group = np.clip(along, 0, p.patches_angular - 1) * p.patches_radial + np.clip(across, 0, p.patches_radial - 1)
    return np.unique(group, return_inverse=True)[1].ravel()


def _disc_below(disc, pad, point):
    """Faces (f, v) of the disc towards a pad, the one below each (p, 3) point, -1 over holes, and its vertex weights.

    ConfigError for points that lie neither on the disc nor over a hole of it, and where most lie over holes.
    """
    side = 1 if pad == OUTER else -1
    face = faces_towards(disc, side)
    below, shape = nearest_faces(disc.node, face, point, TOUCHING)
    off = np.flatnonzero(below < 0)
    if len(off) <= _HOLES * len(point):
        off = off[~_enclosed(disc.node[np.unique(face)], point[off])]
    if len(off):
        height, radius = side * point[off, 2], np.hypot(*point[off, :2].T)
        raise ConfigError(
            f"structure: contact of the {('outer', 'inner')[pad != OUTER]} pad with the disc", "a lining whose face"
            f" lies on the ring, within {TOUCHING * 1e3:g} mm", f"{len(off) / len(point):.0%} of it off the disc, at"
            f" heights of {height.min():.5g} to {height.max():.5g} m from its middle plane and radii of"
            f" {radius.min():.4g} to {radius.max():.4g} m; the disc ends at"
            f" {(side * disc.node[np.unique(face), 2]).max():.5g} m",
            "move one of them so that they meet, and check radii, angles and units")
    return face, below, shape


def _enclosed(node, point):
    """(p,) whether nodes at the height of each point lie nearer to the axis and others farther from it."""
    inner, outer = np.full(len(point), np.inf), np.zeros(len(point))
    radius = np.hypot(*node[:, :2].T)
    for k, height in enumerate(point[:, 2]):
        there = radius[abs(node[:, 2] - height) < TOUCHING]
        inner[k], outer[k] = there.min(initial=np.inf), there.max(initial=0.0)
    away = np.hypot(*point[:, :2].T)
    return (inner < away) & (away < outer)


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
    return stacked(parts), np.array(position), np.array(direction, float)


def faces_towards(mesh, side):
    """Boundary faces that look along +z or -z, whatever their height."""
    face = boundary_faces(mesh)
    return face[face_normals(mesh.node, face)[0][:, 2] * side > 0.99]


def _diagonal_blocks(first, second):
    """The rows of both, one after the other, each padded with zero rows in place of the other's."""
    below = scipy.sparse.csr_matrix((second.shape[0], first.shape[1]))
    above = scipy.sparse.csr_matrix((first.shape[0], second.shape[1]))
    return scipy.sparse.vstack((first, below), format="csr"), scipy.sparse.vstack((above, second), format="csr")


def stacked(rows):
    """Rows of rows given body by body."""
    return Rows(tuple(scipy.sparse.vstack(parts, format="csr") for parts in zip(*rows, strict=True)))
