"""Stage design_search: search over a declared design space for a brake that squeals less, with a budget.

    design_search:
      budget: 40
      starts: 4
      space:
        structure.joints.finger_stiffness: {from: 100 MN/m, to: 800 MN/m, log: true}
        structure.pad.lining_thickness: {from: 8 mm, to: 12 mm}

Each brake is the case with these settings changed, computed to its complex modes and their derivatives. The best one is
a variant of the stage countermeasures.
"""

import hashlib
import json
from typing import Literal

import numpy as np

from pipeline.case_models.countermeasures.declared import OF_MODES
from pipeline.case_models.design_search.best import as_text, fragment
from pipeline.case_models.design_search.course import Rules
from pipeline.case_models.design_search.coverage import not_searched
from pipeline.case_models.design_search.declared import Range, at_ends, check_space, numbers, stated
from pipeline.case_models.design_search.fields import CASE, Brake, of_best, of_brakes, of_starts
from pipeline.case_models.design_search.multistart import first_points, search
from pipeline.case_models.design_search.objective import (
    LARGEST,
    SUM,
    at_operating_points,
    evaluation,
    growth_of,
)
from pipeline.case_models.design_search.space import space_of
from pipeline.case_models.design_search.table import csv_table
from pipeline.case_models.operating_points import MODES_ALONE
from pipeline.contract import Context, Section, Variants, option, stage
from pipeline.products import ComplexModes, DesignSearch, Sensitivities

#: what every brake of a search is computed with
_PLAIN = {**MODES_ALONE, "probability.draws": 0, "sensitivities.modes": None, "sensitivities.differences": [],
          "sensitivities.remedies": 0}
_FOLDER = "design_search"


class Settings(Section):
    """Which settings may change how far, and how many brakes may be computed to find out."""

    space: dict[str, Range] = option({}, "settings that are searched, by name with their stage: {from:, to:} or"
                                         " {values: [...]}; none = no search")
    budget: int = option(40, "brakes that may be computed, beside the case", ge=1)
    starts: int = option(4, "searches, the first from the case where the space holds it, the others spread over the"
                            " space", ge=1)
    objective: Literal[LARGEST, SUM] = option(LARGEST, "largest growth rate of any unstable mode at any operating"
                                                       " point, or the sum of those of all unstable modes")
    weight: dict[str, float] = option({}, "growth rate, in 1/s, that a unit of a column of costs is worth")
    step: float = option(0.02, "step of differences, where no derivative is known, as a share of the range", gt=0,
                         le=0.5)
    tolerance: float = option(1e-3, "a start ends when a step lowers the objective by less than this share of that of"
                                    " the case", gt=0, lt=1)
    seed: int = option(0, "seed of the starts", ge=0)


def _further(sections, given, computed):
    """{name: changes} of all brakes that the search asks for so far."""
    settings = sections["design_search"]
    if not settings.space:
        return {}
    space = space_of(settings, stated(sections))
    course = _walked(settings, space, given["modes"], given["sensitivities"], computed)
    return {_name(space, point): {**space.changes(point), **_PLAIN} for point in course.asked}


def _name(space, point):
    """Folder of a brake: the same values stand in the same one, whatever the rest of the search."""
    written = json.dumps(space.changes(point), sort_keys=True, default=str)
    return f"{_FOLDER}.{hashlib.sha256(written.encode()).hexdigest()[:12]}"


def _walked(settings, space, modes, sensitivities, computed):
    """The Course of the search by the brakes that are computed."""
    done = {}

    def evaluate(point):
        if point not in done:
            found = {"varied_modes": modes, "varied": sensitivities} if point == space.own else \
                computed(_name(space, point), {**space.changes(point), **_PLAIN})
            done[point] = found and evaluation(space, point, found["varied_modes"], found["varied"],
                                               settings.objective)
        return done[point]

    firsts = first_points(space, settings.starts, settings.seed)
    scale = growth_of(modes, settings.objective) or 1.0
    return search(space, firsts, evaluate, Rules(settings.budget, settings.step, settings.tolerance, scale))


def _companions(product, case):
    if not len(product.parameter):
        return {}
    files = {"design_search.csv": csv_table(product)}
    return {**files, "best_design.yaml": fragment(product, case.name)} if product.best > 0 else files


@stage(companions=_companions, check=check_space, variants=lambda sections: {}, further=_further,
       only_checked=lambda sections: at_ends(sections["design_search"]))
def design_search(modes: ComplexModes, sensitivities: Sensitivities, varied_modes: Variants[ComplexModes],
                  varied: Variants[Sensitivities], settings: Settings, context: Context) -> DesignSearch:
    """Search a declared design space for the smallest growth of unstable modes, from several starts.

    Method:
    Up to {budget} brakes of the declared space were computed to their complex modes in the reduced model. From
    {starts} starts, the first of them the case, the {objective} growth rate and weighted costs were minimised by
    L-BFGS-B within the declared ranges; slopes are those by left and right vectors, of values that move the mesh
    differences over {step} of the range. Every other value of a list was tried where a start had ended.
    """
    if not settings.space:
        return _product(settings, modes, (), {})
    card = context.case
    every = {f"{stage}.{key}": (value, card.units[stage][key]) for stage, rows in card.settings.items()
             for key, value in rows.items()}
    space = space_of(settings, every)
    course = _walked(settings, space, modes, sensitivities,
                     lambda name, _: {"varied_modes": varied_modes[name], "varied": varied[name]})
    names = [_name(space, point) for point in course.asked]
    rows = [Brake(CASE, space.own, modes), *map(Brake, names, course.asked, map(varied_modes.get, names))]
    tried = of_brakes(space, course, rows, settings.objective)
    best = int(np.argmin(tried["objective"]))       # the case, the first, where none is lower
    outside = set(numbers({k: v for k, v in every.items() if k.partition(".")[0] in OF_MODES})) - set(settings.space)
    return _product(settings, modes, space.values, {
        **tried, "best": best, "case_inside": int(space.own is not None), **of_starts(course, rows),
        **of_best(space, rows[best]),
        "not_searched": not_searched(space, course, rows[best].point, settings.budget, len(outside))})


def _product(settings, modes, values, given):
    """The product; without ``values``, one of a case that searches nothing."""
    count, (growth, number) = len(values), at_operating_points(modes)
    none = {name: [] for name in ("brake", "start", "round", "role", "unstable", "growth", "cost", "objective",
                                  "start_first", "start_best", "start_ended", "cost_name", "cost_unit", "best_cost",
                                  "slope", "case_value", "not_searched")}
    return DesignSearch(**{
        **none, "value": np.zeros((0, count)), "written": np.zeros((0, count), str), "best": -1, "case_inside": 1,
        "growth_after": growth, "unstable_after": number, "parameter": [v.name for v in values],
        "unit": ["" if v.unit == "1" or v.choices else v.unit for v in values],
        "lower": [v.low for v in values], "upper": [v.high for v in values],
        "choices": [" | ".join(map(as_text, v.choices)) for v in values], "kind": settings.objective,
        "budget": settings.budget, "pressure": modes.operating_pressure, "speed": modes.operating_speed,
        "growth_before": growth, "unstable_before": number, "computed": max(len(given.get("brake", ())) - 1, 0),
        **given})
