"""The stage: its product on a small case, and the numbers of the paper on the paper's case."""

import numpy as np
import pytest

from pipeline.contract import ConfigError, settings
from stages.rupture import Settings, rupture

NONE = {"spacings": None, "stress_ratios": [], "damping_shares": [], "poisson_ratios": []}
SMALL = {"length": "4 mm", "height": "1 mm", "spacing": "50 um", "nucleation_length": "0.2 mm", "duration": "0.6 us",
         "frames": 4, "preload": "uniform", "field_spacing": "100 um", "studies": NONE}


def of(**values):
    return rupture(settings=settings.fill(Settings, {**SMALL, **values}, "test"))


@pytest.fixture(scope="module")
def paper():
    """The paper's case with a uniform pre-stress, without studies."""
    return rupture(settings=settings.fill(Settings, {"preload": "uniform", "studies": NONE}, "test"))


@pytest.mark.published
def test_both_fronts_of_the_paper(paper):
    """Section 3.2. Shear over pressure, mesh and damping are inferred from Figure 9, hence the tolerances.

    8.7 mm is read from a figure; the left front slows as it fades; the right one climbs with refinement.
    """
    assert paper.outcome.tolist() == ["stopped", "running"] and paper.kind.tolist() == ["pulse", "pulse"]
    assert paper.stop[0] == pytest.approx(8.7e-3, abs=0.15e-3)
    assert paper.speed == pytest.approx([1700, 980], abs=100)
    assert paper.speed[1] == pytest.approx(980, abs=40)
    assert paper.phrase == "the left front stops, the right one runs on"


@pytest.mark.published
def test_the_mach_cone_of_the_left_front(paper):
    """Figure 8: a Mach cone in both plates; the ridge is a few nodes wide, so 20 %."""
    assert paper.mach_known.tolist() == [[1, 1], [0, 0]]
    assert paper.mach_angle[0] == pytest.approx(paper.mach_expected[0], rel=0.2)


@pytest.mark.exact
def test_pictures_profiles_and_energies_belong_together(paper):
    assert paper.frame_time[-1] == pytest.approx(paper.duration.item()) == paper.profile_time[-1]
    assert len(paper.profile_time) == 11 and (np.diff(paper.slip.sum(axis=1)) > 0).all()
    assert paper.speed_field.shape == (40, paper.field_y.size, paper.field_x.size)
    energy = dict(zip(paper.energy_name.tolist(), paper.energy, strict=True))
    assert energy["released"] == pytest.approx(energy["heat"] + energy["kinetic"] + energy["strain"] + energy["taken"])
    assert 0 < energy["taken"] < 0.1 * energy["released"], "stiffness damping takes some"
    assert paper.opened == 0 and paper.node_updates == 2 * 801 * 201 * round(paper.duration / paper.step)


@pytest.mark.parametrize("ratio, phrase", [(0.5, "both fronts die"), (0.99, "neither front stops")])
def test_outcomes_are_named(ratio, phrase):
    settings_of = {"preload": "uniform", "stress_ratio": ratio, "duration": "1 us", "studies": NONE}
    found = rupture(settings=settings.fill(Settings, settings_of, "test"))
    assert found.phrase == phrase


def test_solids_too_unlike_for_an_interface_wave():
    found = of(lower={"youngs_modulus": "1 GPa"})
    assert found.interface_wave == 0 and found.generalised_rayleigh_speed == 0


def test_opening_is_named():
    """Very unlike solids under a shear beyond their pressure part behind the front."""
    found = of(lower={"youngs_modulus": "1 GPa"}, stress_ratio=1.4, friction={"static": 1.5}, duration="2 us",
               spacing="25 um")
    assert found.opened > 0 and str(found.phrase).endswith("the interface opens")
    assert (found.frame_state == 2).any() and of().opened == 0


def test_every_study_has_its_rows():
    studies = {"spacings": ["100 um", "50 um"], "stress_ratios": [0.5], "damping_shares": [0.1, 0.3],
               "poisson_ratios": [0.25], "mesh_poisson": 0.31}
    found = of(studies=studies, duration="0.2 us", preload="solved")
    assert found.study.tolist() == ["mesh"] * 8 + ["stress", "damping", "damping", "poisson"]
    assert sorted(set(found.study_memory)) == [0.0, pytest.approx(2e-8)]
    assert found.study_ratio[8] == 0.5 and found.study_damping[10] == 0.3
    assert found.shift.all()


def test_the_ratio_of_the_forces_makes_the_middle_slip_before_the_rupture():
    """With free side edges the shear gathers in the middle: local slip where the limit would be exceeded."""
    low, high = (of(preload="solved", ratio_of=which, duration="0.1 us", spacing="100 um")
                 for which in ("middle", "forces"))
    assert not low.static_slip.any()
    slipped = high.static_slip != 0.0
    assert slipped.any() and not slipped.all()
    np.testing.assert_allclose(high.static_shear[slipped], high.static_pressure[slipped], rtol=1e-8)


@pytest.mark.parametrize("values, message", [
    ({"stress_ratio": 1.2}, "stress_ratio: expected shear over pressure from 0 to below the static friction"),
    ({"nucleation_length": "80 um"}, "nucleation_length: expected 2 or more elements"),
    ({"step_share": 1.1}, "step_share: input should be less than or equal to 1, found 1.1"),
    ({"lower": {"youngs_modulus": "3 GPa", "poisson_ratio": 0.5}}, "poisson_ratio: input should be less than 0.5"),
    ({"lower_spacing": "40 um", "preload": "solved"}, "lower_spacing: expected matched interface nodes"),
    ({"field_spacing": "70 um"}, "field_spacing: expected a multiple of the spacing"),
    ({"studies": {**NONE, "spacings": ["1e-29 um"]}}, "mesh study: rupture.lower: elements of 1e-35 m: expected at"),
    ({"run_in": "2 mm"}, "run_in: expected less than half the length, 0.002 m, found 0.002 m"),
    ({"studies": {**NONE, "stress_ratios": [1.5]}}, "stress study: rupture.stress_ratio: expected shear over pressure"),
    ({"studies": {**NONE, "poisson_ratios": [0.5]}}, "poisson study: rupture.upper.poisson_ratio: expected a value be"),
    ({"studies": {**NONE, "damping_shares": [-0.1]}}, "damping study: rupture.damping_share: expected zero or more"),
    ({"studies": {**NONE, "spacings": ["0.2 mm"]}}, "mesh study: rupture.nucleation_length: expected 2 or more elem"),
])
def test_bad_input_is_refused_before_anything_runs(values, message):
    with pytest.raises(ConfigError, match=message):
        given = settings.fill(Settings, {**SMALL, **values}, "test")
        rupture.check({"rupture": given})
