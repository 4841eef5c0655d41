"""A hypothesis at one point: closed forms of linear problems, what is refused, columns that a run does not feel."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.inference.fitting.fit_state import _information, from_prior_mean, linearised, orthogonal
from pipeline.inference.fitting.least_squares import TOLERANCE, fit
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Problem
from tests.inference import linear
from tests.inference.curves import curve_problem, noises_of


@pytest.mark.exact
def test_weights_of_runs_scale_their_information():
    whole, noise, _, tables = linear.problem((2,))
    found = fit(whole, noises_of(whole, noise), whole.nominal, np.zeros(2), whole.training)
    design = [linear.dense(Problem((run,), whole.predict, whole.nominal), whole.nominal, tables)[1]
              for run in whole.training]
    expected = np.linalg.inv(np.eye(2) + sum(w * d.T @ d for w, d in zip((1.0, 0.5, 0.1), design, strict=True)))
    np.testing.assert_allclose(found.covariance((1.0, 0.5, 0.1)), expected, rtol=1e-6)


@pytest.mark.exact
def test_the_orthogonal_residual_is_that_of_generalised_least_squares():
    generator = np.random.default_rng(0)
    jacobian, residual, root = (generator.standard_normal(s) for s in ((40, 3), 40, (3, 3)))
    prior = root @ root.T + np.eye(3)
    expected = np.linalg.solve(np.eye(40) + jacobian @ prior @ jacobian.T, residual)
    np.testing.assert_allclose(orthogonal(residual, jacobian, np.linalg.inv(prior)), expected, atol=1e-12)


@pytest.mark.exact
def test_at_the_optimum_the_residual_is_the_orthogonal_one_of_the_prior_mean():
    whole, noise, _, _ = linear.problem((3,), truth={"nominal_0": 0.7})
    found = fit(whole, noises_of(whole, noise), whole.nominal, np.zeros(3), whole.training)
    start = np.concatenate(from_prior_mean(found))
    gap = orthogonal(start, np.concatenate(found.jacobians)) - np.concatenate(found.residuals)
    assert gap @ gap < TOLERANCE, "the change that the last, omitted step would make"


def test_numbers_that_are_not_finite_are_refused():
    problem, noises = curve_problem(lambda v, x: np.full(50, np.nan), (Parameter("a", "1", 1.0, Normal(1.0, 1.0)),),
                                    lambda x: x, 0.1)
    with pytest.raises(ConvergenceError, match="prediction of run a: expected finite numbers"):
        linearised(problem, noises, problem.nominal, [0.0], problem.runs)


def test_a_prediction_of_another_shape_is_refused():
    problem, noises = curve_problem(lambda v, x: x[1:], (Parameter("a", "1", 1.0, Normal(1.0, 1.0)),), lambda x: x, 0.1)
    with pytest.raises(ConfigError, match=r"prediction of run a: expected channels and samples \(1, 50\)"):
        linearised(problem, noises, problem.nominal, [0.0], problem.runs)


def test_known_columns_are_taken_and_not_called_fresh():
    whole, noise, _, _ = linear.problem((3,), truth={"nominal_0": 0.7})
    full = linearised(whole, noises_of(whole, noise), whole.nominal, np.zeros(3), whole.training)
    known = [j[:, :2] for j in full.jacobians]
    found = linearised(whole, noises_of(whole, noise), whole.nominal, np.zeros(3), whole.training, known)
    assert full.fresh and not found.fresh and (full.evaluations, found.evaluations) == (4, 2)
    for one, other in zip(full.jacobians, found.jacobians, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.exact
def test_columns_that_a_run_does_not_feel_add_nothing():
    random = np.random.default_rng(1)
    jacobians = [random.standard_normal((40, 5)), random.standard_normal((30, 5))]
    jacobians[0][:, 3] = jacobians[1][:, 1] = 0.0
    expected = 2 * jacobians[0].T @ jacobians[0] + 3 * jacobians[1].T @ jacobians[1]
    np.testing.assert_allclose(_information(jacobians, [2, 3]), expected, atol=1e-12)
