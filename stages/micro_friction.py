"""Stage micro_friction: friction, real contact area and wear of the rough surface pair."""

from functools import partial

import numpy as np

from pipeline.case_models.effect_block import rubbing_with_effects
from pipeline.case_models.rough.pair import Settings, cycle_distance, of_pair, offsets, rough_pair, rubbing, shifted
from pipeline.contract import ConfigError, Context, stage, stored
from pipeline.physics.numerics.grid_limit import grid_limit
from pipeline.physics.rough.contact.normal_contact import contact_area, uniform
from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact
from pipeline.physics.rough.pair_limits import refuse_beyond_limits, refuse_large_grid
from pipeline.physics.rough.sliding_pair import slide
from pipeline.products import Effects, MicroFriction, Surface


@stage
def micro_friction(surface: Surface, effects: Effects | None, settings: Settings,
                   context: Context) -> MicroFriction:
    """Compute friction, real contact area and wear over pressure, speed and sliding distance.

    Method:
    Two rough elastic blocks of hex8 finite elements, condensed exactly to their surfaces by DFT, were pressed together
    (conjugate gradients of Polonsky and Keer; with a stated hardness no spot is pressed harder, and what yields stays
    flattened) and sheared to full slip with the shear limit {third_body_factor} * {disc_strength} / sqrt(3); Archard
    wear was applied to both surfaces in {cycles} cycles. The friction coefficient is total shear force over total
    normal force, with the real area corrected for its perimeter (Yastrebov et al. 2017), averaged over one pass of the
    slider, {realisations} relative positions of the patches and all pairs of surfaces. Speed enters through a rate
    term ({rate_coefficient}) and thermal softening ({softening}) of the limit. Asperity moduli, third-body factor and
    wear coefficients with origin "tuned" were fitted to the facts named in their source.
    Effects at the asperities modify wear and shear.
    """
    for name in ("pressures", "disc_speeds", "refinement"):
        _refuse_falling(getattr(settings, name), name)
    speeds = np.array(settings.disc_speeds) * settings.effective_radius
    recorded = _recorded_cycles(settings)
    finest = round(surface.x.size * max(1.0, *settings.refinement))
    refuse_large_grid(finest, "micro_friction.refinement, surface.nodes")
    rubbed = rubbing_with_effects(rubbing(surface, settings), effects)
    pairs = [of_pair(rubbed, surface, number) for number in range(len(surface.pad_height))]
    for pair in pairs:
        refuse_beyond_limits(pair, settings.pressures, speeds)
    tasks = [(pressure, pair, offset) for pressure in settings.pressures for pair in pairs
             for offset in offsets(surface, settings)]
    run = partial(_slide, speeds=speeds, recorded=recorded)
    records = context.map(run, tasks, "sliding of the rough pair")
    middle = settings.pressures[len(settings.pressures) // 2]
    areas = context.map(partial(_area_on_grid, surface=surface, settings=settings, pressure=middle),
                        settings.refinement, "convergence of the contact area")
    shown = records[len(settings.pressures) // 2 * len(pairs) * settings.realisations]
    return MicroFriction(
        settings=stored(settings), pressure=settings.pressures, speed=speeds, disc_speed=settings.disc_speeds,
        distance=np.array(recorded) * cycle_distance(settings), **_table(records, len(settings.pressures), len(pairs)),
        block_compliance=uniform(rubbed.pair.compliance.normal), shear_limit=rubbed.shearing.limit, x=surface.x,
        y=surface.y,
        nodes_per_wavelength=surface.nodes_per_wavelength[0],
        refinement=np.array(settings.refinement) * surface.nodes_per_wavelength[0], refinement_area=areas,
        **dict(zip(("area_limit", "area_limit_error", "area_order"), grid_limit(settings.refinement, areas),
                   strict=True)),
        **{name: getattr(shown, name) for name in
           ("contact_pressure_new", "contact_pressure_worn", "pad_wear", "disc_wear")})


def _refuse_falling(values, name):
    if any(high <= low for low, high in zip(values, values[1:], strict=False)):
        raise ConfigError(f"micro_friction.{name}", "strictly rising values", str(list(values)))


def _recorded_cycles(settings):
    """The cycles nearest to the recorded distances."""
    distances, step = settings.recorded_distances, cycle_distance(settings)
    _refuse_falling(distances, "recorded_distances")
    cycles = [round(distance / step) for distance in distances] if step > 0.0 else [0, 0]
    if cycles[0] != 0 or len(set(cycles)) < len(cycles):
        raise ConfigError("micro_friction.recorded_distances", "two or more distances from 0, at least one wear cycle"
                          f" ({step:g} m) apart", str(list(distances)), "raise cycles")
    return cycles


def _slide(task, speeds, recorded):
    pressure, rubbed, offset = task
    return slide(shifted(rubbed, offset), pressure, speeds, recorded)


def _area_on_grid(factor, surface, settings, pressure):
    pair = rough_pair(surface, settings, factor)
    contact = solve_yielding_contact(-pair.pad_height - pair.disc_height, pair.compliance.normal, pressure,
                                     tolerance=settings.tolerance, max_iterations=settings.max_iterations,
                                     hardness=pair.hardness)
    return contact_area(contact.pressure > 0.0)[1]


def _table(records, pressures, pairs):
    """Mean over pairs of surfaces and positions (largest for the wear) of every figure, (pressure, speed, distance).

    Errors are those of the pairs, of one pair those of its positions, which tell less; of one position there are none.
    """
    def every(name):
        values = np.array([getattr(record, name) for record in records])
        return values.reshape(pressures, pairs, -1, *values.shape[1:])

    same = ("real_area", "normal_stiffness", "flash_temperature", "full_slip_distance", "limit_at_speed", "friction",
            "yielding_area")
    approach, friction = every("approach"), every("friction")
    drawn = friction.mean(axis=2) if pairs > 1 else friction[:, 0]
    return {**{name: every(name).mean(axis=(1, 2)) for name in same},
            "pair_friction": friction.mean(axis=2).swapaxes(0, 1),
            "friction_std": drawn.std(axis=1, ddof=min(1, drawn.shape[1] - 1)) / np.sqrt(drawn.shape[1]),
            "wear_depth": (approach - approach[..., :1]).mean(axis=(1, 2)),
            "largest_wear": every("largest_wear").max(axis=(1, 2))}
