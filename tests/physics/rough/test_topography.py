"""Reading, cleaning and describing scans; bad files end in one clear error."""

import os
import re
from pathlib import Path

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.topography import (
    isotropic_spectrum,
    level,
    read_scan,
    remove_outliers,
    statistics,
    to_grid,
)
from tests.fuzz.semantics import scans

SPACING = (2e-6, 1e-6)
SCANS = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "surfaces"


def write(path, heights, spacing=SPACING):
    """A text matrix with the header that Gwyddion writes."""
    size = heights.shape[1] * spacing[1] * 1e6, heights.shape[0] * spacing[0] * 1e6
    head = f"# Channel: Topography\n# Width: {size[0]:.9g} um\n# Height: {size[1]:.9g} um\n# Value units: m\n"
    path.write_text(head + "\n".join(" ".join(f"{v:.9e}" for v in row) for row in heights) + "\n")
    return path


@pytest.fixture
def rough():
    return 1e-6 * self_affine(np.random.default_rng(5), 96, 96e-6, 8e-6, 30e-6, 0.8)


def test_reading_keeps_orientation_size_and_unit(tmp_path, rough):
    scan = read_scan(write(tmp_path / "scan.txt", rough[:60]))
    assert scan.heights.shape == (60, 96)
    np.testing.assert_allclose(scan.spacing, SPACING, rtol=1e-6)
    np.testing.assert_allclose(scan.heights, rough[:60], atol=1e-14)


def test_unreadable_and_empty_files_are_named(tmp_path):
    for content in (b"", b"\x00\x01\x02 no scan" * 50):
        file = tmp_path / "broken.dat"
        file.write_bytes(content)
        with pytest.raises(ConfigError, match=r"broken\.dat: expected a surface scan"):
            read_scan(file)


@pytest.mark.parametrize("value, complaint", [(np.nan, "no value that is a number"), (2e-6, "constant surface")])
def test_maps_without_heights_are_refused(tmp_path, value, complaint):
    with pytest.raises(ConfigError, match=rf"flat\.txt.*{complaint}"):
        read_scan(write(tmp_path / "flat.txt", np.full((8, 8), value)))


def test_a_map_without_physical_size_is_refused(tmp_path):
    np.savetxt(tmp_path / "bare.txt", np.random.default_rng(0).random((8, 8)))
    with pytest.raises(ConfigError, match=r"bare\.txt"):
        read_scan(tmp_path / "bare.txt")


def test_spikes_go_and_deep_pits_stay(rough):
    dirty = rough.copy()
    dirty[40:48, 50:58] -= 20e-6
    spikes = ([5, 20, 70, 90, 11], [7, 80, 33, 60, 41])
    dirty[spikes] += np.array([8, -8, 15, 9, -12]) * 1e-6
    cleaned, share = remove_outliers(dirty, 8.0)
    assert np.isnan(cleaned[spikes]).all()
    assert np.isfinite(cleaned[42:46, 52:56]).all()
    assert share <= (5 + 4 * 3) / rough.size
    assert remove_outliers(rough, 8.0)[1] == 0.0


def test_missing_samples_are_not_outliers(rough):
    holed = rough.copy()
    holed[30:35, 30:35] = np.nan
    cleaned, share = remove_outliers(holed, 8.0)
    assert share == 0.0 and np.isnan(cleaned).sum() == 25


@pytest.mark.exact
def test_levelling_removes_a_quadratic_form(rough):
    y, x = np.indices(rough.shape) / 96.0
    form = 1e-5 * (1.0 + 3.0 * x - 2.0 * y + x * y + 4.0 * x ** 2 - y ** 2)
    plain, _ = level(rough, SPACING)
    bent, filled = level(rough + form, SPACING)
    np.testing.assert_allclose(bent, plain, atol=1e-15)
    assert filled == 0.0


def test_holes_are_filled_between_their_rims(rough):
    holed = rough.copy()
    holed[30:34, 30:34] = np.nan
    whole, filled = level(holed, SPACING)
    assert filled == 16 / rough.size
    assert np.abs(whole - level(rough, SPACING)[0])[30:34, 30:34].max() < 3.0 * rough.std()
    assert np.isfinite(whole).all()


def test_the_grid_has_the_band_and_the_height_asked_for(rough):
    with pytest.raises(ConfigError, match="test: expected pixels of at most 8e-06 m, .* found 9e-06 m"):
        to_grid(rough, (1e-6, 9e-6), 64e-6, 32, 16e-6, 32e-6, 3e-6, "test")
    grid = to_grid(rough, (1e-6, 1e-6), 64e-6, 32, 16e-6, 32e-6, 3e-6, "test")
    assert grid.std() == pytest.approx(3e-6, rel=1e-12)
    wave = np.hypot(*np.meshgrid(np.fft.fftfreq(32, 2e-6), np.fft.fftfreq(32, 2e-6)))
    power = np.abs(np.fft.fft2(grid)) ** 2
    outside = (wave > 1.001 / 16e-6) | (wave < 0.999 / 32e-6)
    assert power[outside].max() < 1e-20 * power.max()


@pytest.mark.exact
def test_statistics_of_a_wave():
    x = np.arange(64) / 64
    found = statistics(np.tile(2e-6 * np.cos(2 * np.pi * x), (64, 1)), (1e-3 / 64,) * 2)
    assert found.rms_height == pytest.approx(2e-6 / np.sqrt(2), rel=1e-12)
    assert found.mean_height == pytest.approx(2e-6 * 2 / np.pi, rel=2e-3)
    assert found.peak_to_valley == pytest.approx(4e-6, rel=1e-12)
    assert found.skewness == pytest.approx(0.0, abs=1e-12) and found.kurtosis == pytest.approx(1.5, rel=1e-12)
    assert found.rms_slope == pytest.approx(2e-6 * 2 * np.pi / 1e-3 / np.sqrt(2), rel=0.01)


@pytest.mark.exact
def test_spectrum_integrates_to_the_variance():
    heights = self_affine(np.random.default_rng(1), 128, 1e-3, 60e-6, 300e-6, 0.8) * 1e-6
    wave, power = isotropic_spectrum(heights, (1e-3 / 128,) * 2)
    inside = wave < 2 * np.pi / 60e-6
    assert np.trapezoid((power * wave)[inside] / (2 * np.pi), wave[inside]) == pytest.approx(1e-12, rel=0.25)
    assert power[wave > 2 * np.pi / 50e-6].max() < 1e-20 * power.max()


@pytest.mark.measured
@pytest.mark.parametrize("name", ["plu-1.plu", "metropro-1.dat", "x3p-2.x3p", "opd-1.opd", "al3d-1.al3d"])
def test_real_scans_are_read_and_cleaned(name):
    if not (SCANS / name).is_file():
        pytest.skip(f"no {name} in {SCANS}; set BRAKECHAIN_DATA")
    scan = read_scan(SCANS / name)
    cleaned, share = remove_outliers(scan.heights, 8.0)
    levelled, filled = level(cleaned, scan.spacing)
    assert 0.0 <= share < 0.05 and filled >= share
    assert 1e-9 < levelled.std() < 1e-4
    assert 5e-8 < scan.spacing[0] < 5e-6


def gwyddion(path, channels, size=96e-6):
    """A file of Gwyddion with channels [(title, heights, unit)] of one shape, ``size`` m along both sides."""
    path.write_bytes(scans.gwyddion(channels, [size / count for count in channels[0][1].shape]))
    return path


def test_of_several_channels_of_heights_one_is_asked_for(tmp_path, rough):
    heights, error = rough[:60], 0.1 * rough[:60]
    file = gwyddion(tmp_path / "a.gwy", [("Amplitude error", error, "m"), ("Topography", heights, "m"),
                                         ("Phase", error, "deg")])
    with pytest.raises(ConfigError, match="channel: expected one channel of heights, found 2: Amplitude error,"
                                          " Topography; state which .* such as channel: Topography"):
        read_scan(file)
    scan = read_scan(file, "Topography")
    np.testing.assert_allclose(scan.heights, heights, atol=1e-14)
    assert scan.told == "channel Topography"
    for other in ("Phase", "Height"):
        with pytest.raises(ConfigError, match=f"one of Amplitude error, Topography, found '{other}'"):
            read_scan(file, other)


def test_the_only_channel_of_heights_is_taken_and_equal_names_are_numbered(tmp_path, rough):
    file = gwyddion(tmp_path / "a.gwy", [("Intensity", rough, "V"), ("Height", rough, "m")])
    np.testing.assert_allclose(read_scan(file).heights, rough, atol=1e-14)
    assert read_scan(gwyddion(tmp_path / "b.gwy", [("Z", rough, "m")])).told == ""
    twice = gwyddion(tmp_path / "c.gwy", [("Height", rough, "m"), ("Height", 2 * rough, "m")])
    np.testing.assert_allclose(read_scan(twice, "Height (2)").heights, 2 * rough, atol=1e-14)


@pytest.mark.parametrize("names, wanted, place", [
    (("Height Trace", "Height Retrace"), "Height Retrace", 1), (("Z Axis", "Z Sensor", "Phase"), "Z Sensor", 1),
    (("Amplitude", "Topo", "Topo", "Intensity"), "Topo (3)", 2)])
def test_channels_of_other_instruments_are_asked_for_too(tmp_path, rough, names, wanted, place):
    """Scanning probes save each line twice or by two sensors, optical ones several results of one measurement."""
    units = {"Phase": "deg", "Intensity": "V"}
    channels = [(name, (k + 1) * rough, units.get(name, "m")) for k, name in enumerate(names)]
    file = gwyddion(tmp_path / "a.gwy", channels)
    with pytest.raises(ConfigError, match=f"one channel of heights, found [23]: .*{re.escape(wanted)}.*; state which"):
        read_scan(file)
    np.testing.assert_allclose(read_scan(file, wanted).heights, (place + 1) * rough, atol=1e-14)
