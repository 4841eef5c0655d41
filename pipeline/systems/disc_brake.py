"""The disc brake: a stepped disc, two pads with backplates, a floating caliper, and if declared bracket and piston.

Axes: disc axis z, the disc turns about +z, the pads are centred on the x axis. The outer pad
(fingers) lies at z > 0, the inner pad (piston) at z < 0; the friction ring is centred on z = 0.
The disc enters the pads at their leading end (negative angle) and leaves at the trailing end.

Values: the disc is fitted to Table 1 of the 2021 paper (calibration, not validation); the other parts
are of ordinary passenger-car size, since the paper keeps its own secret. Without a piston body the
caliper housing is solid.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.groups import named_nodes
from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import boundary_faces, divided, face_normals, revolve
from pipeline.systems.disc_brake_bracket import bracket
from pipeline.systems.disc_brake_checks import clamped_radius, refuse_unfit
from pipeline.systems.disc_brake_joints import joints, piston_rows
from pipeline.systems.disc_brake_pad import pad
from pipeline.systems.disc_brake_piston import FluidColumn, bore, fluid_column, piston
from pipeline.systems.disc_brake_rows import body_names, contacts, pad_height, placed, sensor_rows
from pipeline.systems.mesh_files.bodies import solid
from pipeline.systems.solids import Assembly, Rows, Solid

#: a mount counts as rigid when the web bends into it over less than this share of the clamped width
_BENDING_SHARE = 0.25
#: decay length of contact pressure with separation, share of the rms height (Persson 2007, PRL 99, 125502)
_SEPARATION_SHARE = 0.4


@dataclass(frozen=True)
class DiscBrake(Assembly):
    """Bodies with their names, the row on which the piston force acts, the area of a pad, and the fluid if any."""

    names: tuple
    piston: Rows
    pad_area: float
    fluid: FluidColumn | None


def build(parameters):
    """The brake of ``parameters``: attributes as the settings of the stage declare them.

    Raises ConfigError where parts intersect or do not meet.
    """
    refuse_unfit(parameters)
    names, others = body_names(parameters), {"bracket": bracket, "piston": piston}
    first = disc(parameters.disc), pad(parameters, +1), pad(parameters, -1)
    parameters = placed(parameters, [body.mesh for body in first])
    more = [_other(name, others[name], parameters) for name in names if name in others]
    bodies = (*first, caliper(parameters), *more)
    meshes = [b.mesh for b in bodies]
    touching = contacts(meshes, parameters)
    sensors, position, direction = sensor_rows(meshes, parameters)
    return DiscBrake(bodies, joints(meshes, parameters), touching, sensors, position, direction, names,
                     piston_rows(meshes, parameters), float(touching.area[touching.body == 1].sum()),
                     fluid_column(parameters))


def _other(name, make, parameters):
    """Solid of bracket or piston, from its file or as ``make`` meshes it."""
    section = getattr(parameters, name)
    return solid(section, name) if section.mesh_file else make(parameters)


def disc(parameters):
    """Stepped disc: friction ring centred on z = 0, web flush with the inner face, clamped by the bolts.

    From a file where one is named, with the materials of ``mesh_files``, held by its ``mount_group`` if stated.
    """
    p, where = parameters, "structure.disc.mount_group"
    if p.mesh_file:
        return solid(p, "disc", lambda body, table: named_nodes(body, p.mount_group, where) if p.mount_group else
                     clamped_nodes(body.mesh, p, max(max(material.young) for material in table)))
    if p.mount_group:
        raise ConfigError(where, "a set of nodes or a surface of the mesh file: it has none", repr(p.mount_group))
    mesh = disc_mesh(p)
    return Solid(mesh, np.zeros(len(mesh.element), int), ("cast iron",), np.array([p.density]),
                 isotropic(p.young, p.poisson)[None], p.damping_ratio, clamped_nodes(mesh, p),
                 np.array([float(p.loss_factor)]))


def disc_mesh(parameters):
    """Revolved section of web and ring, one cell across the web and one more across the ring."""
    p, reach = parameters, clamped_radius(parameters)
    clamped = int(np.clip(round(p.web_cells * (reach - p.bore_radius) / (p.ring_inner_radius - p.bore_radius)),
                          1, p.web_cells - 1))
    web = np.r_[np.linspace(p.bore_radius, reach, clamped + 1),
                np.linspace(reach, p.ring_inner_radius, p.web_cells - clamped + 1)[1:]]
    ring = np.linspace(p.ring_inner_radius, p.ring_outer_radius, p.ring_cells + 1)
    height = np.array([0, p.web_thickness, p.ring_thickness]) - p.ring_thickness / 2
    mask = np.ones((p.web_cells + p.ring_cells, p.angular_cells, 2), bool)
    mask[:p.web_cells, :, 1] = False
    return revolve(np.r_[web, ring[1:]], np.linspace(0, 2 * np.pi, p.angular_cells + 1), height, mask)


def clamped_nodes(mesh, parameters, young=None):
    """Nodes of the inner face that the bolts press on the hub: within the pressure cones of 30 degrees.

    The hub is rigid. Rough metal faces under pressure p are a foundation of stiffness k = p / (0.4 Sq)
    per area, into which the web bends over the length (E t^3 / 3k)^(1/4). That must be far less than
    the clamped width, else the mount is no rigid support (ConfigError). ``young``: E, by default the stated
    one.
    """
    p, reach = parameters, clamped_radius(parameters)
    face = boundary_faces(mesh)
    normal, middle = face_normals(mesh.node, face)
    bottom = (normal[:, 2] < -0.99) & (np.hypot(middle[:, 0], middle[:, 1]) < reach)
    if not bottom.any():
        raise ConfigError("structure.disc.mesh_file", f"faces towards -z within {reach:g} m to clamp", "none")
    pressure = p.bolt_count * p.bolt_preload / (np.pi * (reach**2 - p.bore_radius**2))
    interface, width = pressure / (_SEPARATION_SHARE * p.flange_roughness), reach - p.bore_radius
    bending = ((young or p.young) * p.web_thickness**3 / (3 * interface))**0.25
    if bending > _BENDING_SHARE * width:
        raise ConfigError("structure.disc.bolt_preload",
                          f"a mount that the web enters by less than {_BENDING_SHARE * width:.2g} m",
                          f"{bending:.2g} m", "tighten the bolts or smooth the flange")
    return np.unique(face[bottom])


def caliper(parameters):
    """C-shaped caliper: fingers above the outer pad, bridge over the rim, housing below the inner pad."""
    p, height = parameters.caliper, pad_height(parameters)
    if p.mesh_file:
        return solid(p, "caliper")
    front, back = -height - p.piston_gap, height
    edges = [[p.inner_radius, p.bridge_inner_radius], [-p.angle / 2, p.angle / 2], [front - p.housing_depth, front]]
    counts = p.radial_cells, p.angular_cells, p.housing_cells
    radius, angle, housing = (np.linspace(*e, n + 1) for e, n in zip(edges, counts, strict=True))
    if parameters.piston.kind == "body":
        radius, angle, housing = _around_bore(bore(parameters), edges, counts)
    radius = np.r_[radius, p.bridge_outer_radius]
    line = np.r_[housing, np.linspace(front, back, p.bridge_cells + 1)[1:], back + p.finger_thickness]
    middle = (line[:-1] + line[1:]) / 2
    mask = np.ones((len(radius) - 1, len(angle) - 1, len(middle)), bool)
    mask[:-1, :, (middle > front) & (middle < back)] = False
    if parameters.piston.kind == "body":
        mask &= ~_within(bore(parameters), radius, angle, middle, front)
    mesh = revolve(radius, angle, line, mask)
    return Solid(mesh, np.zeros(len(mesh.element), int), ("ductile iron",), np.array([p.density]),
                       isotropic(p.young, p.poisson)[None], p.damping_ratio, np.empty(0, int),
                       np.array([p.loss_factor]))


def _around_bore(recess, edges, counts):
    """Lattice lines of the housing that pass along the walls and the floor of its bore, about as many as ``counts``."""
    walls, half, floor = recess
    for line, more in zip(edges, (walls, (-half, half), (floor,)), strict=True):
        line[1:1] = more
    return [divided(line, (line[-1] - line[0]) / count) for line, count in zip(edges, counts, strict=True)]


def _within(recess, radius, angle, middle, front):
    """True where a cell of the lattice lies in the bore."""
    (first, last), half, floor = recess
    r, a = ((line[:-1] + line[1:]) / 2 for line in (radius, angle))
    across = (r > first) & (r < last)
    return across[:, None, None] & (abs(a) < half)[:, None] & ((middle > floor) & (middle < front))
