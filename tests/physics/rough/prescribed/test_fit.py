"""What a scan prescribes, and that surfaces generated from it have its figures."""

import os
from pathlib import Path

import numpy as np
import pytest

from pipeline.physics.rough.generator import band_limit, construction_size, self_affine
from pipeline.physics.rough.prescribed.fit import figures, fitted, largest_patch, mean_figures
from pipeline.physics.rough.prescribed.generator import prescribed_surface
from pipeline.physics.rough.prescribed.heights import moments
from pipeline.physics.rough.topography import level, read_scan, remove_outliers, statistics

PIXEL = 2e-6
SCANS = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "surfaces"


@pytest.fixture(scope="module")
def plateaus():
    """A scan of blunted hills and deep valleys: Ssk -1.6, Sku 5.8."""
    rough = self_affine(np.random.default_rng(4), 300, 300 * PIXEL, 8 * PIXEL, 60e-6, 0.8)
    return 2e-6 * band_limit(-np.exp(-0.5 * rough), (300 * PIXEL,) * 2, 8 * PIXEL)[:220]


def close(made, scan):
    for name in ("rms_height", "skewness", "kurtosis", "rms_slope"):
        assert getattr(made, name) == pytest.approx(getattr(scan, name), rel=0.05), name
    np.testing.assert_allclose(made.variance, scan.variance, rtol=0.05, atol=1e-12)


def generated(fit, seeds):
    size = construction_size(fit.length, fit.shortest)
    return [prescribed_surface(size, fit.length, fit.shortest, fit.figures.rms_height, seed=seed, bands=fit.bands,
                               heights=fit.heights, tolerance=0.05) for seed in range(seeds)]


@pytest.mark.exact
def test_figures_of_waves():
    x = np.tile(2e-6 * np.cos(2 * np.pi * 4 * np.arange(128) / 128), (128, 1))
    result = figures(x + 1e-6, 1e-3, [2e-3, 0.4e-3, 0.1e-3])
    assert result.rms_height == pytest.approx(2e-6 / np.sqrt(2)) and result.peak_to_valley == pytest.approx(4e-6)
    assert (result.skewness, result.kurtosis) == pytest.approx((0.0, 1.5), abs=1e-9)
    np.testing.assert_allclose(result.variance, [0.0, 1.0], atol=1e-12)
    assert result.rms_slope == pytest.approx(statistics(x, (1e-3 / 128,) * 2).rms_slope)


def test_the_largest_patch_leaves_room_for_its_overlap():
    assert largest_patch((110, 330), (1e-6, 2e-6)) == pytest.approx(100e-6)


def test_generated_surfaces_have_the_figures_of_a_scan_that_is_not_gaussian(plateaus):
    assert moments(plateaus)[0] < -1.0 and moments(plateaus)[1] > 4.5
    fit = fitted(plateaus, (PIXEL, PIXEL), largest_patch(plateaus.shape, (PIXEL, PIXEL)), 8 * PIXEL)
    close(mean_figures(generated(fit, 5), fit.length, fit.bands.wavelength), fit.figures)


def test_patches_all_over_the_scan_are_averaged(plateaus):
    fit = fitted(plateaus, (PIXEL, PIXEL), 200e-6, 8 * PIXEL)
    assert fit.figures.rms_height == pytest.approx(plateaus.std(), rel=0.15)
    assert fit.heights.kurtosis == pytest.approx(fit.figures.kurtosis, rel=1e-12)
    np.testing.assert_allclose(fit.bands.variance, fit.figures.variance, rtol=1e-9, atol=1e-15)


def test_a_long_cut_off_leaves_bands_empty(plateaus):
    fit = fitted(plateaus, (PIXEL, PIXEL), 300e-6, 8 * PIXEL, 180e-6)
    assert fit.bands.variance[0] == 0.0 and np.all(fit.bands.variance[1:] > 0.0)
    close(mean_figures(generated(fit, 2), fit.length, fit.bands.wavelength), fit.figures)


@pytest.mark.measured
@pytest.mark.parametrize("name", ["al3d-1.al3d", "di-1.di", "metropro-1.dat", "opd-1.opd", "plu-1.plu", "x3p-2.x3p"])
def test_generated_surfaces_have_the_figures_of_real_scans(name):
    if not (SCANS / name).is_file():
        pytest.skip(f"no {name} in {SCANS}; set BRAKECHAIN_DATA")
    scan = read_scan(SCANS / name, "Height (1)" if name == "di-1.di" else None)
    heights, _ = level(remove_outliers(scan.heights, 8.0)[0], scan.spacing)
    fit = fitted(heights, scan.spacing, largest_patch(heights.shape, scan.spacing), 8 * max(scan.spacing))
    close(mean_figures(generated(fit, 2), fit.length, fit.bands.wavelength), fit.figures)
