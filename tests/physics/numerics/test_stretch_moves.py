"""Stretch moves have the right mean and spread and stay within their bounds."""

import numpy as np
import pytest

from pipeline.physics.numerics.stretch_moves import stretch_samples

LOWER, UPPER = np.array([-2.0, -2.0, -2.0]), np.array([2.0, 2.0, 2.0])


@pytest.mark.exact
def test_stretch_moves_sample_a_correlated_gaussian():
    covariance = np.array([[0.09, 0.05], [0.05, 0.04]])
    precision = np.linalg.inv(covariance)
    walkers = 0.1 * np.random.default_rng(5).standard_normal((20, 2))
    samples = stretch_samples(lambda p: -p @ precision @ p / 2, walkers, LOWER[:2], UPPER[:2], 1500, seed=6)[4000:]
    assert samples.shape == (26000, 2)
    np.testing.assert_allclose(samples.mean(axis=0), 0.0, atol=0.02)
    np.testing.assert_allclose(np.cov(samples.T), covariance, rtol=0.15)


def test_samples_stay_within_the_bounds():
    walkers = 0.5 + 0.1 * np.random.default_rng(5).standard_normal((12, 2))
    samples = stretch_samples(lambda p: 0.0, walkers, np.zeros(2), np.ones(2), 200, seed=1)
    assert samples.min() >= 0 and samples.max() <= 1 and samples.std() > 0.2
