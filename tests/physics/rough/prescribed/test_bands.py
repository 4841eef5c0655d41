"""Bands and sectors of the height variance."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.prescribed.bands import Bands, Cells, band_edges, measured_bands

LENGTH = 1e-3


def wave(size, rows, columns):
    y, x = np.indices((size, size)) / size
    return np.cos(2 * np.pi * (rows * y + columns * x))


@pytest.mark.exact
def test_bounds_cover_the_waves_of_a_patch():
    edges = band_edges(LENGTH, 20e-6)
    waves = LENGTH / edges
    np.testing.assert_allclose(waves[:4], [0.5, 1.5, 2.5, 3.5])
    assert 50.0 < waves[-1] < 50.1 and np.all(np.diff(waves) > 0.99)
    assert len(band_edges(LENGTH, LENGTH)) == 2


@pytest.mark.exact
@pytest.mark.parametrize("size", [32, 33])
def test_a_wave_lies_in_its_band_and_sector(size):
    """4 waves along x carry 1/2, 3 along y 2; those along y have a wave vector across the first sector."""
    edges = band_edges(LENGTH, LENGTH / 8)
    bands = measured_bands(wave(size, 0, 4) + 2.0 * wave(size, 3, 0), LENGTH, edges, 4)
    first, second = (np.searchsorted(LENGTH / edges, k, side="right") - 1 for k in (4, 3))
    assert bands.variance[[first, second]] == pytest.approx([0.2, 0.8])
    np.testing.assert_allclose(bands.directions[first], [1, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(bands.directions[second], [0, 0, 1, 0], atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("size", [32, 33])
def test_energy_is_the_variance_of_a_map(size):
    heights = np.random.default_rng(1).standard_normal((size, size))
    cells = Cells(size, LENGTH, [2 * LENGTH, LENGTH / 40], 5)
    assert cells.energy(np.fft.rfft2(heights)).sum() == pytest.approx(heights.var(), rel=1e-12)
    assert cells.modes.sum() == size ** 2 - 1


@pytest.mark.exact
def test_a_projected_spectrum_has_the_prescribed_variance():
    edges = band_edges(LENGTH, LENGTH / 16)
    heights = self_affine(np.random.default_rng(2), 64, LENGTH, LENGTH / 16, LENGTH / 3, 0.8)
    aim = measured_bands(heights, LENGTH, edges, 6)
    cells = Cells(64, LENGTH, edges, 6)
    noise = np.fft.rfft2(np.random.default_rng(3).standard_normal((64, 64)))
    made = np.fft.irfft2(cells.project(noise * cells.slope(aim), cells.target(aim)), s=(64, 64))
    seen = measured_bands(made, LENGTH, edges, 6)
    assert made.var() == pytest.approx(1.0, rel=1e-12)
    np.testing.assert_allclose(seen.variance, aim.variance, rtol=1e-10, atol=1e-15)
    np.testing.assert_allclose(seen.directions, aim.directions, atol=1e-10)


def test_waves_below_the_shortest_belong_to_no_cell():
    cells = Cells(64, LENGTH, band_edges(LENGTH, LENGTH / 16), 1, LENGTH / 8)
    assert not cells.within(np.ones((64, 33)))[cells.wave > 8.01 / LENGTH].any()
    assert cells.within(np.ones((64, 33)))[0, 8] == 1.0


def test_a_patch_without_waves_of_a_band_is_refused():
    bands = Bands(np.array([3e-3, 1.5e-3, 0.4e-3]), np.array([0.5, 0.5]))
    with pytest.raises(ConfigError, match="waves of every band of the spectrum, found none from 0.003 to 0.0015 m"):
        Cells(32, LENGTH, bands.wavelength, 1).target(bands)
