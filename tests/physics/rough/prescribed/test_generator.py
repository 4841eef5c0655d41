"""Surfaces with a prescribed spectrum and prescribed heights."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.rough.generator import band_limit, construction_size
from pipeline.physics.rough.prescribed.bands import Bands, band_edges, measured_bands
from pipeline.physics.rough.prescribed.generator import deviations, prescribed_surface
from pipeline.physics.rough.prescribed.heights import Heights, moments
from pipeline.physics.rough.topography import isotropic_spectrum, statistics

LENGTH, SHORTEST, HURST, ROLL_OFF = 1e-3, 25e-6, 0.8, 6e3
SIZE = construction_size(LENGTH, SHORTEST)


def integral(power, low, high):
    """Of k^power C(k) from low to high, where C is flat up to the roll-off, then (k / roll-off)^(-2 - 2 H)."""
    def plain(exponent, begin, end):
        return (end ** (exponent + 1) - begin ** (exponent + 1)) / (exponent + 1)

    low, high = np.asarray(low), np.asarray(high)
    falling = ROLL_OFF ** (2 + 2 * HURST) * plain(power - 2 - 2 * HURST, np.maximum(low, ROLL_OFF),
                                                  np.maximum(high, ROLL_OFF))
    return plain(power, np.minimum(low, ROLL_OFF), np.minimum(high, ROLL_OFF)) + falling


def power_law():
    """Bands of that spectrum, by its integrals over k dk."""
    edges = band_edges(LENGTH, SHORTEST)
    variance = integral(1, 1 / edges[:-1], 1 / edges[1:])
    return Bands(edges, variance / variance.sum())


def made(seed=1, nodes=SIZE, heights=None, bands=None, **changes):
    return prescribed_surface(nodes, LENGTH, SHORTEST, 3e-6, seed=seed, bands=bands or power_law(),
                              heights=heights or Heights(), **{"tolerance": 0.05, **changes})


@pytest.mark.exact
def test_a_gaussian_surface_has_the_slope_of_its_spectrum():
    """Sdq^2 = (2 pi Sq)^2 int k^3 C dk / int k C dk, the mean over four seeds within 2 % of the continuum."""
    maps = [made(seed, 4 * SIZE) for seed in range(4)]
    slopes = [statistics(m, (LENGTH / m.shape[0],) * 2).rms_slope for m in maps]
    low, high = 0.5 / LENGTH, 1 / SHORTEST
    exact = 2 * np.pi * 3e-6 * np.sqrt(integral(3, low, high) / integral(1, low, high))
    assert np.mean(slopes) == pytest.approx(exact, rel=0.02)
    for heights in maps:
        assert heights.std() == pytest.approx(3e-6, rel=1e-12)
        assert moments(heights) == pytest.approx((0.0, 3.0), abs=1e-3)


@pytest.mark.exact
@pytest.mark.parametrize("skewness, kurtosis", [(-1.0, 4.5), (0.5, 3.2), (0.0, 2.4), (0.0, 6.0)])
def test_heights_and_spectrum_hold_together(skewness, kurtosis):
    heights = made(heights=Heights(skewness, kurtosis))
    assert moments(heights) == pytest.approx((skewness, kurtosis), abs=1e-3)
    bands = measured_bands(heights, LENGTH, power_law().wavelength, 1)
    np.testing.assert_allclose(bands.variance, power_law().variance, rtol=1e-9)


def test_a_distribution_is_taken_with_its_shape():
    """Two plateaus: few heights between them, which no two moments tell."""
    steep = np.tanh(4.0 * np.linspace(-4.0, 4.0, 41))
    spread = np.quantile(made(heights=Heights(0.0, 1.7, steep)) / 3e-6, [0.25, 0.5, 0.75])
    assert spread[0] < -0.75 and spread[2] > 0.75 and abs(spread[1]) < 0.3


@pytest.mark.exact
def test_seeded_periodic_and_the_same_on_every_grid():
    heights = made(heights=Heights(-1.0, 4.5))
    np.testing.assert_array_equal(heights, made(heights=Heights(-1.0, 4.5)))
    assert abs(np.corrcoef(heights.ravel(), made(2, heights=Heights(-1.0, 4.5)).ravel())[0, 1]) < 0.5
    np.testing.assert_allclose(made(nodes=2 * SIZE, heights=Heights(-1.0, 4.5))[::2, ::2], heights, atol=1e-12)
    np.testing.assert_allclose(band_limit(heights, (LENGTH, LENGTH), SHORTEST), heights, atol=1e-15)


def test_the_radial_spectrum_follows_the_power_law():
    wave, power = np.mean([isotropic_spectrum(made(seed), (LENGTH / SIZE,) * 2) for seed in range(6)], axis=0)
    inside = (wave > 2 * np.pi * 1.4 * ROLL_OFF) & (wave < 0.9 * 2 * np.pi / SHORTEST)
    slope, _ = np.polyfit(np.log(wave[inside]), np.log(power[inside]), 1)
    assert -slope == pytest.approx(2.0 + 2.0 * HURST, abs=0.1)


def test_directions_are_kept():
    bands = power_law()
    ridged = Bands(bands.wavelength, bands.variance, np.tile([0.05, 0.05, 0.85, 0.05], (len(bands.variance), 1)))
    slope_y, slope_x = np.gradient(made(bands=ridged))
    assert slope_y.std() > 2.0 * slope_x.std()


def test_moments_that_the_spectrum_cannot_have_are_refused():
    """A single wave along x has Sku 1.5 whatever its phase."""
    single = Bands(np.array([1.1e-3, 0.9e-3]), np.array([1.0]), np.array([[1.0, 0.0, 0.0, 0.0]]))
    with pytest.raises(ConvergenceError, match="expected Ssk 0 and Sku 5 within 0.05, found .* at best"):
        made(bands=single, heights=Heights(0.0, 5.0))
    assert moments(made(bands=single, heights=Heights(0.0, 5.0), tolerance=1.0))[1] == pytest.approx(1.5)


@pytest.mark.exact
def test_deviations_are_relative_but_of_a_small_skewness():
    assert deviations(-0.1, 3.3, Heights(0.1, 3.0)) == pytest.approx((0.2, 0.1))
    assert deviations(-2.2, 9.0, Heights(-2.0, 9.0)) == pytest.approx((0.1, 0.0))
