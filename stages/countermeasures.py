"""Stage countermeasures: a brake beside declared variants of it, mode by mode, and how likely each squeals.

    countermeasures:
      variants:
        shim:
          change: {structure.pad.backplate_loss_factor: 0.05}
          cost: {mass: 0.1 kg}

Each variant is the case with these settings changed, computed to its complex modes and its probability of squeal. The
best design of the stage design_search is one more of them.
"""

from functools import partial

import numpy as np

from pipeline.case_models.countermeasures.declared import (
    PREFIX,
    Variant,
    changes,
    check_declared,
    check_different,
    costs,
    in_words,
)
from pipeline.case_models.countermeasures.matching import compared_modes
from pipeline.case_models.countermeasures.nearby_modes import Brake
from pipeline.case_models.countermeasures.squeal_rates import changes_in_bands, changes_of_rates, paired
from pipeline.case_models.countermeasures.table import csv_table
from pipeline.case_models.design_search.best import check_beside, searched
from pipeline.case_models.operating_points import StabilitySettings
from pipeline.contract import Context, Section, Variants, option, stage
from pipeline.products import (
    ComplexModes,
    Convergence,
    Countermeasures,
    DesignSearch,
    Effects,
    FrictionMap,
    Probability,
    ReducedModel,
)


class Settings(Section):
    """Variants that are compared with the case."""

    variants: dict[str, Variant] = option({}, "countermeasures by name")
    probability: bool = option(True, "how likely squeal is in each variant; false: modes alone")
    draws: int | None = option(None, "draws of each variant; none = those of the case, draw by draw", ge=1)
    cost: dict[str, str | float] = option({}, "of this case where 'brakechain compare' takes it for a variant")
    note: str = option("", "what it is as a variant; none = its title")


def _check(sections):
    check_declared(sections["countermeasures"].variants, tuple(sections))
    check_beside(sections)


def _variants(sections):
    return changes(sections["countermeasures"].variants, _drawn(sections))


def _further(sections, given, computed):
    """The best design of a search as one more variant."""
    return changes(searched(given["search"]), _drawn(sections))


def _drawn(sections):
    """What all variants change: their draws."""
    settings, more = sections["countermeasures"], {}
    if not settings.probability or not sections["probability"].draws:
        more = {"probability.draws": 0}
    elif settings.draws is not None:
        more = {"probability.draws": settings.draws}
    return more


def _companions(product, case):
    return {"countermeasures.csv": csv_table(product)} if len(product.variant) else {}


@stage(companions=_companions, check=_check, variants=_variants, further=_further, check_variants=check_different)
def countermeasures(modes: ComplexModes, model: ReducedModel, friction_map: FrictionMap | None,
                    effects: Effects | None, convergence: Convergence | None, probability: Probability,
                    search: DesignSearch | None, varied_modes: Variants[ComplexModes],
                    varied_models: Variants[ReducedModel], varied_maps: Variants[FrictionMap],
                    varied_effects: Variants[Effects], varied_probabilities: Variants[Probability],
                    settings: Settings, context: Context) -> Countermeasures:
    """Compare unstable modes and the probability of squeal with those of declared variants of the brake.

    Roots of variants are those of the reduced model, moved by what the full matrices move the root of the case.

    Method:
    Every declared variant was computed to its complex modes and, by the draws of the case, to its probability of squeal
    (probability: {probability}). Unstable modes before and after were matched among all modes, stable ones too, by the
    modal assurance criterion on the surface nodes that both models have. A growth rate counts as changed beyond what
    refined models move it by; changes of probabilities carry 95 % intervals (Newcombe).
    """
    base, names = Brake(modes, model, friction_map, effects), list(varied_modes)
    others = [Brake(varied_modes[n], varied_models[n], varied_maps.get(n), varied_effects[n]) for n in names]
    tasks = [(other, operating) for other in others for operating in range(len(modes.operating_speed))]
    compare = partial(_compared, base, convergence, StabilitySettings.of(modes).neutral)
    rows, points = context.map(compare, tasks, "operating points"), len(modes.operating_speed)
    found = [sum(rows[k:k + points], []) for k in range(0, len(rows), points)]
    known = {**settings.variants, **searched(search)}
    declared = {name: known[name] for name in (n.removeprefix(PREFIX) for n in names)}
    return Countermeasures(
        variant=list(declared), note=[v.note for v in declared.values()],
        change=[in_words(v.change) for v in declared.values()], **_costs(declared), pressure=modes.operating_pressure,
        speed=modes.operating_speed, **_modes(found), squeal_from=modes.squeal_from,
        **_rates(probability if settings.probability else None, [varied_probabilities[n] for n in names]))


def _compared(base, convergence, neutral, task):
    other, operating = task
    return compared_modes(base, other, convergence, neutral, operating)


def _costs(declared):
    """Fields of the costs of the declared variants."""
    columns, names = costs(declared), list(declared)
    number = [[numbers.get(name, 0.0) for _, _, numbers in columns] for name in names]
    known = [[int(name in numbers) for _, _, numbers in columns] for name in names]
    shape = len(names), len(columns)
    return {"cost_name": [c[0] for c in columns], "cost_unit": [c[1] for c in columns],
            "cost": np.reshape(number, shape).astype(float), "cost_known": np.reshape(known, shape).astype(int)}


def _modes(found):
    """Fields of the modes of all variants, ``found`` [[ComparedMode]]."""
    rows = [(k, row) for k, modes in enumerate(found) for row in modes]
    known = {name: [getattr(row, name) is not None for _, row in rows] for name in ("before", "after")}
    return {
        "mode_variant": [k for k, _ in rows], "mode_operating": [row.operating for _, row in rows],
        **{name: np.array([getattr(row, name) or 0 for _, row in rows], complex) for name in known},
        **{f"{name}_known": np.array(there, int) for name, there in known.items()},
        "mac": [row.mac for _, row in rows], "rival_mac": [row.rival for _, row in rows],
        "clear": np.array([row.clear for _, row in rows], int), "state": [row.state for _, row in rows],
        "error": [row.error for _, row in rows]}


def _rates(base, others):
    """Fields of the probabilities; none where the case has no draws."""
    there = base is not None and len(base.value) > 0
    points, draws = (len(base.speed), len(base.value)) if there else (0, 0)
    made = [changes_of_rates(base, other) for other in others] if there else []
    change = np.reshape([c for c, _ in made], (len(others), points + 1)) if there else np.zeros((len(others), 1))
    ends = np.reshape([e for _, e in made], (len(others), points + 1, 2)) if there else np.zeros((len(others), 1, 2))
    of_others = {
        "variant_draws": [len(other.value) if there else 0 for other in others],
        "paired": [int(there and paired(base, other)) for other in others],
        "variant_probability": np.reshape([o.probability for o in others if there], (len(others), points)),
        "variant_interval": np.reshape([o.interval for o in others if there], (len(others), points, 2)),
        "variant_overall": [float(o.overall) if there else 0.0 for o in others],
        "variant_overall_interval": np.reshape([o.overall_interval if there else (0.0, 0.0) for o in others],
                                               (len(others), 2))}
    return {
        **of_others, "draws": draws, "sampled_pressure": base.pressure if there else [],
        "sampled_speed": base.speed if there else [], "probability": base.probability if there else [],
        "interval": base.interval if there else np.zeros((0, 2)), "overall": base.overall if there else 0.0,
        "overall_interval": base.overall_interval if there else [0.0, 0.0],
        "probability_change": change[:, :-1], "change_interval": ends[:, :-1],
        "overall_change": change[:, -1], "overall_change_interval": ends[:, -1],
        **_bands(base if there else None, others)}


def _bands(base, others):
    """Fields of the 1/3 octaves; none without draws."""
    if base is None:
        return {"band": [], "band_probability": [], "variant_band_probability": np.zeros((len(others), 0)),
                "band_change_interval": np.zeros((len(others), 0, 2))}
    made, count = [changes_in_bands(base, other) for other in others], len(base.band)
    return {"band": base.band, "band_probability": base.band_any,
            "variant_band_probability": np.reshape([share for share, _ in made], (len(others), count)),
            "band_change_interval": np.reshape([ends for _, ends in made], (len(others), count, 2))}
