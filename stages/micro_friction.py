"""Stage micro_friction: friction, real contact area and wear of the rough surface pair."""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.case_models.effect_block import rubbing_with_effects
from pipeline.case_models.rough.pair import Settings, cycle_distance, of_pair, offsets, rough_pair, rubbing, shifted
from pipeline.contract import ConfigError, Context, stage, stored
from pipeline.physics.numerics.grid_limit import grid_limit
from pipeline.physics.rough.contact.normal_contact import contact_area, uniform
from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact
from pipeline.physics.rough.pair_limits import refuse_beyond_limits, refuse_large_grid
from pipeline.physics.rough.sliding_pair import from_rest, nodal_limit, slide
from pipeline.physics.rough.subsurface_stress import stress_at, von_mises
from pipeline.products import Effects, MicroFriction, Surface

#: depth to which stress is told, in shortest wavelengths, and the number of depths
_DEEP, _DEPTHS = 1.0, 41


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
    term ({rate_coefficient}) and thermal softening ({softening}) of the limit.
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
    shown = len(settings.pressures) // 2 * len(pairs) * settings.realisations
    middle = settings.pressures[len(settings.pressures) // 2]
    finer = [partial(_area_on_grid, factor, surface, settings, middle) for factor in settings.refinement[::-1]]
    sliding = [partial(_slide, (*task, k == shown), speeds, recorded) for k, task in enumerate(tasks)]
    rest = [partial(from_rest, pairs[0], pressure, speeds[len(speeds) // 2], settings.presliding)
            for pressure in (settings.pressures if settings.presliding else ())]
    areas, records, begins = context.side_by_side(
        finer, sliding, rest, label="sliding and rest of the rough pair, finer grids")
    areas = areas[::-1]     # the longest came first
    return MicroFriction(
        settings=stored(settings), pressure=settings.pressures, speed=speeds, disc_speed=settings.disc_speeds,
        distance=np.array(recorded) * cycle_distance(settings), **_table(records, len(settings.pressures), len(pairs)),
        block_compliance=uniform(rubbed.pair.compliance.normal), shear_limit=rubbed.shearing.limit, x=surface.x,
        y=surface.y,
        nodes_per_wavelength=surface.nodes_per_wavelength[0],
        refinement=np.array(settings.refinement) * surface.nodes_per_wavelength[0], refinement_area=areas,
        **dict(zip(("area_limit", "area_limit_error", "area_order"), grid_limit(settings.refinement, areas),
                   strict=True)),
        **_presliding(begins, settings.pressures), **_seen(records[shown].maps),
        **_stressed(records[shown], pairs[0], surface, settings.pad.poisson_ratio))


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
    """The SlidingRecord of a task; its maps are kept of the one that is shown."""
    pressure, rubbed, offset, kept = task
    record = slide(shifted(rubbed, offset), pressure, speeds, recorded)
    return record if kept else replace(record, maps=None)


def _presliding(found, pressures):
    """Fields of the product from [Presliding] of each of the ``pressures``, or of none."""
    if not found:
        none = np.empty((len(pressures), 0))
        return {"presliding_displacement": none, "presliding_friction": none,
                "tangential_stiffness": np.zeros(len(pressures))}
    return {"presliding_displacement": [f.displacement for f in found],
            "presliding_friction": [f.shear / pressure for f, pressure in zip(found, pressures, strict=True)],
            "tangential_stiffness": [f.stiffness for f in found]}


def _seen(maps):
    """Fields of the product from the Maps of the run that is shown."""
    share = np.linspace(0.0, 1.0, 101)
    heights = {f"{body}_bearing": [np.quantile(each, 1.0 - share) for each in getattr(maps, f"{body}_height")]
               for body in ("pad", "disc")}
    return {"bearing_share": share, **heights, "contact_pressure": maps.contact_pressure, "pad_wear": maps.pad_wear,
            "disc_wear": maps.disc_wear}


def _stressed(record, rubbed, surface, poisson_ratio):
    """Fields of the product: stress under the new surfaces of the run that is shown, at its middle speed."""
    pressure, middle = record.maps.contact_pressure[0], len(record.limit_at_speed) // 2
    shear = nodal_limit(pressure, rubbed, record.limit_at_speed[middle, 0])
    depths = np.linspace(0.0, _DEEP * surface.shortest_wavelength[1], _DEPTHS)
    equivalent = np.array([von_mises(stress_at(depth, pressure, shear, rubbed.pair.spacing, poisson_ratio))
                           for depth in depths])
    row = np.unravel_index(equivalent.argmax(), equivalent.shape)[1]
    return {"stress_depth": depths, "stress": equivalent[:, row], "stress_largest": equivalent.max(axis=(1, 2)),
            "stress_row": surface.y[row]}


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
