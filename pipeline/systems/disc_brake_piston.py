"""Pistons of the disc brake in their bores, and the brake fluid behind them.

One or two stand beside one another under the inner pad, and as many over the outer one in a fixed caliper; all of them
are one body of several parts. Dimensions are those of one in the middle of the inner pad, then moved to its Place.

The piston is a cup of steel whose rim bears on the inner backplate and whose crown closes the bore of the housing. It
is meshed, because a cup is no rigid body here: its rim turns oval at a few kHz. The mesh of revolution needs a hole in
the crown, which is narrow and counts as closed for the fluid. The bore is a recess in the mesh of the housing whose
four walls touch the circle of the bore.

Fluid of bulk modulus B in the volume V behind a piston of area A is a spring A^2 B / V between piston and housing. It
ends at the line. The line, to a master cylinder that holds its pressure, has fluid of density rho, viscosity mu and
length L in a section a = pi d^2 / 4, with the inertance rho L / a and the flow resistance 128 mu L / (pi d^4)
(Merritt, Hydraulic Control Systems, 1967). Seen by the piston, whose displacement x moves the
volume A x,

    m x_l'' + c x_l' = k (x - x_l),    k = A^2 B / V,    m = A^2 rho L / a,    c = A^2 128 mu L / (pi d^4).

At rest x_l = x: fluid flows in or out, the pressure is that of the line, and the fluid adds no stiffness. Well above
sqrt(k / m) / (2 pi), some 100 Hz, the inertia of the line lets none flow, and the fluid is the spring k. One more
coordinate, an ordinary mass, thus does both in every analysis alike. Above its first resonance, some 300 Hz for 1 m,
the line is rather a waveguide of impedance A^2 rho v / a (v the speed of sound) than a mass; it stays far above
k / omega, so that x_l is at rest with either.

Bores of twin pistons are joined: A is their area, x their mean motion. The two sides of a fixed caliper have a column
and a line each: what joins them, a pipe or a bore across the disc, has the inertia of a line as well, and lets as
little flow.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import Mesh, divided, revolve
from pipeline.systems.disc_brake_rows import pad_height
from pipeline.systems.solids import Solid

#: least wall between two bores, m
_WALL = 2e-3
#: radius of the hole in the crown that the mesh needs, as a share of that of the piston
_HOLE = 0.1


@dataclass(frozen=True)
class Place:
    """Where a piston stands: ``angle`` rad about the disc from the middle of the pads, ``side`` -1 under the inner pad,
    1 over the outer one; ``name`` begins those of its joints, as in outer_pad_leading_."""

    name: str
    angle: float
    side: int

    def at(self, point):
        """Points (n, 3) of a piston in the middle under the inner pad, at this place: mirrored and turned."""
        x, y, z = np.asarray(point).T
        return np.column_stack((np.cos(self.angle) * x - np.sin(self.angle) * y,
                                np.sin(self.angle) * x + np.cos(self.angle) * y, -self.side * z))


@dataclass(frozen=True)
class FluidColumn:
    """Fluid per motion of the piston: spring of that in the bore, N/m, inertia, kg, and drag, N s/m, of the line."""

    stiffness: float
    inertia: float
    drag: float


def places(parameters):
    """(Place, ...) of the pistons."""
    off = _off_middle(parameters)
    beside = (("leading_", -off), ("trailing_", off)) if off else (("", 0.0),)
    sides = (("", -1), ("outer_pad_", 1)) if parameters.caliper.fixed else (("", -1),)
    return tuple(Place(side + end, angle, sign) for side, sign in sides for end, angle in beside)


def piston(parameters):
    """Solid of ``parameters.piston`` between housing and backplates. Raises ConfigError where it does not fit."""
    refuse_unfit_piston(parameters)
    p = parameters.piston
    radius = divided((_HOLE * p.diameter / 2, p.diameter / 2 - p.wall, p.diameter / 2), p.element_size)
    height = divided((-p.length, p.crown - p.length, 0.0), p.element_size)
    mask = np.ones((len(radius) - 1, p.angular_cells, len(height) - 1), bool)
    mask[np.ix_(radius[1:] <= p.diameter / 2 - p.wall + 1e-9, np.ones(p.angular_cells, bool),
                height[1:] > p.crown - p.length + 1e-9)] = False
    mesh = _at_all(places(parameters), revolve(radius, np.linspace(0, 2 * np.pi, p.angular_cells + 1), height, mask),
                   (parameters.joints.clamping_radius, 0.0, -pad_height(parameters)))
    return Solid(mesh, np.zeros(len(mesh.element), int), ("steel",), np.array([p.density]),
                 isotropic(p.young, p.poisson)[None], p.damping_ratio, np.empty(0, int), np.array([p.loss_factor]))


def _at_all(at, mesh, middle):
    """One Mesh of a piston, whose rim is centred on the origin, ``at`` every Place; ``middle``: of the rim under the
    inner pad. Elements keep their orientation: over the outer pad it is turned twice, not mirrored."""
    nodes = [place.at(mesh.node * (1, -place.side, 1) + middle) for place in at]
    first = len(mesh.node) * np.arange(len(at))
    return Mesh(np.concatenate(nodes), np.concatenate([mesh.element + k for k in first]),
                mesh.kind, np.tile(mesh.cell, (len(at), 1)))


def bore(parameters):
    """((first, last) radius, half the angle, height of the floor) of the recess of one piston in the housing."""
    middle, reach = parameters.joints.clamping_radius, bore_radius(parameters)
    floor = -pad_height(parameters) - parameters.caliper.piston_gap - parameters.piston.bore_depth
    return (middle - reach, middle + reach), float(np.arcsin(reach / middle)), floor


def _off_middle(parameters):
    """Half the angle between twin pistons; 0 of one alone."""
    p = parameters.piston
    return p.spacing / 2 / parameters.joints.clamping_radius if p.count == 2 else 0.0


def bore_radius(parameters):
    """Radius of the bore."""
    return parameters.piston.diameter / 2 + parameters.piston.clearance


def fluid_column(parameters):
    """FluidColumn of the fluid behind the pistons on one pad of ``parameters``; None without a piston."""
    p = parameters.piston
    if p.kind != "body":
        return None
    f = p.fluid
    area, line = p.count * np.pi * p.diameter**2 / 4, np.pi * f.line_diameter**2 / 4
    volume = area * column_length(parameters) + f.passage_volume
    return FluidColumn(float(f.bulk_modulus * area**2 / volume), float(f.density * f.line_length * area**2 / line),
                       float(128 * f.viscosity * f.line_length * area**2 / (np.pi * f.line_diameter**4)))


def column_length(parameters):
    """Length of the bore behind the piston."""
    return parameters.piston.bore_depth + parameters.caliper.piston_gap - parameters.piston.length


def refuse_unfit_piston(parameters):
    """ConfigError for a meshed piston whose dimensions do not fit those of pads and caliper."""
    p, c, pad, middle = parameters.piston, parameters.caliper, parameters.pad, parameters.joints.clamping_radius
    rim, reach = p.diameter / 2, bore_radius(parameters)
    half, off = np.arcsin(reach / middle), _off_middle(parameters)
    end, across = half + off, "spacing" if off else "diameter"
    rules = (
        (p.wall < (1 - _HOLE) * rim, "wall", f"a wall thinner than {(1 - _HOLE) * rim:g} m", f"{p.wall:g} m"),
        (p.crown < p.length, "crown", f"a crown thinner than the piston is long, {p.length:g} m", f"{p.crown:g} m"),
        (pad.inner_radius < middle - rim and middle + rim < pad.outer_radius, "diameter",
         f"a rim on the backplate, {pad.inner_radius:g} to {pad.outer_radius:g} m",
         f"{middle - rim:g} to {middle + rim:g} m"),
        (c.inner_radius < middle - reach and middle + reach < c.bridge_inner_radius, "diameter",
         f"a bore in the housing, {c.inner_radius:g} to {c.bridge_inner_radius:g} m",
         f"{middle - reach:g} to {middle + reach:g} m"),
        (not off or half + _WALL / middle / 2 < off, "spacing", f"bores {_WALL:g} m apart,"
         f" {2 * half * middle + _WALL:.4g} m or more", f"{p.spacing:g} m"),
        (end < c.angle / 2, across, f"a bore within the caliper, {c.angle / 2:.4g} rad", f"{end:.4g} rad"),
        (off + np.arcsin(rim / middle) < pad.angle / 2, across, f"rims on the backplate, within {pad.angle / 2:.4g}"
         " rad", f"{off + np.arcsin(rim / middle):.4g} rad"),
        (p.bore_depth < c.housing_depth, "bore_depth", f"a floor in the housing, above {c.housing_depth:g} m",
         f"{p.bore_depth:g} m"),
        (column_length(parameters) > 0, "length",
         f"a piston shorter than bore and gap, {p.bore_depth + c.piston_gap:g} m",
         f"{p.length:g} m: intersection with the floor"),
        (p.seal_depth < p.length - c.piston_gap, "seal_depth",
         f"a seal on the piston, above {p.length - c.piston_gap:g} m", f"{p.seal_depth:g} m"),
    )
    for holds, where, expected, actual in rules:
        if not holds:
            raise ConfigError(f"structure.piston.{where}", expected, actual)
