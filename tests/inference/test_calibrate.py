"""Calibration: several starts, easier problems on the way, what stops it."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.calibrate import _approached, _easier, calibrate
from pipeline.inference.least_squares import fit
from pipeline.inference.priors import Normal, Parameter
from tests.inference.curves import curve_problem, features


def test_several_starts_find_the_better_of_two_minima():
    parameters = (Parameter("pace", "rad/s", 20.0, Normal(20.0, 10.0)),)
    problem, noises = curve_problem(lambda v, x: np.sin(v["pace"] * x), parameters, lambda x: np.sin(32.0 * x), 0.1)
    alone = fit(problem, noises, problem.nominal, np.array([-0.5]), problem.runs)
    best = calibrate(problem, noises, problem.nominal, [np.array([-0.5]), np.array([1.0])], problem.runs)
    assert best.values["pace"] == pytest.approx(32.0, abs=0.05) and best.objective < 0.1 * alone.objective


@pytest.mark.exact
def test_features_far_off_are_fitted_loosely_first():
    """A prior of 1 against standard deviations of 30 and 6 times 0.05; near ones are fitted at once."""
    whole, noises = features(1.4, 0.05)
    loose = [float(np.mean(noise[0].whiten(np.ones((2, 1))))) for noise, _ in _easier(noises, whole.runs)]
    np.testing.assert_allclose(loose, [1 / 1.5, 1 / 0.3], rtol=1e-12)
    starts = _approached(whole, noises, whole.nominal, [np.zeros(1)], whole.runs, [])
    assert len(starts) == 2 and starts[0] == pytest.approx(1.4, abs=0.05) and starts[1] == 0
    assert len(_approached(whole, noises, whole.nominal, [np.array([1.3])], whole.runs, [])) == 1


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
