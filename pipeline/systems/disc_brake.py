"""The disc brake: a stepped disc, two pads with backplates, a caliper, and if declared bracket and pistons.

Axes: disc axis z, the disc turns about +z, the pads are centred on the x axis. The outer pad (fingers, or pistons of a
fixed caliper) lies at z > 0, the inner pad (pistons) at z < 0; the friction ring is centred on z = 0. The disc enters
the pads at their leading end (negative angle) and leaves at the trailing end.

Values: the disc is fitted to Table 1 of the 2021 paper (calibration, not validation); the other parts
are of ordinary passenger-car size, since the paper keeps its own secret. Without a piston body the
caliper housing is solid.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import divided, revolve
from pipeline.systems.disc_brake_bracket import bracket
from pipeline.systems.disc_brake_checks import refuse_unfit
from pipeline.systems.disc_brake_disc import disc
from pipeline.systems.disc_brake_joints import joints, piston_rows
from pipeline.systems.disc_brake_pad import pad
from pipeline.systems.disc_brake_piston import FluidColumn, bore, fluid_column, piston, places
from pipeline.systems.disc_brake_rows import body_names, contacts, pad_height, placed, sensor_rows
from pipeline.systems.mesh_files.bodies import solid
from pipeline.systems.solids import Assembly, Rows, Solid


@dataclass(frozen=True)
class DiscBrake(Assembly):
    """Bodies with their names, a row for each pad that pistons press, the area of a pad, and the fluid behind those of
    one pad if any."""

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


def moduli_left(softening, temperature):
    """Share of the moduli of linings that is left ``temperature`` K above that of reference, at which they are stated.

    They lose ``softening`` 1/K. Raises ConfigError where none is left.
    """
    left = 1 - softening * temperature
    if left <= 0:
        raise ConfigError("structure.pad.lining_softening", f"less than {1 / temperature:.3g} 1/K, so that moduli are"
                          f" left at friction_map.bulk_temperature {temperature:g} K", f"{softening:g} 1/K")
    return left


def softened(brake, left):
    """``brake`` with the share ``left`` of the moduli of its linings."""
    return replace(brake, bodies=tuple(
        replace(body, elasticity=body.elasticity * np.where(np.array(body.material_name) == "lining", left, 1.0)[
            :, None, None]) if name.startswith("pad") else body
        for name, body in zip(brake.names, brake.bodies, strict=True)))


def _other(name, make, parameters):
    """Solid of bracket or piston, from its file or as ``make`` meshes it."""
    section = getattr(parameters, name)
    return solid(section, name) if section.mesh_file else make(parameters)


def caliper(parameters):
    """C-shaped caliper: bridge over the rim, housing below the inner pad; fingers above the outer one, or, of a fixed
    caliper, another housing."""
    p, height = parameters.caliper, pad_height(parameters)
    if p.mesh_file:
        return solid(p, "caliper")
    front = -height - p.piston_gap
    edges = [[p.inner_radius, p.bridge_inner_radius], [-p.angle / 2, p.angle / 2], [front - p.housing_depth, front]]
    counts = p.radial_cells, p.angular_cells, p.housing_cells
    radius, angle, housing = (np.linspace(*e, n + 1) for e, n in zip(edges, counts, strict=True))
    bored = parameters.piston.kind == "body"
    if bored:
        radius, angle, housing = _around_bores(parameters, edges, counts)
    radius = np.r_[radius, p.bridge_outer_radius]
    back, beyond = (-front, -housing[-2::-1]) if p.fixed else (height, [height + p.finger_thickness])
    line = np.r_[housing, np.linspace(front, back, p.bridge_cells + 1)[1:], beyond]
    middle = (line[:-1] + line[1:]) / 2
    mask = np.ones((len(radius) - 1, len(angle) - 1, len(middle)), bool)
    mask[:-1, :, (middle > front) & (middle < back)] = False
    if bored:
        mask &= ~_within_bores(parameters, radius, angle, middle, front)
    mesh = revolve(radius, angle, line, mask)
    return Solid(mesh, np.zeros(len(mesh.element), int), ("ductile iron",), np.array([p.density]),
                       isotropic(p.young, p.poisson)[None], p.damping_ratio, np.empty(0, int),
                       np.array([p.loss_factor]))


def _around_bores(parameters, edges, counts):
    """Lattice lines of the housing that pass along the walls and the floors of its bores, about as many as
    ``counts``."""
    walls, half, floor = bore(parameters)
    around = sorted({place.angle + sign * half for place in places(parameters) for sign in (-1, 1)})
    for line, more in zip(edges, (walls, around, (floor,)), strict=True):
        line[1:1] = more
    return [divided(line, (line[-1] - line[0]) / count) for line, count in zip(edges, counts, strict=True)]


def _within_bores(parameters, radius, angle, middle, front):
    """True where a cell of the lattice lies in a bore."""
    (first, last), half, floor = bore(parameters)
    r, a = ((line[:-1] + line[1:]) / 2 for line in (radius, angle))
    across, inside = (r > first) & (r < last), np.zeros((len(r), len(a), len(middle)), bool)
    for place in places(parameters):
        depth = -place.side * middle
        inside |= (across[:, None, None] & (abs(a - place.angle) < half)[:, None]
                   & ((depth > floor) & (depth < front)))
    return inside
