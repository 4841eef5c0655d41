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

from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import divided, revolve
from pipeline.systems.disc_brake_bracket import bracket
from pipeline.systems.disc_brake_checks import refuse_unfit
from pipeline.systems.disc_brake_disc import disc
from pipeline.systems.disc_brake_joints import joints, piston_rows
from pipeline.systems.disc_brake_pad import pad
from pipeline.systems.disc_brake_piston import FluidColumn, bore, fluid_column, piston
from pipeline.systems.disc_brake_rows import body_names, contacts, pad_height, placed, sensor_rows
from pipeline.systems.mesh_files.bodies import solid
from pipeline.systems.solids import Assembly, Rows, Solid


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
