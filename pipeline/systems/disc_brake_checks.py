"""Dimensions of disc, pads and caliper that have to fit each other."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.holes import HoleRows
from pipeline.systems.disc_brake_pad import refuse_beside_file, refuse_unfit_shape

#: heights of a disc closer than so many m are one
SAME_HEIGHT = 1e-6
#: thinnest layer of elements of a disc, share of its ring
_THINNEST = 0.02
#: a mount counts as rigid when the web bends into it over less than this share of the clamped width
_BENDING_SHARE = 0.25
#: decay length of contact pressure with separation, share of the rms height (Persson 2007, PRL 99, 125502)
_SEPARATION_SHARE = 0.4


def clamped_radius(parameters):
    """Outer radius of the pressure cones of the bolts where they reach the hub."""
    p = parameters
    return p.bolt_circle_radius + p.bolt_head_radius + p.web_thickness * np.tan(np.pi / 6)


def hole_rows(disc):
    """The holes of the ring as stated by the settings of the disc."""
    return HoleRows(disc.hole_diameter, disc.hole_count, disc.hole_rows, disc.ring_inner_radius, disc.ring_outer_radius,
                    disc.vane_count, disc.vane_share if disc.vane_count else 0.0)


def refuse_unfit(parameters):
    """ConfigError for dimensions of disc, pads and caliper that do not fit; those of pads and caliper from mesh files
    are not asked."""
    refuse_unfit_shape(parameters.pad)
    if parameters.disc.mesh_file:
        refuse_beside_file(parameters.disc, "disc", ("vane_count", "hole_count", "hat_height"))
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
    for holds, where, expected, actual in (*rules, *_shape_of_disc(d), *_holes_of_disc(d)):
        meshed = getattr(parameters, where.split(".")[0]).mesh_file and not where.startswith("disc")
        if not holds and not meshed:
            raise ConfigError(f"structure.{where}", expected, actual)
    if not d.mesh_file and not d.mount_group:
        refuse_soft_mount(d)


def refuse_soft_mount(disc, young=None):
    """ConfigError for a disc whose mount is no rigid support.

    Rough metal faces under pressure p are a foundation of stiffness k = p / (0.4 Sq) per area, into which the web bends
    over the length (E t^3 / 3k)^(1/4). That must be far less than the clamped width. ``young``: E, by default the
    stated one.
    """
    d, reach = disc, clamped_radius(disc)
    pressure = d.bolt_count * d.bolt_preload / (np.pi * (reach**2 - d.bore_radius**2))
    interface, width = pressure / (_SEPARATION_SHARE * d.flange_roughness), reach - d.bore_radius
    bending = ((young or d.young) * d.web_thickness**3 / (3 * interface))**0.25
    if bending > _BENDING_SHARE * width:
        raise ConfigError("structure.disc.bolt_preload",
                          f"a mount that the web enters by less than {_BENDING_SHARE * width:.2g} m",
                          f"{bending:.2g} m", "tighten the bolts or smooth the flange")


def _shape_of_disc(d):
    """[(whether it holds, where, expected, found)] of the vanes and the hat of a disc."""
    if d.mesh_file or not (d.vane_count or d.hat_height):
        return []
    reach, half, cheek = clamped_radius(d), d.ring_thickness / 2, d.cheek_thickness
    rules = [(not d.hat_height or d.ring_inner_radius - d.hat_thickness > reach, "disc.hat_thickness",
              f"less than {d.ring_inner_radius - reach:.3g} m, from the clamped radius to the ring",
              f"{d.hat_thickness:g} m")]
    if d.vane_count:
        rules += [(cheek is not None and cheek < half, "disc.cheek_thickness", f"less than half the ring, {half:g} m",
                   "none" if cheek is None else f"{cheek:g} m"),
                  (d.vane_count >= 3, "disc.vane_count", "3 vanes or more", f"{d.vane_count}")]
    web, cheeks = np.array([0.0, d.web_thickness]) + d.hat_height - half, []
    if cheek is not None and d.vane_count:
        cheeks = [cheek - half, half - cheek]
        rules.append((not d.hat_height or web[1] > half - cheek, "disc.hat_height", "a web that ends above the foot of"
                      f" the outer cheek, which bears the hat: more than {2 * half - cheek - d.web_thickness:.3g} m",
                      f"{d.hat_height:g} m"))
    apart = np.diff(np.sort([-half, half, *web, *cheeks]))
    thin = apart[(apart > SAME_HEIGHT) & (apart < _THINNEST * d.ring_thickness)]
    return [*rules, (not len(thin), "disc.cheek_thickness" if d.vane_count else "disc.hat_height",
                     "faces of web, ring and cheeks that coincide or are at least"
                     f" {_THINNEST * d.ring_thickness:.2g} m apart", f"{thin.min(initial=np.inf):.2g} m")]


def _holes_of_disc(d):
    """[(whether it holds, where, expected, found)] of the holes of a disc."""
    if d.mesh_file or not d.hole_count:
        return []
    if d.hole_diameter is None:
        return [(False, "disc.hole_diameter", "a diameter for the holes", "none")]
    if d.vane_count % d.hole_count:
        return [(False, "disc.hole_count", f"a divisor of the {d.vane_count} channels between vanes, in whose middles"
                 " holes lie", f"{d.hole_count}")]
    most = hole_rows(d).largest
    return [(d.hole_diameter <= most, "disc.hole_diameter", f"holes of {most:.2g} m at most, with room for the elements"
             f" around each of {d.hole_count} in {d.hole_rows} rows", f"{d.hole_diameter:g} m")]
