"""Fields of the product: rows of brakes, the case first, and of starts."""

from types import SimpleNamespace

import numpy as np

from pipeline.case_models.design_search.course import Asked, Course, Evaluation
from pipeline.case_models.design_search.fields import CASE, Brake, of_best, of_brakes, of_starts
from tests.case_models.design_search.planted import listed, ranged, space

BOX = space(ranged(1.0, 1.0, 3.0), listed(["soft", "hard"]), worth=[4, 0])
POINT = (2.0, 1)


def modes(*growth):
    count = len(growth)
    return SimpleNamespace(unstable_first=np.arange(count), unstable_reduced=np.array(growth) + 9e3j,
                           unstable_operating=np.zeros(count, int), operating_speed=np.array([8.0]))


def rows(own=BOX.own):
    return [Brake(CASE, own, modes(5.0)), Brake("design_search.1", POINT, modes(1.0, 0.5))]


COURSE = Course({POINT: Asked(1, "start", 0)}, {BOX.own: Evaluation(5.0, slopes={0: 2.0}), POINT: Evaluation(1.0)},
                (BOX.own, POINT, (3.0, 1)), ("a", "b", "c"), True)


def test_every_brake_has_a_row():
    found = of_brakes(BOX, COURSE, rows(), "largest")
    assert found["brake"] == ["case", "design_search.1"] and found["role"] == ["case", "start"]
    assert found["written"] == [["1 N/m", "soft"], ["2 N/m", "hard"]] and list(found["value"][1]) == [2.0, 1]
    assert list(found["objective"]) == [5.0, 3.0] and found["unstable"] == [1, 2] and found["start"] == [0, 1]
    assert found["slope"] == ["analytic", "list"] and found["round"] == [-1, 0]


def test_a_case_outside_the_space_belongs_to_no_start():
    outside = space(ranged(0.5, 1.0, 3.0), listed(["soft", "hard"]))
    found = of_brakes(outside, COURSE, rows(None), "sum")
    assert found["start"] == [-1, 1] and found["value"][0] == [0.5, 0.0] and list(found["growth"]) == [5.0, 1.5]


def test_starts_name_their_brakes():
    assert of_starts(COURSE, rows()) == {"start_first": [0, 1, -1], "start_ended": ["a", "b", "c"],
                                         "start_best": [0, 1, -1]}


def test_the_best_has_costs_and_growth():
    costly = space(*BOX.values)
    costly.columns["price"] = ("EUR", np.array([4.0, 1.0]))
    found = of_best(costly, rows()[1])
    assert found["cost_name"] == ["price"] and found["best_cost"] == [3.0] and list(found["growth_after"]) == [1.0]
    assert of_best(costly, Brake(CASE, None, modes()))["best_cost"] == [0.0]
