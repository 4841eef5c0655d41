"""Stage surface: generated and scanned bodies, refusals."""

from itertools import combinations

import h5py
import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.numerics import memory
from pipeline.physics.rough.generator import band_limit, resample, self_affine
from pipeline.physics.rough.worn_depth import without_plane
from pipeline.recordings.neutral import write_neutral
from stages.surface import Settings, surface

SMALL = {"nodes": 32, "shortest_wavelength": "125 um"}


def test_generated_surfaces():
    made = surface(settings=Settings(**SMALL))
    assert made.disc_height.shape == (1, 32, 32) and list(made.body) == ["disc", "pad"]
    np.testing.assert_allclose(made.rms_height, [3.5e-6, 3.8e-6], rtol=1e-12)
    np.testing.assert_allclose(made.nodes_per_wavelength, 4.0)
    assert made.source[1] == "generated: plateau_pad, seed 2"
    assert made.disc_depth[-1] == pytest.approx(1e-3)
    assert made.power_spectrum.shape == (2, made.wavenumber.size)


def test_bodies_are_called_as_the_case_calls_them():
    made = surface(settings=Settings(**SMALL, bodies=["disc", "pin"]))
    assert list(made.body) == ["disc", "pin"]
    assert np.array_equal(made.pad_height, surface(settings=Settings(**SMALL)).pad_height)


def test_a_scan_replaces_a_generator(tmp_path):
    heights = 1e-7 * self_affine(np.random.default_rng(3), 80, 1.2e-3, 60e-6, 300e-6, 0.8)
    heights[7, 9] += 1e-5
    head = "# Channel: Topography\n# Width: 1200 um\n# Height: 1200 um\n# Value units: m\n"
    (tmp_path / "pad.txt").write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in heights))
    scan = {"kind": "scan", "file": str(tmp_path / "pad.txt"), "rms_height": "2 um", "reason": "test"}
    made = surface(settings=fill(Settings, {**SMALL, "pad": scan}, "case: surface"))
    assert made.source[1] == "pad.txt"
    assert made.rms_height[1] == pytest.approx(2e-6, rel=1e-12)
    assert made.outlier_share[1] >= 1 / 6400 and made.filled_share[1] >= 1 / 6400
    turned = surface(settings=fill(Settings, {**SMALL, "pad": {**scan, "transposed": True}}, "case: surface"))
    np.testing.assert_allclose(turned.pad_height[0], made.pad_height[0].T, atol=1e-8)


def recorded(path, nodes=40):
    """A recorded map of the whole patch, with offset and tilt; returns it without."""
    heights = 3e-6 * self_affine(np.random.default_rng(3), nodes, 1e-3, 125e-6, 300e-6, 0.8)
    seen = heights + 1e-6 + 1e-6 * np.arange(nodes) / nodes
    write_neutral(path, {"new": {"description": "", "repeat_of": "", "conditions": {}, "channels": {}, "topography": {
        "pad_new": (seen, 1e-3 / nodes, "pad", "new")}}})
    return heights


def test_a_recorded_map_of_the_whole_patch_is_taken_as_it_is(tmp_path):
    heights = recorded(tmp_path / "a.h5")
    given = {"kind": "recorded", "file": str(tmp_path / "a.h5"), "map": "pad_new"}
    made = surface(settings=fill(Settings, {**SMALL, "pad": given}, "case: surface"))
    assert made.source[1] == "a.h5: new/pad_new" and made.outlier_share[1] == 0
    exact = resample(band_limit(without_plane(heights), (1e-3, 1e-3), 125e-6), (32, 32))
    np.testing.assert_allclose(made.pad_height[0], exact, atol=1e-15)
    with pytest.raises(ConfigError, match=r"surface.pad.map: expected one of pad_new in run new.*found disc"):
        surface(settings=fill(Settings, {**SMALL, "pad": {**given, "map": "disc"}}, "case: surface"))
    with pytest.raises(ConfigError, match="surface.pad.map: expected the whole patch, 0.002 m"):
        surface(settings=fill(Settings, {**SMALL, "patch_length": "2 mm", "shortest_wavelength": "250 um",
                                         "pad": given}, "case: surface"))


def test_a_scan_needs_its_height_and_reason(tmp_path):
    (tmp_path / "pad.txt").write_text("")
    scan = {"kind": "scan", "file": str(tmp_path / "pad.txt"), "rms_height": "2 um"}
    with pytest.raises(ConfigError, match="reason"):
        fill(Settings, {"pad": scan}, "case: surface")


def test_a_missing_scan_is_refused_before_anything_runs():
    with pytest.raises(ConfigError, match="expected a file, found none"):
        fill(Settings, {"disc": {"kind": "scan", "file": "none.x3p", "rms_height": "2 um", "reason": "test"}}, "case")


def test_a_wavelength_below_two_nodes_is_refused():
    with pytest.raises(ConfigError, match="two grid spacings"):
        surface(settings=Settings(nodes=32, shortest_wavelength="40 um"))


def test_further_pairs_are_other_surfaces_of_the_same_kind_and_the_first_stays():
    one, four = surface(settings=Settings(**SMALL)), surface(settings=Settings(**SMALL, pairs=4))
    for name in ("disc_height", "pad_height"):
        each = getattr(four, name)
        assert each.shape == (4, 32, 32) and np.array_equal(each[0], getattr(one, name)[0])
        assert max(abs(np.corrcoef(a.ravel(), b.ravel())[0, 1]) for a, b in combinations(each, 2)) < 0.95
        np.testing.assert_allclose(each.std(axis=(1, 2)), each[0].std(), rtol=1e-12)
    assert four.source[1] == "generated: plateau_pad, seed 2 and 3 further"


def test_pairs_of_a_scan_are_crops_side_by_side(tmp_path):
    heights = 1e-7 * self_affine(np.random.default_rng(3), 160, 2.4e-3, 60e-6, 300e-6, 0.8)
    head = "# Channel: Topography\n# Width: 2400 um\n# Height: 2400 um\n# Value units: m\n"
    (tmp_path / "pad.txt").write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in heights))
    pad = {"kind": "scan", "file": str(tmp_path / "pad.txt"), "rms_height": "2 um", "reason": "test"}
    made = surface(settings=fill(Settings, {**SMALL, "pad": pad, "pairs": 4}, "case: surface"))
    assert made.pad_height.shape == (4, 32, 32)
    assert max(abs(np.corrcoef(a.ravel(), b.ravel())[0, 1]) for a, b in combinations(made.pad_height, 2)) < 0.5
    with pytest.raises(ConfigError, match=r"surface.pairs: .*pad.txt: expected at most 4, as many patches of 0.001 m"):
        surface(settings=fill(Settings, {**SMALL, "pad": pad, "pairs": 5}, "case: surface"))


def scanned(path, heights, size=(1200, 1200)):
    """A pad of a scan (text matrix) of ``size`` (x, y) in um."""
    head = f"# Channel: Topography\n# Width: {size[0]} um\n# Height: {size[1]} um\n# Value units: m\n"
    path.write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in heights))
    return {"kind": "scan", "file": str(path), "rms_height": "2 um", "reason": "test"}


def of_pad(pad, **more):
    return surface(settings=fill(Settings, {**SMALL, "pad": pad, **more}, "case: surface"))


ROUGH = 1e-6 * self_affine(np.random.default_rng(3), 96, 1.2e-3, 60e-6, 300e-6, 0.8)


def test_scans_in_a_wrong_unit_are_asked_back(tmp_path):
    pad = scanned(tmp_path / "pad.txt", 1e3 * ROUGH)
    with pytest.raises(ConfigError, match=r"surface.pad: .*pad.txt: expected an rms height .* height_unit: 0.001 m"):
        of_pad(pad)
    right = of_pad(scanned(tmp_path / "right.txt", ROUGH))
    np.testing.assert_allclose(of_pad({**pad, "height_unit": "1 mm"}).pad_height, right.pad_height, atol=1e-9)


def test_recorded_maps_in_a_wrong_unit_or_on_coarse_pixels_are_refused(tmp_path):
    recorded(tmp_path / "a.h5")
    given = {"kind": "recorded", "file": str(tmp_path / "a.h5"), "map": "pad_new"}
    with pytest.raises(ConfigError, match="surface.pad.map: expected pixels of at most 2e-05 m"):
        of_pad(given, nodes=64, shortest_wavelength="40 um")
    truth = of_pad(given)
    np.testing.assert_allclose(of_pad({**given, "height_unit": "0.5 m"}).pad_height, 0.5 * truth.pad_height)
    with h5py.File(tmp_path / "a.h5", "r+") as file:
        file["runs/new/topography/pad_new"].attrs["units"] = "mm"
    assert of_pad(given).rms_height[1] == pytest.approx(1e-3 * truth.rms_height[1])
    with h5py.File(tmp_path / "a.h5", "r+") as file:
        file["runs/new/topography/pad_new"].attrs["units"] = "km"
    with pytest.raises(ConfigError, match="surface.pad.map: expected an rms height Sq of 1 nm to 100 um"):
        of_pad(given)


def test_scans_of_holes_are_refused_as_a_whole_and_in_their_patch(tmp_path):
    holed = ROUGH.copy()
    holed[:50] = np.nan
    with pytest.raises(ConfigError, match=r"surface.pad: .*holes.txt: expected measured heights"):
        of_pad(scanned(tmp_path / "holes.txt", holed))
    holed = ROUGH.copy()
    holed[20:76, 20:76] = np.nan
    with pytest.raises(ConfigError, match=r"surface.pad: .*holes.txt: patch: expected measured heights"):
        of_pad(scanned(tmp_path / "holes.txt", holed), patch_length="0.75 mm")


def test_pixels_need_not_be_square(tmp_path):
    """The same band-limited surface on every second row is the same patch."""
    fine = of_pad(scanned(tmp_path / "fine.txt", ROUGH)).pad_height
    oblong = of_pad(scanned(tmp_path / "oblong.txt", ROUGH[::2])).pad_height
    assert np.abs(fine - oblong).max() < 0.25 * fine.std() and np.corrcoef(fine.ravel(), oblong.ravel())[0, 1] > 0.995


def test_grids_beyond_memory_are_refused_before_they_are_made(monkeypatch):
    monkeypatch.setattr(memory, "available_memory", lambda: int(1e9))
    with pytest.raises(ConfigError, match="surface.nodes: expected .* GB for 1 pairs of maps of 2000000 x 2000000"):
        surface(settings=Settings(nodes=2_000_000))
    with pytest.raises(ConfigError, match="surface.shortest_wavelength: expected 2.9 GB for generating"):
        surface(settings=Settings(nodes=2000, shortest_wavelength="1 um"))


def test_fitted_surfaces_of_several_seeds():
    pad = {"kind": "fitted", "rms_height": "2 um", "wavelengths": ["2 mm", "0.4 mm", "0.125 mm"],
           "variance_shares": [0.6, 0.4], "skewness": -0.5, "kurtosis": 3.5}
    made = of_pad(pad, pairs=3)
    assert made.pad_height.shape == (3, 32, 32) and made.source[1] == "generated: fitted, seed 1 and 2 further"
    assert (made.rms_height[1], made.skewness[1]) == pytest.approx((2e-6, -0.5), rel=0.02)
    assert made.kurtosis[1] == pytest.approx(3.5, rel=0.02)
    np.testing.assert_array_equal(made.pad_height[0], of_pad(pad).pad_height[0])
