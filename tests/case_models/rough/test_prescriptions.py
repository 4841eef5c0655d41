"""From a scan to the section of a generator, and from the section to surfaces."""

import numpy as np
import pytest

from pipeline.case_models.rough.prescriptions import MISS, deviation, fit, generated
from pipeline.case_models.rough.sections import FitSettings, Fitted
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.rough.generator import band_limit, self_affine
from pipeline.physics.rough.prescribed.heights import moments

GIVEN = {"rms_height": "2 um", "wavelengths": ["2 mm", "0.4 mm", "0.1 mm"], "variance_shares": [0.6, 0.4],
         "skewness": -0.5, "kurtosis": 3.5}


@pytest.fixture(scope="module")
def scan(tmp_path_factory):
    """Blunted hills, 110 x 120 pixels of 2 um."""
    rough = self_affine(np.random.default_rng(4), 120, 240e-6, 16e-6, 60e-6, 0.8)
    heights = 2e-6 * band_limit(-np.exp(-0.3 * rough), (240e-6,) * 2, 16e-6)[:110]
    path = tmp_path_factory.mktemp("scan") / "hills.txt"
    head = "# Channel: Topography\n# Width: 240 um\n# Height: 220 um\n# Value units: m\n"
    path.write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in heights))
    return path


def surface(**changes):
    choice = fill(Fitted, {**GIVEN, **changes}, "case: surface.pad")
    return generated(choice, 64, 1e-3, 0.1e-3, 3, "surface.pad")


def test_a_section_is_generated():
    heights = surface()
    assert heights.std() == pytest.approx(2e-6) and moments(heights) == pytest.approx((-0.5, 3.5), abs=0.01)


@pytest.mark.parametrize("wrong", [
    {"wavelengths": ["2 mm", "0.1 mm"]}, {"wavelengths": ["0.1 mm", "0.4 mm", "2 mm"]}, {"variance_shares": [0.0, 0.0]},
    {"direction_shares": [[1.0, 0.0]]}, {"direction_shares": [[1.0], [0.5, 0.5]]}, {"height_quantiles": [0.0, 1.0]},
    {"height_quantiles": list(np.linspace(4, -4, 41))}, {"kurtosis": 1.2}])
def test_keys_that_contradict_each_other_are_refused(wrong):
    with pytest.raises(ConfigError, match=rf"^surface.pad.{next(iter(wrong))}: expected"):
        surface(**wrong)


def test_what_a_fit_writes_makes_surfaces_like_the_scan(scan):
    document, lines = fit(FitSettings(file=str(scan), shortest_wavelength="16 um", seeds=2))
    section = document["surface"]
    assert section["patch_length"] == "200 um" and section["shortest_wavelength"] == "16 um"
    choice = fill(Fitted, section["pad"], "case: surface.pad")
    assert choice.tolerance == 0.05 and len(choice.wavelengths) == len(choice.variance_shares) + 1
    heights = generated(choice, section["nodes"], 200e-6, 16e-6, 7, "surface.pad")
    assert moments(heights) == pytest.approx((choice.skewness, choice.kurtosis), abs=0.02)
    assert lines[0].startswith("hills.txt: patches of 0.0002 m, waves down to 1.6e-05 m; means of 2 seeds")
    assert "missed by more than 5%: nothing" in lines


@pytest.mark.exact
def test_deviations_are_relative_but_of_an_ssk_near_none():
    assert deviation("Sq", 1e-6, 0.8e-6) == pytest.approx(0.2)
    assert deviation("Ssk", 1e-4, 0.0) == pytest.approx(0.01) and MISS == 0.05
    assert deviation("Ssk", -0.5, -0.4) == pytest.approx(0.2)


def test_the_body_is_chosen_and_coarse_pixels_are_refused(scan):
    given = {"file": str(scan), "patch_length": "100 um", "seeds": 1}
    assert list(fit(FitSettings(**given, shortest_wavelength="16 um", body="disc"))[0]["surface"])[-1] == "disc"
    with pytest.raises(ConfigError, match="expected pixels of at most 1.5e-06 m"):
        fit(FitSettings(**given, shortest_wavelength="3 um"))
    with pytest.raises(ConfigError, match="surface patch: expected at most"):
        fit(FitSettings(file=str(scan), patch_length="1 mm"))
