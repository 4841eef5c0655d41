"""Generators: rms, band, periodicity, seeds, the same surface on every grid."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.generator import band_limit, plateau_pad, resample, self_affine, turned_disc

LENGTH, SHORTEST = 1e-3, 62.5e-6
DISC = {"seed": 1, "feed": 250e-6, "marks_share": 0.9, "roughness_wavelength": 250e-6, "hurst": 0.8,
        "outbreak_share": 0.03, "outbreak_size": 80e-6, "outbreak_depth": 3.0}
PAD = {"seed": 2, "plateau_share": 0.25, "plateau_size": 250e-6, "plateau_height": 1.0, "plateau_roughness": 6.0,
       "edge_width": 0.2, "roughness_wavelength": 250e-6, "hurst": 0.8}


def disc(nodes=64, **changes):
    return turned_disc(nodes, LENGTH, SHORTEST, 3e-6, **{**DISC, **changes})


def pad(nodes=64, **changes):
    return plateau_pad(nodes, LENGTH, SHORTEST, 4e-6, **{**PAD, **changes})


@pytest.mark.exact
@pytest.mark.parametrize("surface, rms", [(disc, 3e-6), (pad, 4e-6)])
def test_height_and_band(surface, rms):
    heights = surface()
    assert heights.std() == pytest.approx(rms, rel=1e-12)
    assert abs(heights.mean()) < 1e-12 * rms
    np.testing.assert_allclose(band_limit(heights, (LENGTH, LENGTH), SHORTEST), heights, atol=1e-12 * rms)


@pytest.mark.exact
@pytest.mark.parametrize("surface", [disc, pad])
def test_same_surface_on_every_grid(surface):
    np.testing.assert_allclose(surface(128)[::2, ::2], surface(64), atol=1e-11)


@pytest.mark.parametrize("surface", [disc, pad])
def test_seed_decides(surface):
    np.testing.assert_array_equal(surface(), surface())
    assert np.corrcoef(surface(seed=8, **({"marks_share": 0.0} if surface is disc else {})).ravel(),
                       surface().ravel())[0, 1] < 0.5


def test_turning_marks_run_along_sliding_with_the_feed():
    heights = disc(outbreak_share=0.0)
    slope_y, slope_x = np.gradient(heights)
    assert slope_y.std() > 3.0 * slope_x.std()
    profile = np.abs(np.fft.rfft(heights.mean(axis=1)))
    assert np.argmax(profile) == round(LENGTH / DISC["feed"])


def test_outbreaks_are_pits():
    def skewness(h):
        return (h ** 3).mean() / h.std() ** 3

    whole, pitted = disc(marks_share=0.0, outbreak_share=0.0), disc(marks_share=0.0, outbreak_depth=6.0)
    assert skewness(pitted) < skewness(whole) - 0.5


def test_plateaus_are_skewed_and_peaked():
    heights = pad() / 4e-6
    assert (heights ** 3).mean() > 0.5 and (heights ** 4).mean() > 4.0


@pytest.mark.exact
def test_self_affine_spectrum_falls_with_the_hurst_exponent():
    size = 256
    power = np.mean([np.abs(np.fft.fft2(self_affine(np.random.default_rng(s), size, 1.0, 1 / 100, 1 / 8, 0.7))) ** 2
                     for s in range(20)], axis=0)
    wave = np.hypot(*np.meshgrid(np.fft.fftfreq(size, 1 / size), np.fft.fftfreq(size, 1 / size)))
    low, high = (power[np.abs(wave - k) < 1.0].mean() for k in (20, 80))
    assert np.log(low / high) / np.log(4.0) == pytest.approx(2.0 + 2.0 * 0.7, abs=0.15)
    flat = [power[np.abs(wave - k) < 1.0].mean() for k in (3, 6)]
    assert flat[0] == pytest.approx(flat[1], rel=0.25)
    assert power[wave > 100.5].max() < 1e-20 * power.max()


@pytest.mark.exact
def test_resampling_reproduces_a_wave():
    wave = np.cos(2 * np.pi * 3 * np.arange(20) / 20)[None, :] * np.ones((12, 1))
    fine = np.cos(2 * np.pi * 3 * np.arange(50) / 50)[None, :] * np.ones((16, 1))
    np.testing.assert_allclose(resample(wave, (16, 50)), fine, atol=1e-13)
    np.testing.assert_allclose(resample(fine, (12, 20)), wave, atol=1e-13)


@pytest.mark.parametrize("feed", [20e-6, 50e-6])
def test_marks_shorter_than_the_surface_holds_are_refused(feed):
    """On 62.5 um a feed of 20 um would show as waves of 71 um, one of 50 um would lose most of its marks."""
    with pytest.raises(ConfigError, match="feed of the turned disc: expected at least 6.25e-05 m"):
        turned_disc(128, 1e-3, 62.5e-6, 3e-6, **{**DISC, "feed": feed})


def test_a_wavelength_beyond_the_patch_is_refused():
    with pytest.raises(ConfigError, match="shortest wavelength <= patch length"):
        turned_disc(64, LENGTH, 2e-3, 3e-6, **DISC)
