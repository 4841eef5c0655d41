"""Least squares under priors: closed forms of linear problems, a nonlinear one, bounds, jumps, refusals."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.inference.fitting.least_squares import (
    TOLERANCE,
    _crawls,
    continued,
    fit,
    from_prior_mean,
    linearised,
    orthogonal,
)
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.problem import Problem
from tests.inference import linear, oscillator
from tests.inference.curves import curve_problem, features, noises_of


@pytest.mark.exact
def test_a_linear_problem_has_the_closed_form_of_its_posterior():
    whole, noise, _, tables = linear.problem((3,), truth={"nominal_0": 0.7, "nominal_2": -1.2}, prior=2.0)
    found = fit(whole, noises_of(whole, noise), whole.nominal, np.zeros(3), whole.training)
    data, design = linear.dense(whole, whole.nominal, tables)
    covariance = np.linalg.inv(design.T @ design + np.eye(3) / 4)
    np.testing.assert_allclose(list(found.values.values()), covariance @ design.T @ data, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(4 * found.covariance(), covariance, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(list(found.spread().values()), np.sqrt(np.diag(covariance)), rtol=1e-6)
    assert found.converged and found.counts.sum() == len(data)


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


def test_a_nonlinear_problem_is_solved_from_afar():
    problem = oscillator.bench(0, stiffness=520.0, damping=0.8)
    noise = budget(problem)
    found = fit(problem, noises_of(problem, noise), problem.nominal, np.zeros(2), problem.training)
    spread = found.spread()
    assert abs(found.values["stiffness"] - 520.0) < 4 * spread["stiffness"] and spread["stiffness"] < 0.25
    assert abs(found.values["damping"] - 0.8) < 4 * spread["damping"] < 0.05
    assert found.chi_square.sum() == pytest.approx(found.counts.sum(), abs=4 * np.sqrt(2 * found.counts.sum()))


def test_bounds_hold_and_the_posterior_covers_its_truth():
    parameters = (Parameter("slope", "1", 1.0, HalfNormal(1.0)), Parameter("level", "1", 1.0, LogNormal(1.0, 0.5)))
    inside = []
    for seed in range(60):
        noise = 0.3 * np.random.default_rng(seed).standard_normal(50)
        problem, noises = curve_problem(lambda v, x: v["slope"] * x + v["level"], parameters,
                                        lambda x, noise=noise: 0.8 * x + 1.3 + noise, 0.3)
        found = fit(problem, noises, problem.nominal, np.zeros(2), problem.runs)
        inside.append(abs(found.values["level"] - 1.3) < 1.96 * found.spread()["level"])
        assert found.converged and found.values["slope"] > 0
    assert np.mean(inside) >= 0.85
    problem, noises = curve_problem(lambda v, x: v["slope"] * x + v["level"], parameters,
                                    lambda x: 1.0 - 0.5 * x, 0.01)
    found = fit(problem, noises, problem.nominal, np.zeros(2), problem.runs)
    assert found.converged and 0 <= found.values["slope"] < 0.05


def test_features_that_stay_far_off_crawl():
    whole, noises = features(1.4, 0.001)
    state = linearised(whole, noises, whole.nominal, np.zeros(1), whole.runs)
    assert state.far and _crawls(state, [state.objective] * 6)
    assert not _crawls(state, [state.objective] * 5), "a trial is not judged"
    slowly = state.objective * 0.96 ** -np.arange(9.0)[::-1]
    assert not _crawls(state, slowly[1:]) and _crawls(state, slowly)
    assert not _crawls(state, list(state.objective * np.geomspace(2, 1, 9)))
    near = linearised(whole, noises, whole.nominal, np.array([1.4]), whole.runs)
    assert not _crawls(near, [near.objective] * 9)


def test_numbers_that_are_not_finite_are_refused():
    problem, noises = curve_problem(lambda v, x: np.full(50, np.nan), (Parameter("a", "1", 1.0, Normal(1.0, 1.0)),),
                                    lambda x: x, 0.1)
    with pytest.raises(ConvergenceError, match="prediction of run a: expected finite numbers"):
        linearised(problem, noises, problem.nominal, [0.0], problem.runs)


def test_a_prediction_of_another_shape_is_refused():
    problem, noises = curve_problem(lambda v, x: x[1:], (Parameter("a", "1", 1.0, Normal(1.0, 1.0)),), lambda x: x, 0.1)
    with pytest.raises(ConfigError, match=r"prediction of run a: expected channels and samples \(1, 50\)"):
        linearised(problem, noises, problem.nominal, [0.0], problem.runs)


def test_where_a_small_difference_hits_a_jump_a_wider_one_shows_the_way():
    """Jumps against the slope, the start just before one of them."""
    def jumping(a, grid):
        return a * grid - 2e-4 * np.floor(a / 1e-3)
    whole, noise = curve_problem(lambda values, grid: jumping(values["a"], grid),
                                 (Parameter("a", "1", 1.0, Normal(1.0, 0.3)),), lambda grid: jumping(1.2, grid), 0.01)
    found = fit(whole, noise, whole.nominal, np.array([-1e-5 / 0.3]), whole.training)
    assert found.converged and found.values["a"] == pytest.approx(1.2, abs=0.01)


def test_a_fit_that_cannot_come_near_enough_is_given_up():
    whole, noise, catalogue, _ = linear.problem((2,), truth={"nominal_0": 0.7})
    begin = linearised(whole, noises_of(whole, noise), whole.nominal, np.zeros(2), whole.training)
    free = continued(whole, begin)
    assert free.converged and continued(whole, begin, enough=2 * free.objective).converged
    stopped = continued(whole, begin, enough=-10 * begin.objective)
    assert not stopped.converged and stopped.evaluations == begin.evaluations


def test_a_fit_that_is_stopped_is_judged_by_central_differences():
    """A residual curved so that forward differences at its optimum still promise a way down."""
    whole, noise = curve_problem(lambda v, x: 3e4 * v["a"] ** 2 + 0 * x,
                                 (Parameter("a", "1", 0.0, Normal(0.0, 1.0)),), lambda x: -1.0 + 0 * x, 0.1)
    begin = linearised(whole, noise, whole.nominal, np.zeros(1), whole.training)
    assert begin.promised > 50, "the error of forward differences"
    stopped = continued(whole, begin, iterations=0)
    assert stopped.converged and stopped.promised < 1e-2 and stopped.evaluations == begin.evaluations + 2


def test_known_columns_are_taken_and_not_called_fresh():
    whole, noise, _, _ = linear.problem((3,), truth={"nominal_0": 0.7})
    full = linearised(whole, noises_of(whole, noise), whole.nominal, np.zeros(3), whole.training)
    known = [j[:, :2] for j in full.jacobians]
    found = linearised(whole, noises_of(whole, noise), whole.nominal, np.zeros(3), whole.training, known)
    assert full.fresh and not found.fresh and (full.evaluations, found.evaluations) == (4, 2)
    for one, other in zip(full.jacobians, found.jacobians, strict=True):
        np.testing.assert_array_equal(one, other)


def test_at_a_bound_the_other_parameters_still_find_their_optimum():
    """Two parameters that act almost alike, one of them wanted far beyond its bound."""
    parameters = tuple(Parameter(name, "1", 0.0, Normal(0.0, width)) for name, width in (("a", 1e-3), ("b", 10.0)))
    whole, noise = curve_problem(lambda v, x: v["a"] * (1 + 0.3 * x) + v["b"], parameters, lambda x: 3.0 + x, 1e-3)
    found = fit(whole, noise, whole.nominal, np.zeros(2), whole.training)
    bound = 8e-3
    assert found.converged and found.values["a"] == pytest.approx(bound, rel=1e-9)
    mean = np.mean(3.0 + np.linspace(0, 1, 50) - bound * (1 + 0.3 * np.linspace(0, 1, 50)))
    assert found.values["b"] == pytest.approx(mean, rel=1e-5)
