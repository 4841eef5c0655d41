"""Stage micro_friction: friction, real contact area and wear of the rough pair."""

from functools import partial

import numpy as np

from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.flash_temperature import ThermalSolid
from pipeline.physics.layered_solid import layered_compliance
from pipeline.physics.rough_contact import contact_area, solve_normal_contact
from pipeline.physics.rough_friction import RoughPair, Shearing, Solving, Wearing, slide
from pipeline.physics.rough_surface import resample
from pipeline.products import MicroFriction, Surface


class Iron(Section):
    """Cast iron of the disc."""

    youngs_modulus: Quantity("Pa", gt=0) = option("110 GPa", "Young's modulus")
    poisson_ratio: float = option(0.26, "Poisson ratio", ge=0, lt=0.5)
    conductivity: Quantity("W/m/K", gt=0) = option("50 W/m/K", "thermal conductivity")
    density: Quantity("kg/m^3", gt=0) = option("7200 kg/m^3", "density")
    heat_capacity: Quantity("J/K/kg", gt=0) = option("500 J/K/kg", "heat capacity")
    wear_coefficient: Quantity("m^2/N", ge=0) = option("4e-7 mm^2/N", "Archard wear depth per pressure and distance")


class Lining(Section):
    """Pad on the scale of its roughness; modulus and wear are tuned to the published contact area and approach."""

    youngs_modulus: Quantity("Pa", gt=0) = option("0.235 GPa", "effective Young's modulus of the asperities, tuned to"
                                                  " the real contact area; the bulk of the lining has its own")
    poisson_ratio: float = option(0.25, "Poisson ratio", ge=0, lt=0.5)
    conductivity: Quantity("W/m/K", gt=0) = option("1 W/m/K", "thermal conductivity")
    density: Quantity("kg/m^3", gt=0) = option("2200 kg/m^3", "density")
    heat_capacity: Quantity("J/K/kg", gt=0) = option("1000 J/K/kg", "heat capacity")
    wear_coefficient: Quantity("m^2/N", ge=0) = option("4e-6 mm^2/N", "Archard wear depth per pressure and distance")


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
    pad: Lining = option(Lining(), "pad on the scale of its roughness")
    disc_strength: Quantity("Pa", gt=0) = option("234 MPa", "sigma_e of the disc in tau_max = factor sigma_e / sqrt(3)")
    third_body_factor: float = option(0.1, "shear strength of the third body over that of the disc", gt=0, le=1)
    rate_coefficient: float = option(0.015, "relative rise of the shear limit per unit of ln(speed)", ge=0)
    reference_speed: Quantity("rad/s", gt=0) = option("10.25 rad/s", "disc speed at which the shear limit is declared")
    softening: Quantity("1/K", ge=0) = option("5e-4 1/K", "relative loss of the shear limit per kelvin of flash rise")
    cycles: int = option(200, "wear cycles up to the last recorded distance", ge=1)
    stroke: Quantity("m", ge=0) = option("50 um", "pass of the slider before it returns to its start")
    recorded_distances: Quantities("m", ge=0) = option(
        ("0 mm", "0.3 mm", "1 mm", "2.5 mm", "5 mm", "7.5 mm", "10 mm"), "distances of the table, rising from 0")
    realisations: int = option(3, "relative positions of the two patches, averaged", ge=2)
    seed: int = option(7, "seed of the relative positions", ge=0)
    refinement: Quantities("1", gt=0) = option((0.5, 1.0, 2.0), "grid factors of the convergence study of the area")
    tolerance: float = option(1e-4, "gap error over rms gap, shear error over shear limit", gt=0, lt=0.1)
    max_iterations: int = option(2000, "iterations after which a solve is refused", ge=1)


@stage
def micro_friction(surface: Surface, settings: Settings, context: Context) -> MicroFriction:
    """Friction, real contact area and wear of the rough pair over pressure, speed and distance.

    Method:
    Two rough elastic blocks of hex8 finite elements, condensed exactly to their surface by DFT, are pressed together
    (Polonsky and Keer's conjugate gradients) and sheared to full slip under the shear limit {third_body_factor} *
    {disc_strength} / sqrt(3); Archard wear on both surfaces follows in {cycles} cycles. The coefficient of friction
    is the sum of shear over the sum of normal force, with the real area corrected for its perimeter (Yastrebov et al.
    2017), mean over one pass of the slider and {realisations} relative positions of the patches. Speed enters through a
    rate term ({rate_coefficient}) and thermal softening ({softening}) of the limit. The modulus of the asperities,
    the third-body factor and the wear coefficients are tuned to the published contact area, friction and approach.
    """
    for name in ("pressures", "disc_speeds"):
        _refuse_falling(getattr(settings, name), name)
    speeds = np.array(settings.disc_speeds) * settings.effective_radius
    recorded = _recorded_cycles(settings)
    offsets = np.random.default_rng(settings.seed).integers(0, surface.x.size, (settings.realisations, 2))
    offsets[0] = 0
    pair = _pair(surface, settings, 1.0)
    tasks = [(pressure, offset) for pressure in settings.pressures for offset in offsets]
    run = partial(_slide, pair=pair, speeds=speeds, recorded=recorded, settings=settings)
    records = context.map(run, tasks, "sliding of the rough pair")
    middle = settings.pressures[len(settings.pressures) // 2]
    areas = context.map(partial(_area_on_grid, surface=surface, settings=settings, pressure=middle),
                        settings.refinement, "convergence of the contact area")
    shown = records[len(settings.pressures) // 2 * settings.realisations]
    return MicroFriction(
        pressure=settings.pressures, speed=speeds, disc_speed=settings.disc_speeds,
        distance=np.array(recorded) * _cycle_distance(settings), **_table(records, settings),
        block_compliance=pair.compliance.normal[0, 0], shear_limit=_shear_limit(settings), x=surface.x, y=surface.y,
        refinement=np.array(settings.refinement) * surface.nodes_per_wavelength[0], refinement_area=areas,
        **{name: getattr(shown, name) for name in
           ("contact_pressure_new", "contact_pressure_worn", "pad_wear", "disc_wear")})


def _refuse_falling(values, name):
    if any(high <= low for low, high in zip(values, values[1:], strict=False)):
        raise ConfigError(f"micro_friction.{name}", "strictly rising values", str(list(values)))


def _cycle_distance(settings):
    return settings.recorded_distances[-1] / settings.cycles


def _recorded_cycles(settings):
    """The cycles nearest to the recorded distances."""
    distances, step = settings.recorded_distances, _cycle_distance(settings)
    _refuse_falling(distances, "recorded_distances")
    cycles = [round(distance / step) for distance in distances] if step > 0.0 else [0, 0]
    if cycles[0] != 0 or len(set(cycles)) < len(cycles):
        raise ConfigError("micro_friction.recorded_distances", "two or more distances from 0, at least one wear cycle"
                          f" ({step:g} m) apart", str(list(distances)), "raise cycles")
    return cycles


def _shear_limit(settings):
    return settings.third_body_factor * settings.disc_strength / np.sqrt(3.0)


def _pair(surface, settings, factor):
    """The rough pair on a grid ``factor`` times as fine; finer grids split the layers too."""
    nodes = round(surface.x.size * factor)
    spacing = (surface.x[1] - surface.x[0]) * surface.x.size / nodes
    pad, disc = (layered_compliance((nodes, nodes), (spacing, spacing), _split(depth, max(round(factor), 1)),
                                    solid.youngs_modulus, solid.poisson_ratio)
                 for depth, solid in ((surface.pad_depth, settings.pad), (surface.disc_depth, settings.disc)))
    heights = [resample(h, (nodes, nodes)) if factor != 1.0 else h for h in (surface.pad_height, surface.disc_height)]
    return RoughPair(*heights, (spacing, spacing), pad + disc)


def _split(depth, parts):
    return np.interp(np.arange((depth.size - 1) * parts + 1) / parts, np.arange(depth.size), depth)


def _slide(task, pair, speeds, recorded, settings):
    pressure, offset = task
    shifted = RoughPair(np.roll(pair.pad_height, offset, (0, 1)), pair.disc_height, pair.spacing, pair.compliance)
    wearing = Wearing(settings.cycles, _cycle_distance(settings), round(settings.stroke / pair.spacing[1]),
                      settings.pad.wear_coefficient, settings.disc.wear_coefficient)
    pad, disc = (ThermalSolid(s.conductivity, s.density, s.heat_capacity) for s in (settings.pad, settings.disc))
    shearing = Shearing(_shear_limit(settings), settings.reference_speed * settings.effective_radius,
                        settings.rate_coefficient, settings.softening, pad, disc)
    solving = Solving(settings.tolerance, settings.max_iterations)
    return slide(shifted, pressure, speeds, recorded, wearing, shearing, solving)


def _area_on_grid(factor, surface, settings, pressure):
    pair = _pair(surface, settings, factor)
    contact = solve_normal_contact(-pair.pad_height - pair.disc_height, pair.compliance.normal, pressure,
                                   tolerance=settings.tolerance, max_iterations=settings.max_iterations)
    return contact_area(contact.pressure > 0.0)[1]


def _table(records, settings):
    """Mean over realisations (largest for the wear) of every figure, (pressure, speed, distance)."""
    def every(name):
        values = np.array([getattr(record, name) for record in records])
        return values.reshape(len(settings.pressures), settings.realisations, *values.shape[1:])

    same = ("real_area", "normal_stiffness", "flash_temperature", "full_slip_distance", "limit_at_speed", "friction")
    approach = every("approach")
    return {**{name: every(name).mean(axis=1) for name in same},
            "friction_std": every("friction").std(axis=1, ddof=1) / np.sqrt(settings.realisations),
            "wear_depth": (approach - approach[..., :1]).mean(axis=1),
            "largest_wear": every("largest_wear").max(axis=1)}
