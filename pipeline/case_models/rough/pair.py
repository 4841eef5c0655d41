"""The rough pair of a case: its section of the YAML, and from a product Surface to the physics of rubbing."""

from dataclasses import replace

import numpy as np

from pipeline.case_models.rough.scans import grey_image
from pipeline.contract import ConfigError, InputFile, Quantities, Quantity, Section, option
from pipeline.physics.rough.composite.composite_block import composite_block
from pipeline.physics.rough.composite.composite_compliance import CompositeCompliance
from pipeline.physics.rough.composite.inclusions import of_image, spheres
from pipeline.physics.rough.flash_temperature import ThermalSolid
from pipeline.physics.rough.generator import resample
from pipeline.physics.rough.layered_solid import layered_compliance
from pipeline.physics.rough.sliding_pair import RoughPair, Rubbing, Shearing, Solving, Wearing

#: shares of the patch by which the particles of one pair lie off those of the pair before: never the same place again
_ELSEWHERE = (0.618, 0.382)


class Solid(Section):
    """What either body may state."""

    hardness: Quantity("Pa", gt=0) | None = option(None, "indentation hardness, the largest pressure of a contact spot;"
                                                   " the softer body yields; none = elastic")
    junction_growth: float = option(0.0, "Tabor's alpha, by which shear lets spots yield sooner: their pressure and"
                                    " shear limit fulfil p^2 + alpha tau^2 = hardness^2; 0 = without shear", ge=0)


class Iron(Solid):
    """Cast iron of the disc."""

    youngs_modulus: Quantity("Pa", gt=0) = option("110 GPa", "Young's modulus")
    poisson_ratio: float = option(0.26, "Poisson ratio", ge=0, lt=0.5)
    conductivity: Quantity("W/m/K", gt=0) = option("50 W/m/K", "thermal conductivity")
    density: Quantity("kg/m^3", gt=0) = option("7200 kg/m^3", "density")
    heat_capacity: Quantity("J/K/kg", gt=0) = option("500 J/K/kg", "heat capacity")
    wear_coefficient: Quantity("m^2/N", ge=0) = option("4e-7 mm^2/N", "Archard wear depth per pressure and distance")


class Inclusions(Section):
    """Particles or fibres in the resin of a lining, each of them of another modulus, shear limit and wear than this."""

    share: float = option(0.2, "of the volume that particles fill, where they are drawn at random", gt=0, lt=0.9)
    size: Quantity("m", gt=0) = option("100 um", "their diameter; of an image the depth to which it goes on")
    seed: int = option(11, "of the places of the particles", ge=0)
    image: InputFile | None = option(None, "instead a grey picture of the surface, stretched over the"
                                    " patch: particles bright")
    modulus_factor: float = option(..., "Young's modulus of a particle over that of resin, the pad's", gt=0)
    shear_factor: float = option(1.0, "shear limit on a particle over that on resin", gt=0)
    wear_factor: float = option(1.0, "wear coefficient of a particle over that of resin", ge=0)


class Lining(Solid):
    """Pad at the scale of its roughness; modulus and wear are tuned to the published contact area and approach."""

    youngs_modulus: Quantity("Pa", gt=0) = option("0.235 GPa", "Young's modulus of the pad asperities (micrometre"
                                                  " scale), effective, as the real contact area asks for; not the"
                                                  " bulk modulus structure.pad.lining_young_normal")
    poisson_ratio: float = option(0.25, "Poisson ratio", ge=0, lt=0.5)
    conductivity: Quantity("W/m/K", gt=0) = option("1 W/m/K", "thermal conductivity")
    density: Quantity("kg/m^3", gt=0) = option("2200 kg/m^3", "density")
    heat_capacity: Quantity("J/K/kg", gt=0) = option("1000 J/K/kg", "heat capacity")
    wear_coefficient: Quantity("m^2/N", ge=0) = option("4e-6 mm^2/N", "Archard wear depth per pressure and distance")
    inclusions: Inclusions | None = option(None, "particles in it, none = one material; contacts then take 100 to 300"
                                          " times as long: 64 x 64 nodes are advised")


class Settings(Section):
    """Operating points, solids, shear limit and wear of the rough pair."""

    pressures: Quantities("Pa", gt=0) = option(
        ("0.5 MPa", "1 MPa", "2 MPa", "3 MPa", "6 MPa"),
        "nominal contact pressures, rising; they span the range that the contact patches reach")
    disc_speeds: Quantities("rad/s", gt=0) = option(
        ("6.5 rad/s", "8.5 rad/s", "10.25 rad/s", "12 rad/s", "14.5 rad/s"),
        "disc speeds, rising; they span the range that the slip of the contact patches reaches")
    effective_radius: Quantity("m", gt=0) = option("128 mm", "radius at which the disc speed is the sliding speed")
    disc: Iron = option(Iron(), "cast iron of the disc")
    pad: Lining = option(Lining(), "pad at the scale of its roughness")
    disc_strength: Quantity("Pa", gt=0) = option("234 MPa", "sigma_e of the disc in tau_max = factor sigma_e / sqrt(3)")
    third_body_factor: float = option(0.1, "shear strength of the third body over that of the disc", gt=0, le=1)
    rate_coefficient: float = option(0.015, "relative rise of the shear limit per unit of ln(speed)", ge=0)
    reference_speed: Quantity("rad/s", gt=0) = option("10.25 rad/s", "disc speed at which the shear limit is declared")
    softening: Quantity("1/K", ge=0) = option("5e-4 1/K", "relative loss of the shear limit per kelvin of flash rise")
    cycles: int = option(200, "wear cycles up to the last recorded distance", ge=1)
    stroke: Quantity("m", ge=0) = option("50 um", "pass of the slider before it returns to its start")
    recorded_distances: Quantities("m", ge=0) = option(
        ("0 mm", "0.3 mm", "1 mm", "2.5 mm", "5 mm", "7.5 mm", "10 mm"), "distances of the table, rising from 0")
    realisations: int = option(3, "relative positions of the two patches, averaged; the first is that of the maps,"
                              " 1 where these lie as they were mounted", ge=1)
    seed: int = option(7, "seed of the relative positions", ge=0)
    coupling: bool = option(False, "shear of the spots lifts the surfaces in front of them and lowers them behind,"
                            " where the bodies differ")
    presliding: Quantities("1", gt=0, le=1) | None = option(
        None, "shares of the displacement of full slip at which friction from rest is told, on new surfaces")
    refinement: Quantities("1", gt=0) = option((0.5, 1.0, 2.0), "grid factors of the convergence study of the area")
    tolerance: float = option(1e-4, "gap error over rms gap, shear error over shear limit", gt=0, lt=0.1)
    max_iterations: int = option(2000, "iterations after which a solve is refused", ge=1)


def cycle_distance(settings):
    """Sliding in m that one wear cycle stands for."""
    return settings.recorded_distances[-1] / settings.cycles


def rough_pair(surface, settings, factor=1.0):
    """RoughPair of the first pair on a grid ``factor`` times as fine as that of the product Surface; finer grids split
    the layers too."""
    nodes = round(surface.x.size * factor)
    spacing = (surface.x[1] - surface.x[0]) * surface.x.size / nodes
    pad, disc = (layered_compliance((nodes, nodes), (spacing, spacing), _split(depth, max(round(factor), 1)),
                                    solid.youngs_modulus, solid.poisson_ratio)
                 for depth, solid in ((surface.pad_depth, settings.pad), (surface.disc_depth, settings.disc)))
    heights = [resample(h, (nodes, nodes)) if factor != 1.0 else h
               for h in (surface.pad_height[0], surface.disc_height[0])]
    pair = RoughPair(*heights, (spacing, spacing), pad + disc, *_softer(settings), coupled=settings.coupling)
    depth = _split(surface.pad_depth, max(round(factor), 1))
    return pair if settings.pad.inclusions is None else _with_inclusions(pair, pad, depth, settings.pad)


def _with_inclusions(pair, alike, depth, pad):
    """The RoughPair with the particles of its ``pad``, whose SurfaceCompliance as of resin is ``alike``."""
    given, shape = pad.inclusions, pair.pad_height.shape
    if given.image is None:
        inside = spheres(shape, pair.spacing, depth, given.share, given.size, given.seed)
    else:
        deep = int(np.searchsorted(depth, given.size, side="right")) - 1
        inside = of_image(grey_image(given.image, "micro_friction.pad.inclusions.image"), shape, depth.size - 1,
                          max(deep, 1))
    block = composite_block(np.where(inside, given.modulus_factor, 1.0), pair.spacing, depth, pad.youngs_modulus,
                            pad.poisson_ratio)
    mean = given.modulus_factor ** inside[0].mean()     # of one modulus that is as stiff near the surface
    normal = CompositeCompliance(pair.compliance.normal + (1 / mean - 1) * alike.normal, alike.normal / mean, block)
    return replace(pair, compliance=replace(pair.compliance, normal=normal),
                   shear_factor=np.where(inside[0], given.shear_factor, 1.0),
                   wear_factor=np.where(inside[0], given.wear_factor, 1.0))


def _softer(settings):
    """(hardness in Pa, name) of the softer body, sheared at its limit; infinite where neither has one."""
    hardness = {name: _pressed_and_slid(settings, name) for name in ("pad", "disc")}
    softer = min(hardness, key=hardness.get)
    return hardness[softer], softer


def _pressed_and_slid(settings, name):
    """Largest pressure in Pa of a spot of the body of this ``name`` that also bears the shear limit (Tabor 1959)."""
    solid, shear = getattr(settings, name), _shear_limit(settings)
    if solid.hardness is None:
        return np.inf
    left = solid.hardness**2 - solid.junction_growth * shear**2
    if left <= 0.0:
        raise ConfigError(f"micro_friction.{name}.junction_growth", "less than (hardness / shear limit)^2,"
                          f" {(solid.hardness / shear)**2:.3g}", f"{solid.junction_growth:g}",
                          "such spots yield by shear alone: lower third_body_factor")
    return np.sqrt(left)


def _shear_limit(settings):
    """tau_max in Pa at the reference speed."""
    return settings.third_body_factor * settings.disc_strength / np.sqrt(3.0)


def rubbing(surface, settings):
    """Rubbing of a product Surface under the section ``micro_friction``."""
    pair = rough_pair(surface, settings)
    wearing = Wearing(settings.cycles, cycle_distance(settings), round(settings.stroke / pair.spacing[1]),
                      settings.pad.wear_coefficient, settings.disc.wear_coefficient)
    pad, disc = (ThermalSolid(s.conductivity, s.density, s.heat_capacity) for s in (settings.pad, settings.disc))
    shearing = Shearing(_shear_limit(settings), settings.reference_speed * settings.effective_radius,
                        settings.rate_coefficient, settings.softening, pad, disc)
    return Rubbing(pair, wearing, shearing, Solving(settings.tolerance, settings.max_iterations))


def offsets(surface, settings):
    """Relative positions (realisations, 2) of the two patches in nodes; the first is none."""
    shifts = np.random.default_rng(settings.seed).integers(0, surface.x.size, (settings.realisations, 2))
    shifts[0] = 0
    return shifts


def of_pair(rubbing, surface, number):
    """The Rubbing with the surfaces of the pair of this ``number`` of a product Surface; particles of a lining lie
    elsewhere in each."""
    moved = rubbing.pair.with_particles_at(tuple(round(number * share * surface.x.size) for share in _ELSEWHERE))
    return replace(rubbing, pair=replace(moved, pad_height=surface.pad_height[number],
                                         disc_height=surface.disc_height[number]))


def shifted(rubbing, offset):
    """The Rubbing with its pad shifted by ``offset`` (y, x) in nodes."""
    return replace(rubbing, pair=rubbing.pair.with_pad_at(tuple(offset)))


def _split(depth, parts):
    return np.interp(np.arange((depth.size - 1) * parts + 1) / parts, np.arange(depth.size), depth)
