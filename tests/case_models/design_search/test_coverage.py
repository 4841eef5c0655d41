"""What a search leaves open, in numbers that are known: distances in a box, halves, combinations, budgets, ends."""

import numpy as np
import pytest

from pipeline.case_models.design_search.course import ALL, SETTLED, SPENT, Asked, Course, Evaluation
from pipeline.case_models.design_search.coverage import at_ends, combinations_tried, emptiness, not_searched
from tests.case_models.design_search.planted import best, in_rounds, listed, ranged, space

BOX = space(ranged(0.0, 0.0, 1.0), ranged(0.0, 0.0, 1.0, name="b"), listed("abc"))


def test_of_one_brake_at_a_corner_the_opposite_corner_is_farthest():
    far, parts, held = emptiness(BOX, [(0.0, 0.0, 0)])
    assert far == pytest.approx(1.0, abs=0.05) and (parts, held) == (4, 1)


def test_a_grid_leaves_half_of_its_diagonal():
    grid = [(x, y, 0) for x in np.linspace(0, 1, 5) for y in np.linspace(0, 1, 5)]
    far, _, held = emptiness(BOX, grid)
    assert far == pytest.approx(0.125, abs=0.02) and held == 4


def test_lists_have_no_distance():
    assert emptiness(space(listed("ab")), [(0,)]) == (0.0, 1, 1)
    assert combinations_tried(BOX, [(0, 0, 1), (1, 1, 1)]) == 1


def test_ends_of_ranges_are_named():
    assert at_ends(BOX, (0.0, 0.4, 0)) == ["joints.spring"]


def said(course, given, budget=10):
    return " ".join(not_searched(given, course, best(course), budget, 7))


def course(points, ended, starts=1):
    known = {point: Evaluation(growth) for point, growth in points.items()}
    asked = {point: Asked(k % starts, "start", 0) for k, point in enumerate(points)}
    return Course(asked, known, tuple(points)[:starts], tuple(ended), True)


def test_what_was_left_out_is_said():
    text = said(course({(0.1, 0.2, 0): 5.0, (0.9, 0.9, 0): 3.0}, (SPENT, "a"), 2), BOX, budget=2)
    assert "7 settings that are numbers" in text and "2 of the 4 parts" in text
    assert "The budget of 2 brakes was used up: 1 of 2 starts had not ended" in text
    assert "1 of 2 starts ended in other designs, with objectives of 5 1/s" in text
    assert "1 of 3 combinations" in text and "that no better design exists is not shown" in text


def test_a_search_that_ended_early_says_so():
    text = said(course({(0.1, 0.2, 0): 0.0}, (SETTLED,)), BOX)
    assert "ended with the first brake without unstable modes" in text and "budget" not in text


def test_a_search_of_everything_says_so():
    given = space(listed("ab"))
    made, _ = in_rounds(given, lambda point: 2.0 - point[0])
    text = said(made, given)
    assert made.ended == (ALL,) and "Every design of the space was tried" in text and "not shown" not in text
