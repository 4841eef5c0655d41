"""Evidence: multivariate normal densities in closed form, left-out points by the chain rule, nested sampling's hook."""

from functools import partial

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from pipeline.inference.decision.evidence import (
    cautious_prior,
    evidence,
    family_wise,
    nested,
    posterior,
    reached,
    screened,
)
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from tests.inference import linear


def fitted(hypothesis_index=0, **more):
    whole, noise, catalogue, tables = linear.problem(**more)
    hypothesis = [whole.nominal, *(whole.nominal.joined(c) for c in catalogue)][hypothesis_index]
    noises = tuple(noise[r.name] for r in whole.training)
    return whole, fit(whole, noises, hypothesis, np.zeros(len(hypothesis.parameters)), whole.training), tables


def log_density(data, design):
    """ln N(data; 0, I + design design') without the constant."""
    full = stats.multivariate_normal(np.zeros(len(data)), np.eye(len(data)) + design @ design.T)
    return full.logpdf(data) + 0.5 * len(data) * np.log(2 * np.pi)


@pytest.mark.exact
@pytest.mark.parametrize("index", [0, 1, 2])
def test_the_evidence_is_the_density_of_the_data(index):
    whole, found, tables = fitted(index, sizes=(2, 1, 3), truth={"effect_1_0": 1.0})
    data, design = linear.dense(whole, found.hypothesis, tables)
    assert evidence(found).log_evidence == pytest.approx(log_density(data, design), abs=1e-5)


@pytest.mark.exact
def test_it_does_not_matter_where_a_linear_problem_is_linearised():
    whole, found, _ = fitted(sizes=(3,))
    elsewhere = linearised(whole, found.noises, found.hypothesis, [2.0, -1.0, 0.5], found.runs)
    assert evidence(elsewhere).log_evidence == pytest.approx(evidence(found).log_evidence, abs=1e-5)


@pytest.mark.exact
def test_a_left_out_point_has_its_conditional_density():
    whole, found, tables = fitted(sizes=(2,), runs=4, truth={"nominal_0": 1.5})
    data, design = linear.dense(whole, found.hypothesis, tables)
    for k, told in enumerate(evidence(found).left_out):
        others = np.arange(len(data)) // 60 != k
        expected = log_density(data, design) - log_density(data[others], design[others])
        assert told == pytest.approx(expected, abs=1e-5)


@pytest.mark.exact
def test_a_run_of_weight_one_half_counts_as_half_its_samples():
    whole, found, tables = fitted(sizes=(2,))
    data, design = linear.dense(whole, found.hypothesis, tables)
    root = np.repeat(np.sqrt([1.0, 0.5, 0.5]), 60)
    expected = log_density(root * data, root[:, None] * design)
    assert evidence(found, [1.0, 0.5, 0.5]).log_evidence == pytest.approx(expected, abs=1e-5)


@pytest.mark.exact
def test_a_screened_candidate_has_the_evidence_of_its_refit():
    whole, null, tables = fitted(0, sizes=(2, 1), truth={"effect_1_0": 0.2})
    _, full, _ = fitted(1, sizes=(2, 1), truth={"effect_1_0": 0.2})
    data, design = linear.dense(whole, null.hypothesis, tables)
    g = np.concatenate([tables[r.name]["effect_1_0"] for r in whole.training]) / linear.STD
    inverse = np.linalg.inv(np.eye(len(data)) + design @ design.T)
    power = np.sqrt(g @ inverse @ g)
    told = screened(evidence(null).log_evidence, abs(g @ inverse @ data) / power, power)
    assert told == pytest.approx(evidence(full).log_evidence, abs=1e-4)


@pytest.mark.exact
def test_evidence_bounds_how_often_chance_names_one_of_many():
    """z ~ N(0, 1) of 50 candidates of power 3, nothing missing: the best is below p in fewer than p of draws."""
    score = np.random.default_rng(0).standard_normal((20000, 50))
    gain = screened(0.0, abs(score), 3.0).max(axis=1)
    found = np.array([family_wise(1.0, g, 50) for g in gain])
    assert found.min() < 0.1 and all(np.mean(found <= p) <= p for p in (0.5, 0.1, 0.05, 0.01))
    assert family_wise(1e-4, 3.0, 50) == 1e-4 and family_wise(0.5, -2.0, 50) == 0.5
    assert family_wise(0.5, 30.0, 50) == pytest.approx(50 * np.exp(-30.0))


@pytest.mark.exact
def test_probabilities_are_bayes_rule():
    np.testing.assert_allclose(posterior(np.log([1.0, 2.0, 5.0]) + 700), [0.125, 0.25, 0.625])
    np.testing.assert_allclose(posterior(np.log([1.0, 2.0, 4.0]), cautious_prior(2)), [0.25, 0.25, 0.5])


def half_normal_problem(truth):
    grid = np.linspace(0, 1, 40)
    run = Observed("a", {}, ("y",), (truth * grid + 0.1 * np.random.default_rng(1).standard_normal(40))[None], None,
                   noise_std=np.array([0.1]))
    whole = Problem((run,), lambda h, values, r: (values["a"] * grid)[None],
                    Hypothesis("nominal", (), (Parameter("a", "1", 1.0, HalfNormal(1.0)),)))
    return whole, fit(whole, (budget(whole)["a"],), whole.nominal, np.zeros(1), whole.runs)


@pytest.mark.parametrize("truth, tolerance", [(1.0, 0.01), (0.2, 0.05), (0.0, 0.5)])
def test_laplace_is_near_the_integral_for_a_bounded_parameter(truth, tolerance):
    whole, found = half_normal_problem(truth)
    assert evidence(found).log_evidence == pytest.approx(integral(whole, found), abs=tolerance)


def integral(whole, found):
    peak = found.chi_square.sum()

    def density(latent):
        residual = linearised(whole, found.noises, whole.nominal, [latent], whole.runs).chi_square.sum()
        return np.exp(-0.5 * (residual - peak)) * stats.norm.pdf(latent)

    return np.log(quad(density, -7.5, 7.5, limit=200, points=[float(found.latent[0])])[0]) - 0.5 * peak


@pytest.mark.exact
def test_nested_sampling_sees_the_likelihood_and_prior_of_laplace():
    whole, found = half_normal_problem(1.0)

    def quadrature(log_likelihood, transform, size):
        share = (np.arange(4000) + 0.5) / 4000
        logs = np.array([log_likelihood(np.array([transform(s)])) for s in share])
        assert size == 1
        return np.log(np.mean(np.exp(logs - logs.max()))) + logs.max()

    assert nested(whole, found, quadrature) == pytest.approx(integral(whole, found), abs=1e-3)


def test_a_model_that_fails_somewhere_has_no_likelihood_there():
    whole, found = half_normal_problem(1.0)
    failing = Problem(whole.runs, partial(_nothing, 40), whole.nominal)
    assert nested(failing, found, lambda log_likelihood, transform, size: log_likelihood(np.zeros(1))) == -np.inf


def _nothing(size, hypothesis, values, run):
    return np.full((1, size), np.nan)


def test_what_has_not_converged_counts_by_what_it_has_reached():
    whole, found, _ = fitted(sizes=(2, 1), truth={"nominal_0": 1.0})
    assert reached(found).log_evidence == pytest.approx(evidence(found).log_evidence, abs=1e-3)
    begun = linearised(whole, found.noises, found.hypothesis, np.array([2.0, -2.0]), found.runs)
    lost = 0.5 * (begun.objective - found.objective)
    assert reached(begun).log_evidence == pytest.approx(evidence(found).log_evidence - lost, abs=1e-2)
