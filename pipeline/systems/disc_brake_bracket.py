"""Anchor bracket of the disc brake: a column at each end of the pads, joined under the inner pad and around the rim.

    outer arm   rim bridge   inner column          seen along sliding; the base joins the inner columns under the
       |____________|____________|                 inner pad, between disc and hub, and the columns' backs are bolted
       |  pad  disc   pad        |                 to the knuckle
       |                      base, bolts

The columns begin at the plane ends of the pads, which they guide; contact there is a joint, not part of the mesh.
"""

from functools import partial

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import divided, graded, revolve
from pipeline.systems.disc_brake_rows import pad_height
from pipeline.systems.solids import Solid


def bracket(parameters):
    """Solid of ``parameters.bracket`` around disc, pads and caliper; ConfigError where it would intersect them."""
    refuse_unfit_bracket(parameters)
    p = parameters.bracket
    mesh = _mesh(p, parameters.pad.angle / 2, inner_height(parameters))
    return Solid(mesh, np.zeros(len(mesh.element), int), ("nodular iron",), np.array([p.density]),
                 isotropic(p.young, p.poisson)[None], p.damping_ratio, np.empty(0, int), np.array([p.loss_factor]))


def inner_height(parameters):
    """Distance of columns, arms and base from the middle plane of the disc, where they stand beside it."""
    return parameters.disc.ring_thickness / 2 + parameters.bracket.disc_gap


def _mesh(p, pads, beside):
    """Mesh of revolution; ``pads`` half the angle of the pads, ``beside`` the height at which the disc is passed."""
    size, lines = p.element_size, partial(graded, cells=p.corner_cells) if p.corner_cells else divided
    radius = lines((p.inner_radius, p.base_outer_radius, p.rim_inner_radius, p.rim_outer_radius), size)
    angle = lines((-p.angle / 2, -pads, pads, p.angle / 2), 2 * size / (p.base_outer_radius + p.rim_outer_radius))
    height = lines((-p.column_height, -p.base_height, -beside, beside, p.arm_height), size)
    r, a, z = np.meshgrid(*(((line[1:] + line[:-1]) / 2) for line in (radius, angle, height)), indexing="ij")
    inside = abs(z) < beside
    column = (abs(a) > pads) & np.where(inside, r > p.rim_inner_radius, (z < 0) | (r > p.base_outer_radius))
    base = (abs(a) < pads) & (r < p.base_outer_radius) & (z < -beside) & (z > -p.base_height)
    return revolve(radius, angle, height, column | base)


def refuse_unfit_bracket(parameters):
    """ConfigError for a meshed bracket whose dimensions do not fit those of disc, pads and caliper."""
    b, c, d, p = parameters.bracket, parameters.caliper, parameters.disc, parameters.pad
    back, front = pad_height(parameters), pad_height(parameters) + c.piston_gap
    free = min(p.inner_radius, c.inner_radius)
    rules = (
        (b.rim_inner_radius > d.ring_outer_radius, "rim_inner_radius",
         f"a bridge outside the disc, beyond {d.ring_outer_radius:g} m", f"{b.rim_inner_radius:g} m: intersection"),
        (b.inner_radius < b.base_outer_radius < b.rim_inner_radius < b.rim_outer_radius, "inner_radius",
         "inner < base outer < rim inner < rim outer radius", f"{b.inner_radius:g}, {b.base_outer_radius:g},"
         f" {b.rim_inner_radius:g}, {b.rim_outer_radius:g} m"),
        (b.base_outer_radius <= free, "base_outer_radius", f"a base under pad and caliper, up to {free:g} m",
         f"{b.base_outer_radius:g} m: intersection"),
        (c.angle <= p.angle, "angle", f"a caliper between the columns, which begin at {p.angle / 2:.4g} rad",
         f"one that reaches {c.angle / 2:.4g} rad: intersection"),
        (b.angle > p.angle, "angle", f"columns beyond the pads, {p.angle:.4g} rad", f"{b.angle:.4g} rad"),
        (b.arm_height >= back, "arm_height", f"arms that cover the backplates, to {back:g} m", f"{b.arm_height:g} m"),
        (inner_height(parameters) < b.base_height < b.column_height, "base_height",
         f"disc with its gap < base < column height, from {inner_height(parameters):g} m",
         f"{b.base_height:g} and {b.column_height:g} m"),
        (b.column_height > front + 2 * parameters.joints.spot_size, "column_height",
         f"columns that reach the guide pins beside the housing, beyond {front + 2 * parameters.joints.spot_size:g} m",
         f"{b.column_height:g} m"),
    )
    for holds, where, expected, actual in rules:
        if not holds:
            raise ConfigError(f"structure.bracket.{where}", expected, actual)
