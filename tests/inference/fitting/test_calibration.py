"""Calibration: several starts, easier problems on the way, what stops it."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.fitting import calibration
from pipeline.inference.fitting.calibration import (
    Calibration,
    _distinct,
    _under,
    ahead_of,
    begun,
    calibrate,
    paired_anew,
)
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from pipeline.inference.rules import DEFAULTS
from tests.inference import resonance
from tests.inference.curves import curve_problem, either_of_two, features


def test_several_starts_find_the_better_of_two_minima():
    parameters = (Parameter("pace", "rad/s", 20.0, Normal(20.0, 10.0)),)
    problem, noises = curve_problem(lambda v, x: np.sin(v["pace"] * x), parameters, lambda x: np.sin(32.0 * x), 0.1)
    alone = fit(problem, noises, problem.nominal, np.array([-0.5]), problem.runs)
    best = calibrate(problem, noises, problem.nominal, [np.array([-0.5]), np.array([1.0])], problem.runs)
    assert best.values["pace"] == pytest.approx(32.0, abs=0.05) and best.objective < 0.1 * alone.objective


@pytest.mark.parametrize("mass", [0.8, 2.2])
def test_a_fit_that_ends_far_off_is_tried_over_other_horizons(monkeypatch, mass):
    """Over 64 periods of a mass that is thought to be 1.2 kg many others explain next to nothing, each at its own."""
    problem = resonance.problem(mass=mass)
    noises = tuple(budget(problem)[run.name] for run in problem.training)

    def found():
        return calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training, settled=False)

    told = found()
    assert told.converged and told.values["mass"] == pytest.approx(mass, rel=1e-3)
    monkeypatch.setattr(calibration, "_OTHER_HORIZONS", ())
    assert found().objective > 1000 * told.objective


@pytest.mark.parametrize("threshold", [True, False])
def test_a_threshold_far_from_its_start_is_found_from_part_to_part(threshold):
    """From a moment on a tone is thrice as fast: 19 cycles slip by the end of the run, none before that moment."""
    def tone(values, grid):
        return np.sin(values["pace"] * grid + 60 * np.maximum(grid - values.get("from", np.inf), 0))[None]

    grid = np.arange(2500) / 1000
    seen = tone({"pace": 30.4, "from": 0.55}, grid) + 0.01 * np.random.default_rng(1).standard_normal(len(grid))
    pace = Parameter("pace", "rad/s", 30.0, Normal(30.0, 1.0))
    late = Parameter("from", "s", 1.1, Normal(1.1, 0.3), null=10.0, threshold=threshold)
    problem = Problem((Observed("a", {}, ("y",), seen, 1000.0, noise_std=np.array([0.01])),),
                      lambda hypothesis, values, run: tone(values, grid[:run.samples.shape[1]]),
                      Hypothesis("nominal", (), (pace,)))
    noises = (budget(problem)["a"],)
    null = fit(problem, noises, problem.nominal, np.zeros(1), problem.runs)
    found = begun(problem, noises, problem.nominal.joined(Hypothesis("faster", (("faster", "here"),), (late,))),
                  [np.append(null.latent, 0.0)], problem.runs, [null], ahead_of(problem, null))
    assert (found.objective < 1.2 * len(grid)) is threshold
    assert not threshold or found.values["from"] == pytest.approx(0.55, abs=1e-3)


@pytest.mark.exact
def test_starts_that_predict_the_same_are_one():
    near, same, far, broken = np.full(4, 1.0), np.full(4, 1.1), np.full(4, 3.0), None
    assert _distinct([far, broken, same, near]) == [3, 0]
    assert _distinct([broken, broken]) == [0], "why none can be predicted is told by trying one"


@pytest.mark.exact
def test_features_under_other_standard_deviations():
    """The Fit of features under larger ones is the one that they would have given, residuals and Jacobians."""
    whole, noises = features(1.4, 0.05)
    looser = features(1.4, 0.3)[1]
    near = linearised(whole, noises, whole.nominal, np.array([0.3]), whole.runs)
    given = linearised(whole, looser, whole.nominal, np.array([0.3]), whole.runs)
    for state in (_under(near, noises, 6.0), _under(_under(near, noises, 30.0), noises, 6.0)):
        np.testing.assert_allclose(np.concatenate(state.residuals), np.concatenate(given.residuals), rtol=1e-12)
        np.testing.assert_allclose(np.vstack(state.jacobians), np.vstack(given.jacobians), rtol=1e-6)


def test_features_far_off_are_fitted_from_the_start_that_is_best_loosely():
    """Of x and x^2: from -1 x^2 alone is met, at -1.4."""
    whole, noises = features(1.4, 0.05)
    for starts in ([-1.0, 0.1], [0.1, -1.0]):
        found = begun(whole, noises, whole.nominal, [np.array([x]) for x in starts], whole.runs)
        assert found.latent == pytest.approx(1.4, abs=0.05)
    assert begun(whole, noises, whole.nominal, [np.array([1.3])], whole.runs).latent == pytest.approx(1.4, abs=0.05)


def test_features_that_end_far_off_are_tried_on_another_way(monkeypatch):
    """From -1, without larger standard deviations, x stays below 0, where x^2 alone is met."""
    monkeypatch.setattr(calibration, "_LOOSE", (1.0,))
    whole, noises = features(1.4, 0.05)
    asked = whole, noises, whole.nominal, [np.array([-1.0])], whole.runs
    assert calibrate(*asked, settled=False).latent == pytest.approx(1.4, abs=0.05)
    monkeypatch.setattr(calibration, "_LOOSER", (1.0,))
    assert calibrate(*asked, settled=False).latent < 0


def test_a_feature_paired_wrongly_is_paired_anew_where_it_drags_a_value_beyond_its_prior():
    """A peak at 14.5 where all is 0.72 of what was stated: 20 became it, not 10 at 6.8 standard deviations."""
    whole, noises = either_of_two(14.5, -2.8, 0.01)
    dragged = np.array([-2.8, 6.76, 0.0])
    alone = fit(whole, noises, whole.nominal, dragged, whole.runs)
    found = calibrate(whole, noises, whole.nominal, [dragged], whole.runs)
    assert alone.converged and alone.values["low"] > 6
    assert found.values["high"] == pytest.approx(14.5 / 0.72 - 20, abs=0.05) and abs(found.values["low"]) < 1e-3
    assert found.objective < 0.2 * alone.objective


def test_values_that_no_other_start_betters_stay_where_they_are():
    whole, noises = features(6.0, 0.05)
    found = fit(whole, noises, whole.nominal, np.array([5.5]), whole.runs)
    assert found.latent == pytest.approx(6.0, abs=0.05)
    assert paired_anew(whole, found, DEFAULTS.calibration) is found


def test_a_start_where_the_model_fails_is_passed_over_and_told_where_all_fail():
    def root(values, grid):
        if values["a"] < 0:
            raise ConvergenceError("model", "a root", "none")
        return np.sqrt(values["a"]) * grid

    problem, noises = curve_problem(root, (Parameter("a", "1", 1.0, Normal(1.0, 1.0)),), lambda x: 1.5 * x, 0.1)
    good, bad = np.array([0.0]), np.array([-2.0])
    best = calibrate(problem, noises, problem.nominal, [bad, good], problem.runs)
    assert best.values["a"] == pytest.approx(2.25, abs=0.2)
    with pytest.raises(ConvergenceError, match="calibration of nominal: .*model: expected a root, found none"):
        calibrate(problem, noises, problem.nominal, [bad], problem.runs)


def test_a_model_that_cannot_settle_is_not_called_converged():
    problem, noises = curve_problem(lambda v, x: v["a"] * x + 1e3 * (v["a"] != 1.0),
                                    (Parameter("a", "1", 1.0, Normal(1.0, 1.0)),), lambda x: 9 * x, 0.01)
    with pytest.raises(ConvergenceError, match="not converged after"):
        calibrate(problem, noises, problem.nominal, [np.zeros(1)], problem.runs)


def test_a_null_that_ended_early_goes_on():
    parameters = (Parameter("rate", "1/s", 3.0, Normal(3.0, 2.0)), Parameter("size", "m", 1.0, Normal(1.0, 1.0)))
    problem, noises = curve_problem(lambda v, x: v["size"] * np.exp(-v["rate"] * x), parameters,
                                    lambda x: 2.5 * np.exp(-6.0 * x), 0.01)
    late = fit(problem, noises, problem.nominal, problem.nominal.nominal, problem.runs)
    early = fit(problem, noises, problem.nominal, problem.nominal.nominal, problem.runs, iterations=1)
    begun = Calibration(problem, {}, replace(early, converged=False))
    assert late.converged and early.objective > late.objective + 10
    assert begun.gone_on(0) == begun
    told = begun.gone_on(2).null
    assert told.converged and told.objective == pytest.approx(late.objective, abs=0.01)
