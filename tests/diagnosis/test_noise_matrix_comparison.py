"""Comparison of predicted and recorded occurrence: who differs, and how often by chance."""

import numpy as np
import pytest

from pipeline.diagnosis.noise_matrix_comparison import comparison

STOPS = np.array([8, 8, 8, 0])


def brakes(rng, share, count, repeats):
    """(count, repeats, c, b) noisy stops: the tendency of a brake moves all conditions, in one of two bands."""
    tendency = rng.normal(size=(count, 1, 1))
    noisy = tendency + rng.normal(size=(count, repeats, len(share))) < np.sqrt(2) * np.asarray(share)
    band = rng.integers(0, 2, noisy.shape)
    return noisy[..., None] & (band[..., None] == np.arange(2))


def recorded(noisy):
    """(c, b + 1) counts of one brake (stops, c, b), as many stops as STOPS says."""
    counted = np.stack([noisy[:n, k].sum(axis=0) for k, n in enumerate(STOPS)])
    return np.column_stack([counted, [noisy[:n, k].any(axis=1).sum() for k, n in enumerate(STOPS)]])


@pytest.mark.exact
def test_simulated_agreement_raises_at_most_the_stated_false_alarms():
    """Any of all tests at a family-wise 5 %: within 3.1 standard errors of at most 5 %."""
    rng, count = np.random.default_rng(3), 300
    alarms = 0
    for _ in range(count):
        share = (-0.8, 0.0, 0.6, 0.0)
        made = comparison(brakes(rng, share, 60, 2), STOPS, recorded(brakes(rng, share, 1, 8)[0]), 0.05)
        alarms += bool(made["all_difference"] or made["band_difference"].any() or made["condition_difference"].any())
    assert alarms / count <= 0.05 + 3.1 * np.sqrt(0.05 * 0.95 / count)


def test_a_bench_that_squeals_where_the_model_does_not_is_told_and_only_there():
    rng = np.random.default_rng(4)
    noisy = rng.uniform(size=(300, 2, 4, 2)) < np.array([0.01, 0.2, 0.2, 0.2])[:, None]
    heard = np.array([[7, 0, 7], [2, 1, 3], [1, 2, 3], [0, 0, 0]])
    made = comparison(noisy, STOPS, heard, 0.05)
    np.testing.assert_array_equal(made["condition_difference"], [-1, 0, 0, 0])
    assert made["condition_p_value"][0] < 1e-3 and made["condition_p_value"][3] == 1
    assert made["tests"] == 3 + 2 + 1
    assert made["condition_expected"][1] == pytest.approx(8 * noisy[:, :, 1].any(axis=2).mean())
    silent = comparison(noisy | (np.arange(4) == 1)[:, None], STOPS, np.zeros((4, 3), int), 0.05)
    assert silent["condition_difference"][1] == 1 and silent["all_difference"] == 1


def test_without_recorded_stops_nothing_is_tested():
    made = comparison(np.ones((10, 1, 4, 2), bool), 0 * STOPS, np.zeros((4, 3), int), 0.05)
    assert made["tests"] == 0 and not made["condition_difference"].any() and (made["band_p_value"] == 1).all()
    assert made["all_p_value"] == 1 and made["all_expected"] == 0
