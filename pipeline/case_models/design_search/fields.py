"""Fields of the product DesignSearch, of the brakes that a search tried and of its starts."""

from dataclasses import dataclass

import numpy as np

from pipeline.case_models.design_search.best import as_text
from pipeline.case_models.design_search.objective import at_operating_points, growth_of, growth_rates

CASE = "case"


@dataclass(frozen=True)
class Brake:
    """One that was tried: its ``folder`` in variants/, its ``point`` (of the case outside the space None) and its
    product ComplexModes."""

    folder: str
    point: tuple | None
    modes: object


def of_brakes(space, course, brakes, which):
    """Fields over the ``brakes`` [Brake] of a Course, the case first; ``which``: growth as of ``growth_of``."""
    asked = [course.asked.get(brake.point) for brake in brakes]
    growth = [growth_of(brake.modes, which) for brake in brakes]
    cost = [0.0 if brake.point is None else space.cost(brake.point) for brake in brakes]
    case = [as_text(value.case[1]) for value in space.values]
    return {
        "brake": [brake.folder for brake in brakes], "case_value": case,
        "value": [[value.case[0] for value in space.values] if b.point is None else b.point for b in brakes],
        "written": [case if b.point is None else list(map(as_text, space.changes(b.point).values())) for b in brakes],
        "start": [(-1 if space.own is None else 0) if each is None else each.start for each in asked],
        "round": [-1 if each is None else each.round for each in asked],
        "role": [CASE if each is None else each.role for each in asked],
        "unstable": [len(growth_rates(brake.modes)[0]) for brake in brakes],
        "growth": growth, "cost": cost, "objective": np.add(growth, cost),
        "slope": [_slope(value, k, course) for k, value in enumerate(space.values)]}


def _slope(value, k, course):
    """How the change of the growth by a value of the space is known."""
    if value.choices:
        return "list"
    return "analytic" if any(k in each.slopes for each in course.known.values()) else "differences"


def of_starts(course, brakes):
    """Fields over the starts of a Course; ``brakes`` [Brake] as of ``of_brakes``."""
    index = {brake.point: k for k, brake in enumerate(brakes)}
    lowest = [course.lowest(start) for start in range(len(course.firsts))]
    return {"start_first": [index.get(point, -1) for point in course.firsts], "start_ended": list(course.ended),
            "start_best": [-1 if point is None else index[point] for point in lowest]}


def of_best(space, brake):
    """Fields of the best design, a Brake."""
    costs = {name: (unit, 0.0) for name, (unit, _) in space.columns.items()} if brake.point is None else \
        space.costs(brake.point)
    growth, number = at_operating_points(brake.modes)
    return {"cost_name": list(costs), "cost_unit": [unit for unit, _ in costs.values()],
            "best_cost": [cost for _, cost in costs.values()], "growth_after": growth, "unstable_after": number}
