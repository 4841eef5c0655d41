"""Evidence of predicted tones: closed forms of Poisson processes, and what no evidence may do."""

import numpy as np
import pytest
import scipy

from pipeline.inference.decision.line_evidence import (
    Band,
    Heard,
    Tones,
    calibration,
    log_density,
    log_evidence,
    named,
    simulated,
)

BAND = Band(1e3, 20e3, 0.1, 0.05)
#: probability of a growing tone to be heard whose mean number of lines in one test is 0.7
SHARE = -np.expm1(-0.7)


def tones(*frequencies, share=SHARE, tests=1, draws=1, std=100.0):
    """Tones that grow in all ``tests``, or in those that a list of rows names."""
    frequency = np.tile(np.array(frequencies, float).reshape(1, -1), (draws, 1))
    grows = np.ones((len(frequencies), tests)) if np.isscalar(tests) else np.array(tests, float)
    return Tones(frequency, np.full(frequency.shape, std), np.tile(grows, (draws, 1, 1)), np.full(draws, share))


def heard(*lines, tests=None):
    """Lines of one test, or of those that the rows of ``tests`` name."""
    return Heard(np.array(lines, float), np.ones((len(lines), 1), int) if tests is None else np.array(tests))


@pytest.mark.exact
def test_without_tones_only_unexplained_lines_remain():
    for lines in ((), (5e3,), (5e3, 7e3, 9e3)):
        expected = -0.1 + len(lines) * np.log(0.1 / 19e3)
        np.testing.assert_allclose(log_density(heard(*lines), tones(), BAND), expected)
    marks = [[1, 0, 0], [1, 1, 1]]
    two = log_density(heard(5e3, 7e3, tests=marks), tones(tests=np.ones((0, 3))), BAND)
    np.testing.assert_allclose(two, -0.1 + 2 * np.log(0.1 / 19e3 / 7))


@pytest.mark.exact
def test_one_tone_heard_once():
    clean = Band(1e3, 20e3, 0.0)
    expected = np.log(0.7 * np.exp(-0.7)) + scipy.stats.norm.logpdf(8.05e3, 8e3, 100)
    np.testing.assert_allclose(log_density(heard(8.05e3), tones(8e3), clean), expected)
    assert log_density(heard(8e3), tones(), clean) == -np.inf


@pytest.mark.exact
def test_the_densities_of_no_line_and_of_one_integrate_to_their_poisson_probabilities():
    """Over frequencies and over the tests that may have heard the line."""
    pair = tones(5e3, 8e3, tests=[[1, 1], [0, 1]])
    expected = 0.7 * 3 + 0.1
    np.testing.assert_allclose(np.exp(log_density(heard(tests=np.empty((0, 2))), pair, BAND)), np.exp(-expected))
    grid = np.linspace(1e3, 20e3, 9501)
    density = [sum(np.exp(log_density(heard(f, tests=[mark]), pair, BAND))[0] for mark in ([1, 0], [0, 1], [1, 1]))
               for f in grid]
    np.testing.assert_allclose(scipy.integrate.trapezoid(density, grid), expected * np.exp(-expected), rtol=1e-6)


@pytest.mark.exact
def test_the_tests_that_hear_a_tone_are_independent_given_that_one_does():
    """Grows in the first of two tests: a (1 - e) / (1 - (1 - a)(1 - e)) of its lines are heard in the first alone."""
    one, clean, a, e = tones(8e3, share=0.6, tests=[[1, 0]]), Band(1e3, 20e3, 0.0, 0.1), 0.6, 0.1
    first, second = (log_density(heard(8e3, tests=[mark]), one, clean)[0] for mark in ([1, 0], [0, 1]))
    total = np.log(-np.log(1 - a)) + np.log(1 - a) + scipy.stats.norm.logpdf(0, 0, 100)
    none = 1 - (1 - a) * (1 - e)
    np.testing.assert_allclose([first, second], total + np.log(np.array([a * (1 - e), (1 - a) * e]) / none))


@pytest.mark.exact
def test_a_tone_at_the_end_of_the_band_is_heard_half_as_often():
    np.testing.assert_allclose(log_density(heard(), tones(20e3), Band(1e3, 20e3, 0.0)), -0.35)


@pytest.mark.exact
def test_silence_is_the_poisson_probability_of_no_line():
    both = tones(8e3, 12e3, tests=[[1, 1], [1, 0]])
    silence = log_density(heard(tests=np.empty((0, 1))), both.within([False, True]), BAND)
    np.testing.assert_allclose(np.exp(silence), np.exp(-0.8))
    lines = Heard(np.array([8e3, 9e3]), np.array([[1, 0], [0, 1]])).within(np.array([True, False]))
    np.testing.assert_array_equal(lines.lines, [8e3])


def test_a_frequency_heard_in_all_tests_in_which_it_grows_counts_more_than_in_some():
    grows = tones(8e3, share=0.8, tests=[[1, 1, 0]])
    every, other = (log_density(heard(8e3, tests=[mark]), grows, BAND)[0] for mark in ([1, 1, 0], [0, 0, 1]))
    assert every > other + 3


def test_the_error_of_the_evidence_is_that_of_the_mean_over_draws():
    rng = np.random.default_rng(1)
    values = np.log(rng.uniform(0.5, 1.5, 900))
    evidence, error, carried = log_evidence(values, 0)
    assert abs(evidence) < 4 * error and error == pytest.approx(1 / np.sqrt(12 * 900), rel=0.15)
    assert carried == pytest.approx(900 / (1 + 1 / 12), rel=0.03)
    assert log_evidence(np.full(4, -np.inf), 0) == (-np.inf, 0.0, 0.0)


def test_simulated_lists_have_the_mean_numbers_of_lines_in_each_test():
    lists = simulated(tones(5e3, 30e3, share=0.5, tests=[[1, 0, 0]] * 2, draws=4000), BAND, np.random.default_rng(3))
    assert np.mean([len(h.lines) for h in lists]) == pytest.approx(np.log(2) + 0.1, abs=0.05)
    marks = np.vstack([h.tests for h in lists])
    assert marks.any(axis=1).all() and marks[:, 0].mean() > 0.85 and marks[:, 1].mean() < 0.2
    assert all(((h.lines > 1e3) & (h.lines < 20e3)).all() for h in lists)


def _scattered(middle, rng, draws=200):
    made = tones(*middle, draws=draws)
    return Tones(made.frequency * rng.lognormal(0, 0.01, made.frequency.shape), made.std, made.grows, made.heard)


def test_the_right_model_is_named_where_models_differ():
    rng = np.random.default_rng(5)
    models = {"low": _scattered((3e3, 5e3, 6e3), rng), "high": _scattered((12e3, 15e3, 17e3), rng)}
    winner = named(calibration(models, BAND, 7))
    assert all((winner[k] == k).mean() > 0.75 and (winner[k] == 1 - k).mean() < 0.02 for k in range(2))


def test_nothing_is_named_where_models_predict_the_same():
    rng = np.random.default_rng(6)
    same = (3e3, 9e3, 15e3)
    models = {"one": _scattered(same, rng), "other": _scattered(same, rng)}
    assert (named(calibration(models, BAND, 8)) == -1).mean() > 0.97


def test_a_wrong_model_is_rarely_ten_times_as_likely():
    """The share of lists with a Bayes factor above x for a wrong model is at most 1/x (Markov's inequality)."""
    rng = np.random.default_rng(9)
    models = {"one": _scattered((3e3, 9e3), rng, 800), "other": _scattered((3e3, 9.3e3), rng, 800)}
    evidence = calibration(models, BAND, 10, most=400)
    for k in range(2):
        factor = evidence[k, :, 1 - k] - evidence[k, :, k]
        assert np.mean(factor > np.log(10)) < 0.1 and np.mean(np.exp(factor)) == pytest.approx(1, abs=0.3)
