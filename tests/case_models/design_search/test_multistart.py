"""Searches for optima that are known: a planted remedy, a damper, two minima, lists; budgets and rounds."""

import numpy as np
import pytest

from pipeline.case_models.design_search.course import ALL, SETTLED, SPENT
from pipeline.case_models.design_search.multistart import DIFFERENCE, FIRST, OTHER, first_points
from tests.case_models.design_search.planted import (
    best,
    flutter_boundary,
    flutter_root,
    in_rounds,
    listed,
    ranged,
    space,
)


def flutter(point):
    return flutter_root(point[0]).real


def relaxing(point):
    """A loss time t dissipates as t / (1 + t^2): most at 1."""
    return 10.0 - 8.0 * point[0] / (1 + point[0] ** 2)


def two_wells(point):
    return 10.0 - 3.0 * np.exp(-((point[0] - 0.2) / 0.15) ** 2) - 6.0 * np.exp(-((point[0] - 0.8) / 0.15) ** 2)


def test_a_planted_remedy_is_found():
    """Flutter of two masses ends beyond a known spring: the best design lies there, the case does not."""
    course, _ = in_rounds(space(ranged(1.05, 0.95, 1.6)), flutter)
    assert flutter((1.05,)) > 0.01 and best(course)[0] >= flutter_boundary() > 1.05
    assert course.known[best(course)].growth == 0 and SETTLED in course.ended


def test_a_closed_form_says_where_flutter_ends():
    end = flutter_boundary()
    assert flutter((end * 0.999,)) > 0 > flutter((end * 1.001,))


def test_where_change_costs_the_cheapest_remedy_is_found():
    """Growth falls faster than costs rise until flutter ends: the optimum is that kink."""
    given = space(ranged(1.05, 0.95, 1.6), worth=[0.02])
    course, _ = in_rounds(given, flutter, budget=60, tolerance=1e-4, step=1e-3)
    assert best(course)[0] == pytest.approx(flutter_boundary(), rel=5e-3)
    assert all(given.cost(best(course)) <= given.cost(p) + 1e-6 for p, e in course.known.items() if e.growth == 0)


@pytest.mark.parametrize("analytic", [True, False], ids=["slopes", "differences"])
def test_a_smooth_optimum_is_met(analytic):
    """By slopes that are given, and by differences: the damper that dissipates most."""
    given = space(ranged(0.3, 0.1, 10.0, log=True))

    def slopes(point):
        t = point[0]
        return {0: -8.0 * (1 - t**2) / (1 + t**2) ** 2 * given.values[0].scale(t)}

    course, _ = in_rounds(given, relaxing, starts=1, slopes=slopes if analytic else None, tolerance=1e-6, step=1e-3)
    assert best(course)[0] == pytest.approx(1.0, abs=0.02) and course.known[best(course)].growth < 6.001
    assert (DIFFERENCE in {each.role for each in course.asked.values()}) != analytic


def test_other_starts_find_what_the_case_does_not_lead_to():
    given = space(ranged(0.15, 0.0, 1.0))
    alone, _ = in_rounds(given, two_wells, starts=1)
    assert best(alone)[0] == pytest.approx(0.2, abs=0.02)
    course, _ = in_rounds(given, two_wells, starts=4)
    assert best(course)[0] == pytest.approx(0.8, abs=0.02)
    assert course.lowest(0)[0] == pytest.approx(0.2, abs=0.02), "the start at the case ended where it did alone"


def test_lists_that_fit_the_budget_are_tried_whole():
    given = space(listed("abc"), listed("xyz", name="joints.other"))
    course, rounds = in_rounds(given, lambda point: 1.0 + abs(point[0] - 2) + abs(point[1] - 1), budget=9)
    assert len(course.known) == 9 and rounds == [8] and best(course) == (2, 1) and course.ended == (ALL,)


def test_a_list_beside_a_range_is_exchanged():
    given = space(ranged(0.15, 0.0, 1.0), listed(["hard", "soft"]))
    course, _ = in_rounds(given, lambda point: two_wells(point) - 2.0 * point[1], starts=1)
    assert best(course)[1] == 1 and OTHER in {each.role for each in course.asked.values()}


@pytest.mark.parametrize("budget", [4, 7, 13])
def test_no_more_brakes_are_asked_for_than_the_budget_holds(budget):
    course, rounds = in_rounds(space(ranged(0.15, 0.0, 1.0), ranged(0.5, 0.0, 1.0, name="b")),
                               lambda point: two_wells(point) + point[1], budget=budget)
    assert len(course.asked) == sum(rounds) == budget and SPENT in course.ended


def test_brakes_of_one_round_are_independent():
    """All starts advance at once: the first round holds every start but the case, which is known."""
    course, rounds = in_rounds(space(ranged(0.15, 0.0, 1.0)), two_wells, starts=4)
    first = [each for each in course.asked.values() if each.round == 0]
    assert sum(each.role == FIRST for each in first) == 3 and rounds[0] == len(first)


def test_starts_spread_over_the_space_and_are_the_same_for_a_seed():
    given = space(ranged(2.0, 0.0, 1.0), listed("abc", name="b"))
    points = first_points(given, 8, seed=3)
    assert given.own is None and len(set(points)) == 8 and points == first_points(given, 8, seed=3)
    assert points != first_points(given, 8, seed=4)
    numbers = np.array([point[0] for point in points])
    assert numbers.min() < 0.3 and numbers.max() > 0.7 and {point[1] for point in points} == {0, 1, 2}


def test_a_list_has_no_more_starts_than_values():
    assert sorted(first_points(space(listed("ab")), 5, seed=0)) == [(0,), (1,)]


@pytest.mark.parametrize("worth, asked", [([0.02], 0), ([-0.02], 5)], ids=["costs", "saves"])
def test_a_stable_case_is_left_unless_change_saves(worth, asked):
    """Nothing is better than no growth at no cost; where change saves, cheaper brakes are sought."""
    course, _ = in_rounds(space(ranged(1.5, 1.4, 1.6), worth=worth), flutter, budget=5)
    assert len(course.asked) <= asked and bool(course.asked) == bool(asked)
    assert (SETTLED in course.ended) == (not asked)
