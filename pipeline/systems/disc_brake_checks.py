"""Dimensions of disc, pads and caliper that have to fit each other."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.systems.disc_brake_pad import refuse_unfit_shape


def clamped_radius(parameters):
    """Outer radius of the pressure cones of the bolts where they reach the hub."""
    p = parameters
    return p.bolt_circle_radius + p.bolt_head_radius + p.web_thickness * np.tan(np.pi / 6)


def refuse_unfit(parameters):
    """ConfigError for dimensions of disc, pads and caliper that do not fit; those of pads and caliper from mesh files
    are not asked."""
    refuse_unfit_shape(parameters.pad)
    d, p, c = parameters.disc, parameters.pad, parameters.caliper
    rules = (
        (d.bore_radius < d.ring_inner_radius < d.ring_outer_radius, "disc", "bore < ring inner < ring outer radius",
         f"{d.bore_radius:g}, {d.ring_inner_radius:g}, {d.ring_outer_radius:g} m"),
        (d.bore_radius < d.bolt_circle_radius and clamped_radius(d) < d.ring_inner_radius, "disc.bolt_circle_radius",
         "bolts whose pressure cones end between bore and ring", f"a clamped radius of {clamped_radius(d):g} m"),
        (0 < d.web_thickness < d.ring_thickness, "disc.web_thickness", "a web thinner than the ring",
         f"{d.web_thickness:g} of {d.ring_thickness:g} m"),
        (p.inner_radius < p.outer_radius, "pad", "inner < outer radius", f"{p.inner_radius:g}, {p.outer_radius:g} m"),
        (d.ring_inner_radius <= p.inner_radius and p.outer_radius <= d.ring_outer_radius, "pad",
         f"pads that lie on the ring, {d.ring_inner_radius:g} to {d.ring_outer_radius:g} m",
         f"{p.inner_radius:g} to {p.outer_radius:g} m"),
        (c.bridge_inner_radius > d.ring_outer_radius, "caliper.bridge_inner_radius",
         f"a bridge outside the disc, beyond {d.ring_outer_radius:g} m", f"{c.bridge_inner_radius:g} m: intersection"),
        (c.inner_radius < c.bridge_inner_radius < c.bridge_outer_radius, "caliper",
         "inner < bridge inner < bridge outer radius",
         f"{c.inner_radius:g}, {c.bridge_inner_radius:g}, {c.bridge_outer_radius:g} m"),
    )
    for holds, where, expected, actual in rules:
        meshed = getattr(parameters, where.split(".")[0]).mesh_file and not where.startswith("disc")
        if not holds and not meshed:
            raise ConfigError(f"structure.{where}", expected, actual)
