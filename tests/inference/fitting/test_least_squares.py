"""Least squares under priors: closed forms of linear problems, a nonlinear one, bounds, jumps, refusals."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import (
    _along_central_differences,
    _crawls,
    beside,
    continued,
    fit,
    iterated,
)
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
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


@pytest.mark.exact
def test_a_factor_that_shows_nowhere_is_what_priors_alone_say():
    """Of m x'' + k x = J only ratios show; begun 5 deviations off along their common factor, ln m / .2 + ... = 0."""
    parameters = tuple(Parameter(name, "1", 1.0, LogNormal(1.0, spread)) for name, spread in
                       (("mass", 0.2), ("stiffness", 0.2), ("impulse", 1.0)))
    true = {"mass": 1.1, "stiffness": 0.9, "impulse": 1.3}

    def ringing(v, x):
        angular = np.sqrt(v["stiffness"] / v["mass"])
        return v["impulse"] / (v["mass"] * angular) * np.sin(40 * angular * x)

    problem, noises = curve_problem(ringing, parameters, lambda x: ringing(true, x), 1e-4)
    start = np.array([np.log(true[p.name]) / p.prior.spread for p in parameters]) + np.array([5.0, 5.0, 1.0])
    state = _along_central_differences(problem, linearised(problem, noises, problem.nominal, start, problem.runs))
    assert state.converged
    a, b = np.log(true["stiffness"] / true["mass"]), np.log(true["impulse"] / true["mass"])
    mass = -(a / 0.2**2 + b) / (2 / 0.2**2 + 1)        # least of m^2 / .04 + (m + a)^2 / .04 + (m + b)^2
    least = (mass**2 + (mass + a) ** 2) / 0.2**2 + (mass + b) ** 2
    assert state.objective < least + 1, "within a posterior standard deviation, as fits count as converged"
    assert linearised(problem, noises, problem.nominal, start, problem.runs).objective > least + 45


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


def test_samples_far_above_the_noise_that_come_no_nearer_crawl():
    state = SimpleNamespace(unordered=False, counts=np.array([60, 40]))
    assert _crawls(state, [300.0] * 11) and not _crawls(state, [300.0] * 10)
    slowly, faster = (100 + 200 * share ** -np.arange(11.0)[::-1] for share in (0.999, 0.997))
    assert _crawls(state, list(slowly)) and not _crawls(state, list(faster))
    assert not _crawls(state, [115.0] * 20), "near the noise a fit goes on to its end"


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


def test_at_a_bound_the_other_parameters_still_find_their_optimum():
    """Two parameters that act almost alike, one of them wanted far beyond its bound."""
    parameters = tuple(Parameter(name, "1", 0.0, Normal(0.0, width)) for name, width in (("a", 1e-3), ("b", 10.0)))
    whole, noise = curve_problem(lambda v, x: v["a"] * (1 + 0.3 * x) + v["b"], parameters, lambda x: 3.0 + x, 1e-3)
    found = fit(whole, noise, whole.nominal, np.zeros(2), whole.training)
    bound = 8e-3
    assert found.converged and found.values["a"] == pytest.approx(bound, rel=1e-9)
    mean = np.mean(3.0 + np.linspace(0, 1, 50) - bound * (1 + 0.3 * np.linspace(0, 1, 50)))
    assert found.values["b"] == pytest.approx(mean, rel=1e-5)


def test_a_frugal_fit_takes_no_differences():
    whole, noises = curve_problem(lambda v, grid: np.exp(v["x"] * grid), (Parameter("x", "1", 0.0, Normal(0.0, 1.0)),),
                                  lambda grid: np.exp(0.8 * grid), 0.01)
    begin = linearised(whole, noises, whole.nominal, [0.0], whole.training)
    shown = iterated(whole, begin, 3, frugal=True)
    assert shown.objective < begin.objective and not shown.fresh and not shown.converged
    assert shown.evaluations - begin.evaluations <= 3 * 8


def test_what_is_kept_stays_while_the_rest_is_fitted():
    whole, noise, _, _ = linear.problem((2,), truth={"nominal_0": 1.5, "nominal_1": -0.5})
    noises = noises_of(whole, noise)
    state = beside(whole, linearised(whole, noises, whole.nominal, [0.0, 0.0], whole.training), np.array([True, False]))
    assert state.latent[0] == 0.0 and abs(state.slopes[0][1]) < 1e-6
