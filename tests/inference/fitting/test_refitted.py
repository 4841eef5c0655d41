"""Fits of candidates from their begin to their end: given up, failed on the way, the best of several."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.fitting import refitted
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.fitting.refitted import NOT_BEGUN, Refitted, advanced, finished, leader, lowest
from pipeline.inference.rules import DEFAULTS
from tests.inference.oscillator import bench


@pytest.fixture(scope="module")
def begun():
    """(Problem, Fit at its nominal values)."""
    problem = bench(5, 0.1, stiffness=430.0)
    noises = tuple(budget(problem)[run.name] for run in problem.training)
    start = np.zeros(len(problem.nominal.parameters))
    return problem, linearised(problem, noises, problem.nominal, start, problem.training)


def failing(*_, **__):
    raise ConvergenceError("time stepping at t = 0.4 s", "a force that settles", "none", "take a shorter step")


def test_a_candidate_whose_forward_model_fails_on_its_way_is_told_and_not_judged(begun, monkeypatch):
    problem, begin = begun
    for name in ("continued", "iterated"):
        monkeypatch.setattr(refitted, name, failing)
    told = finished(problem, begin, np.inf, DEFAULTS, begin)
    assert told.fit is begin and told.null is None and "a force that settles" in told.failure
    assert advanced(problem, np.inf, begin) is begin


def test_a_fit_goes_on_to_its_end_unless_it_cannot_come_near_the_others(begun):
    problem, begin = begun
    whole = finished(problem, begin, np.inf, DEFAULTS, begin)
    assert whole.fit.converged and not whole.failure and whole.fit.objective < 0.9 * begin.objective
    assert whole.null.objective == pytest.approx(whole.fit.objective, rel=1e-6), "the same hypothesis, from its optimum"
    given_up = finished(problem, begin, 1e-3 * whole.fit.objective, DEFAULTS, begin)
    assert given_up.failure == "its fit was given up, far from what others reach or would matter"
    assert given_up.fit.evaluations <= whole.fit.evaluations


@pytest.mark.exact
def test_the_best_of_several_is_kept():
    low, high = (Refitted(SimpleNamespace(objective=objective), None, "") for objective in (1.0, 2.0))
    assert leader({0: high, 1: low, 2: NOT_BEGUN}) == 1 and leader({2: NOT_BEGUN}) is None
    assert lowest({0: high, 1: low}, {0: low, 1: high, 2: NOT_BEGUN}) == {0: low, 1: low, 2: NOT_BEGUN}
    assert lowest({0: NOT_BEGUN}, {0: high}) == {0: high}
