"""Stage beam_on_beam and the stages after it: coalescences, modes on the hard contact, steady load."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.stability.constrained_modes import critical_friction
from pipeline.validation.beam_on_beam import beam_on_beam_rows
from stages.beam_on_beam import beam_on_beam
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from tests.stages.small_beams import SETTINGS, beams, model


@pytest.fixture(scope="module")
def modes():
    return complex_modes(model(), None, settings=Modes(speeds=["-2 mrad/s"], friction=0.2, friction_max=0.5,
                                                       friction_steps=51, frequency_max="12 kHz"))


@pytest.mark.published
def test_coalescences_of_the_paper():
    """400 Hz at 0.16, 2800 Hz at 0.12, 7700 Hz at 0.23, each within 5 % and 0.04, and no other below 0.5."""
    found = beams()
    shown = found.onset_friction < 0.5
    np.testing.assert_allclose(found.onset_frequency[shown], [400, 2800, 7700], rtol=0.05)
    np.testing.assert_allclose(found.onset_friction[shown], [0.16, 0.12, 0.23], atol=0.04)
    np.testing.assert_allclose(found.closed_frequency[4:6], [2500, 3100], rtol=0.05)


@pytest.mark.exact
def test_plane_elements_find_the_same_coalescences():
    found = beams()
    np.testing.assert_allclose(found.check_onset_frequency, found.onset_frequency, rtol=0.01)
    np.testing.assert_allclose(found.check_onset_friction, found.onset_friction, atol=0.02)
    np.testing.assert_allclose(found.check_frequency, found.closed_frequency, rtol=0.01)


@pytest.mark.exact
def test_complex_modes_lie_on_the_curve_and_flutter_where_it_ends(modes):
    """Without damping, modes at friction 0 are the zeros of the curve; damping moves the onset up a little."""
    found = beams()
    told = modes.real_frequency[0]
    for frequency in found.closed_frequency:
        assert np.min(abs(told / frequency - 1)) < 1e-3
    sliding = sliding_model(model(), 0, -2e-3)
    for frequency, friction in zip(found.onset_frequency[:2], found.onset_friction[:2], strict=True):
        assert friction < critical_friction(sliding, frequency, 0.05, friction + 0.03) < friction + 0.01


@pytest.mark.published
def test_exactly_two_unstable_modes_at_friction_0_2(modes):
    unstable = np.sort(modes.unstable_root.imag) / (2 * np.pi)
    np.testing.assert_allclose(unstable, [400, 2800], rtol=0.05)


@pytest.mark.exact
def test_contact_carries_the_weight_whatever_the_friction(modes):
    np.testing.assert_allclose(modes.operating_force, SETTINGS.contact.force)
    assert model().pressure[0] * model().input_area[0] == pytest.approx(SETTINGS.contact.force)


def test_findings_are_copied_and_others_refused(tmp_path):
    path = tmp_path / "found.yaml"
    path.write_text("- {what: a, found: b}\n")
    told = beam_on_beam(settings=SETTINGS.model_copy(update={"findings": path}))
    assert list(told.finding) == ["a"] and list(told.finding_text) == ["b"]
    path.write_text("- {what: a}\n")
    with pytest.raises(ConfigError, match="found"):
        beam_on_beam(settings=SETTINGS.model_copy(update={"findings": path}))


def test_rows_of_the_comparison(modes):
    known = {"coalescence_low": 400.0, "coalescence_middle": 2800.0, "coalescence_high": 7700.0, "friction_drawn": 0.5}
    rows = beam_on_beam_rows({"beam_on_beam": beams(), "complex_modes": modes}, (), known)
    assert rows["coalescence_count"].value == 3 and rows["unstable_at_friction"].value == 2
    assert rows["coalescence_high_friction"].value == beams().onset_friction[2]
    far = beam_on_beam_rows({"beam_on_beam": beams()}, (), {**known, "coalescence_low": 40.0})
    assert far["coalescence_low"].value is None and "no modes coalesce" in far["coalescence_low"].note
