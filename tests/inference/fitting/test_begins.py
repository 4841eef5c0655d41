"""Begins of candidates: beside the null they change next to nothing, or are as the screen found them."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.inference.fitting import begins
from pipeline.inference.fitting.begins import as_limit, begun_at, begun_beside, directions_like
from pipeline.inference.fitting.calibration import ahead_of, calibrate
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import LATENT_LIMIT, LogNormal, Parameter
from pipeline.inference.problem import Hypothesis
from pipeline.inference.search.score_screen import screen
from tests.inference import resonance


@pytest.fixture(scope="module")
def null():
    problem = resonance.problem(gain=0.9)
    noises = tuple(budget(problem)[run.name] for run in problem.training)
    return problem, calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training,
                              settled=False)


def test_a_candidate_begins_below_the_null(null):
    problem, fit = null
    for begin in (begun_beside(problem, fit, fit, (), (), (resonance.CATALOGUE[0], np.zeros(1))),
                  begun_at(problem, fit, (resonance.CATALOGUE[0], np.zeros(1)))):
        assert begin[0].objective < fit.objective and not begin[1]


@pytest.mark.exact
def test_over_many_periods_a_gain_and_a_stiffness_are_one_direction(null):
    """Beside mass and damping that are not known; larger steps of the stiffness would move it to other phases."""
    problem, fit = null
    anchor = linearised(problem, fit.noises, problem.nominal, fit.latent, fit.runs)
    scores = screen(anchor, [directions_like(problem, anchor, {}, (c, np.zeros(1))) for c in resonance.CATALOGUE],
                    draws=0).score
    assert scores[1] == pytest.approx(scores[0], rel=0.05)


def test_a_limit_begins_at_the_size_of_what_extends_it():
    force = Parameter("dahl@m.force", "N", 2.0, LogNormal(2.0, 0.5), null=0.0)
    shape = Parameter("dahl@m.stiffness", "N/m", 1e4, LogNormal(1e4, 1.0))
    limit = Hypothesis("coulomb", (("coulomb", "m"),), (
        Parameter("coulomb@m.force", "N", 1.0, LogNormal(1.0, 0.4), null=0.0),
        Parameter("coulomb@m.speed", "m/s", 0.1, LogNormal(0.1, 0.4), null=0.0)))
    whole = Hypothesis("dahl", (("dahl", "m"),), (force, shape), extends=("coulomb",))
    start = as_limit(limit, whole, np.array([force.prior.latent(3.0), 1.0]))
    assert limit.values(start) == pytest.approx({"coulomb@m.force": 3.0, "coulomb@m.speed": 0.1})
    assert abs(as_limit(limit, whole, np.array([1e3, 0.0]))).max() == LATENT_LIMIT


def test_a_sign_begins_at_the_stated_values_where_the_null_is_misled():
    problem = resonance.problem(gain=-1.0, mass=1.15)
    noises = tuple(budget(problem)[run.name] for run in problem.training)
    fit = calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training, settled=False)
    assert fit.far
    ahead = ahead_of(problem, fit)
    begin, _ = begun_beside(problem, fit, fit, ahead, (), (resonance.SIGN, np.zeros(1)))
    assert begin.chi_square.sum() < 1.2 * begin.counts.sum() and begin.values["mass"] == pytest.approx(1.15, rel=0.01)


@pytest.mark.parametrize("out", [0.0, LATENT_LIMIT])
def test_values_as_far_out_as_any_may_be_begin_nothing(null, out, monkeypatch):
    """There a candidate begins beside the given values alone, in a large size as well."""
    problem, fit = null
    anchor = linearised(problem, fit.noises, problem.nominal, problem.nominal.nominal, fit.runs)
    away, seen = replace(fit, latent=np.full(len(fit.latent), out)), []
    monkeypatch.setattr(begins, "begun", lambda *asked: seen.extend(asked[3]))
    begun_beside(problem, away, anchor, (), (-1.0, 1.0), (resonance.CATALOGUE[0], np.zeros(1)))
    size = len(fit.latent)
    assert any((start[:size] == out).all() for start in seen) == (out == 0.0)
    assert (max(start[size] for start in seen) == 2.0) == (out > 0)
