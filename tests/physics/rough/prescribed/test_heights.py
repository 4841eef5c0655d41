"""Moments and ranks of height distributions."""

import numpy as np
import pytest
from scipy import special

from pipeline.physics.rough.prescribed.heights import SCORES, Heights, mean_heights, moments, ranked, with_moments


@pytest.mark.exact
def test_moments_of_a_wave():
    assert moments(3.0 + np.cos(2 * np.pi * np.arange(64) / 64)) == pytest.approx((0.0, 1.5), abs=1e-12)


@pytest.mark.exact
def test_ranks_keep_their_order_and_take_the_distribution():
    values = np.random.default_rng(1).standard_normal((100, 100)) ** 3
    gaussian = ranked(values, SCORES)
    np.testing.assert_array_equal(np.argsort(gaussian, axis=None), np.argsort(values, axis=None))
    np.testing.assert_allclose(np.sort(gaussian, axis=None), special.ndtri((np.arange(1e4) + 0.5) / 1e4), atol=1e-9)


def test_a_map_tells_its_heights():
    scale = np.array([1e-6, 5e-6, 2e-6, 9e-6])[:, None, None]
    heights = mean_heights(scale * np.random.default_rng(2).standard_normal((4, 200, 200)))
    assert heights.skewness == pytest.approx(0.0, abs=0.03) and heights.kurtosis == pytest.approx(3.0, abs=0.05)
    np.testing.assert_allclose(heights.quantiles[10:31], SCORES[10:31], atol=0.03)


@pytest.mark.exact
def test_moments_are_reached_where_nothing_restrains_them():
    def standard(values):
        return (values - values.mean()) / values.std()

    aim = Heights(-0.8, 4.5)
    found = with_moments(standard(np.random.default_rng(3).standard_normal((64, 64))), aim, standard, lambda v: v)
    assert moments(found) == pytest.approx((-0.8, 4.5), abs=1e-4)
