"""Evidence of predicted tones: closed forms of Poisson processes, and what no evidence may do."""

import numpy as np
import pytest
import scipy

from pipeline.inference.decision.line_evidence import (
    Band,
    Heard,
    Tones,
    calibration,
    log_evidence,
    log_likelihood,
    log_lines,
    log_silence,
    named,
    simulated,
)

BAND = Band(1e3, 20e3, 0.1)


def tones(*frequencies, mean=0.7, quiet=0.0, draws=1, std=100.0):
    frequency = np.tile(np.array(frequencies, float).reshape(1, -1), (draws, 1))
    return Tones(frequency, np.full(frequency.shape, std), np.full(frequency.shape, mean), np.full(draws, quiet))


@pytest.mark.exact
def test_without_tones_only_unexplained_lines_remain():
    for lines in ([], [5e3], [5e3, 7e3, 9e3]):
        expected = -0.1 + len(lines) * np.log(0.1 / 19e3)
        np.testing.assert_allclose(log_lines(np.array(lines), tones(), BAND), expected)


@pytest.mark.exact
def test_one_tone_heard_once():
    clean = Band(1e3, 20e3, 0.0)
    expected = np.log(0.7 * np.exp(-0.7)) + scipy.stats.norm.logpdf(8.05e3, 8e3, 100)
    np.testing.assert_allclose(log_lines(np.array([8.05e3]), tones(8e3), clean), expected)
    assert log_lines(np.array([8e3]), tones(mean=0.7), clean) == -np.inf


@pytest.mark.exact
def test_the_densities_of_no_line_and_of_one_integrate_to_their_poisson_probabilities():
    expected = 0.7 * 2 + 0.1
    np.testing.assert_allclose(np.exp(log_lines(np.empty(0), tones(5e3, 8e3), BAND)), np.exp(-expected))
    grid = np.linspace(1e3, 20e3, 38001)
    density = [np.exp(log_lines(np.array([f]), tones(5e3, 8e3), BAND))[0] for f in grid]
    np.testing.assert_allclose(scipy.integrate.trapezoid(density, grid), expected * np.exp(-expected), rtol=1e-6)


@pytest.mark.exact
def test_a_tone_at_the_end_of_the_band_is_heard_half_as_often():
    np.testing.assert_allclose(log_lines(np.empty(0), tones(20e3), Band(1e3, 20e3, 0.0)), -0.35)


@pytest.mark.exact
def test_silence_is_the_poisson_probability_of_no_line():
    np.testing.assert_allclose(np.exp(log_silence(True, tones(quiet=1.4), BAND)), np.exp(-1.5))
    np.testing.assert_allclose(np.exp(log_silence(False, tones(quiet=1.4), BAND)), 1 - np.exp(-1.5))


def test_the_error_of_the_evidence_is_that_of_the_mean_over_draws():
    rng = np.random.default_rng(1)
    values = np.log(rng.uniform(0.5, 1.5, 900))
    evidence, error, carried = log_evidence(values, 0)
    assert abs(evidence) < 4 * error and error == pytest.approx(1 / np.sqrt(12 * 900), rel=0.15)
    assert carried == pytest.approx(900 / (1 + 1 / 12), rel=0.03)
    assert log_evidence(np.full(4, -np.inf), 0) == (-np.inf, 0.0, 0.0)


def test_simulated_lists_have_the_mean_numbers_of_lines():
    heard = simulated(tones(5e3, 30e3, quiet=0.5, draws=4000), BAND, np.random.default_rng(3))
    assert np.mean([len(h.lines) for h in heard]) == pytest.approx(0.8, abs=0.05)
    assert np.mean([h.silent for h in heard]) == pytest.approx(np.exp(-0.6), abs=0.03)
    assert all(((h.lines > 1e3) & (h.lines < 20e3)).all() for h in heard)


def _scattered(middle, rng, draws=200):
    made = tones(*middle, draws=draws)
    return Tones(made.frequency * rng.lognormal(0, 0.01, made.frequency.shape), made.std, made.mean, made.quiet)


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
    evidence = calibration(models, BAND, 10)
    for k in range(2):
        factor = evidence[k, :, 1 - k] - evidence[k, :, k]
        assert np.mean(factor > np.log(10)) < 0.1 and np.mean(np.exp(factor)) == pytest.approx(1, abs=0.3)


def test_what_was_heard_counts_lines_and_silence():
    heard = Heard(np.array([8e3]), True)
    one = tones(8e3, quiet=0.7)
    np.testing.assert_allclose(log_likelihood(heard, one, BAND),
                               log_lines(heard.lines, one, BAND) + log_silence(True, one, BAND))
