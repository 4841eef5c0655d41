"""The disc: a friction ring, solid or of two cheeks with radial vanes between them, on a web that the hub holds.

The web is flush with the inner face of the ring (z < 0), or raised towards the fingers by a hat, whose wall joins both.
The disc turns and its mesh does not: vanes and holes, which are no body of revolution, stand where the mesh has them.
"""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.groups import named_nodes
from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.holes import drilled
from pipeline.physics.fem.mesh import boundary_faces, divided, face_normals, revolve
from pipeline.systems.disc_brake_checks import SAME_HEIGHT, clamped_radius, hole_rows, refuse_soft_mount
from pipeline.systems.mesh_files.bodies import solid
from pipeline.systems.mesh_files.disc_axis import refuse_other_axis
from pipeline.systems.mesh_files.materials import read
from pipeline.systems.solids import Solid


def disc(parameters):
    """Stepped disc: friction ring centred on z = 0, web flush with the inner face, clamped by the bolts.

    From a file where one is named, with the materials of ``mesh_files``, held by its ``mount_group`` if stated.
    """
    p, where = parameters, "structure.disc.mount_group"
    if p.mesh_file:
        refuse_other_axis(read(p).mesh, p.mesh_axes)
        return solid(p, "disc", lambda body, table: named_nodes(body, p.mount_group, where) if p.mount_group else
                     clamped_nodes(body.mesh, p, max(max(material.young) for material in table)))
    if p.mount_group:
        raise ConfigError(where, "a set of nodes or a surface of the mesh file: it has none", repr(p.mount_group))
    mesh = disc_mesh(p)
    return Solid(mesh, np.zeros(len(mesh.element), int), ("cast iron",), np.array([p.density]),
                 isotropic(p.young, p.poisson)[None], p.damping_ratio, clamped_nodes(mesh, p),
                 np.array([float(p.loss_factor)]))


def disc_mesh(parameters):
    """Revolved section of web, hat and ring, one cell across the web, and one across the ring or each of its cheeks."""
    p = parameters
    radius, angle, height = _radii(p), _angles(p), _heights(p)
    r, z = ((line[:-1] + line[1:]) / 2 for line in (radius, height))
    foot, top = _web(p)
    web = (r < p.ring_inner_radius)[:, None] & ((z > foot) & (z < top))
    wall = (r > p.ring_inner_radius - p.hat_thickness) & (r < p.ring_inner_radius)
    web |= wall[:, None] & ((z > _wall_foot(p)) & (z < top)) & bool(p.hat_height)
    ring = (r > p.ring_inner_radius)[:, None] & (abs(z) < p.ring_thickness / 2)
    mask = np.repeat((web | ring)[:, None], len(angle) - 1, axis=1)
    if p.vane_count:
        between = ring & (abs(z) < p.ring_thickness / 2 - p.cheek_thickness)
        middle = (angle[:-1] + angle[1:]) / 2 * p.vane_count / (2 * np.pi) % 1
        mask &= ~(between[:, None] & (middle > p.vane_share)[:, None])
    mesh = revolve(radius, angle, height, mask)
    return drilled(mesh, hole_rows(p).cells(radius, angle), p.hole_diameter) if p.hole_count else mesh


def _web(p):
    """Heights of the faces of the web: flush with the inner face of the ring, or raised by the hat."""
    foot = -p.ring_thickness / 2 + p.hat_height
    return foot, foot + p.web_thickness


def _wall_foot(p):
    """Height from which the wall of the hat rises: with vanes that of the outer cheek, so that air comes in."""
    return p.ring_thickness / 2 - p.cheek_thickness if p.vane_count else -p.ring_thickness / 2


def _radii(p):
    """Lines across web and ring, with one where the pressure of the bolts ends and one at the wall of a hat."""
    reach, ends = clamped_radius(p), [p.bore_radius]
    inner = p.ring_inner_radius - p.hat_thickness * bool(p.hat_height)
    clamped = int(np.clip(round(p.web_cells * (reach - p.bore_radius) / (p.ring_inner_radius - p.bore_radius)),
                          1, p.web_cells - 1))
    parts = [(reach, clamped), (inner, p.web_cells - clamped)]
    parts += [(p.ring_inner_radius, 1)] * bool(p.hat_height)
    lines = [np.array(ends)]
    for end, cells in parts:
        lines.append(np.linspace(lines[-1][-1], end, cells + 1)[1:])
    holes = hole_rows(p).lines()[0] if p.hole_count else np.empty(0)
    ring = _beside_holes([p.ring_inner_radius, *holes, p.ring_outer_radius], holes,
                         (p.ring_outer_radius - p.ring_inner_radius) / p.ring_cells)
    return np.concatenate([*lines, ring[1:]])


def _angles(p):
    """Lines around: those beside vanes and holes, and between them cells of about 1 / angular_cells."""
    holes = hole_rows(p).lines()[1] if p.hole_count else np.empty(0)
    edges = np.concatenate(((0, 2 * np.pi), holes))
    if p.vane_count:
        vanes = 2 * np.pi / p.vane_count * (np.arange(p.vane_count)[:, None] + (0, p.vane_share))
        edges = np.concatenate((edges, vanes.ravel()[1:]))
    return _beside_holes(np.sort(edges), holes, 2 * np.pi / p.angular_cells)


def _beside_holes(edges, holes, size):
    """Lines that divide what lies between ``edges`` by ``size``, but not from first to second of each two ``holes``."""
    return divided(edges, np.where(np.isin(edges[:-1], holes[::2]), np.inf, size))


def _heights(p):
    """Lines of the faces of ring, cheeks, web and hat."""
    half = p.ring_thickness / 2
    lines = [-half, half, *_web(p)] + [sign * (half - p.cheek_thickness) for sign in (-1, 1) if p.vane_count]
    lines = np.sort(lines)
    return lines[np.concatenate(([True], np.diff(lines) > SAME_HEIGHT))]


def clamped_nodes(mesh, parameters, young=None):
    """Nodes of the inner face that the bolts press on the hub, which is rigid: within the pressure cones of 30 degrees.

    ``young``: E, by default the stated one. Refuses a mount that is no rigid support.
    """
    p, reach = parameters, clamped_radius(parameters)
    face = boundary_faces(mesh)
    normal, middle = face_normals(mesh.node, face)
    bottom = (normal[:, 2] < -0.99) & (np.hypot(middle[:, 0], middle[:, 1]) < reach)
    if not bottom.any():
        raise ConfigError("structure.disc.mesh_file", f"faces towards -z within {reach:g} m to clamp", "none")
    refuse_soft_mount(p, young)
    return np.unique(face[bottom])
