"""Harmonics of a flutter pair over a belt: mechanisms switched off, and what a step and a window hide."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.published.harmonics import (
    Harmonics,
    growing,
    harmonics_problem,
    harmonics_reasons,
    outcomes,
    shown,
    stepped,
    unstepped,
)
from pipeline.products import ComplexModes, Lines, Recording, Run
from tests.diagnosis.solving import solved as diagnosed
from tests.stages.test_transient import growing_root, pair
from tests.views.products_for_views import filled

TOLD = {"kind": "harmonics", "run": "test", "spectra": {"x": {"list": "x"}}, "lines": 4, "speed": "20 mrad/s",
        "step": "10 us", "duration": "0.8 s", "window": "0.3 s", "lowest_frequency": "20 Hz", "contact": "penalty",
        "contact_stiffness": "0.4 N/um", "contact_damping": "100 N s/m", "friction": 0.6,
        "published": {"run": "test", "list": "x", "step": "100 us", "window": "30 ms", "band": "400 Hz"}}
MODES = filled(ComplexModes, unstable_operating=[0, 0], unstable_root=[5 + 900j, growing_root()])


def told(**more):
    return fill(Harmonics, {**TOLD, **more}, "diagnosis.lines")


def recording(base, standing):
    empty = {kind: {} for kind in ("conditions", "channels", "frf", "modes", "topography", "friction")}
    order = np.flatnonzero(standing) + 1
    lines = Lines(label=[str(k) for k in order], frequency=base * order, frequency_tolerance=0.02 * base * order,
                  level=np.zeros(len(order)), level_known=np.zeros(len(order), int), partners=np.zeros(len(order), int),
                  diameters=np.full(len(order), -1), place="x")
    return Recording(source=[], runs={"test": Run(description="", repeat_of="", lines={"x": lines}, **empty)})


@pytest.fixture(scope="module")
def motions():
    return shown(pair(), told())


def test_each_mechanism_is_switched_off_by_the_operating_point(motions):
    assert motions["loss_of_contact"].stick_share < 1e-3 and motions["stick"].open_share == 0
    assert motions["stick"].stick_share > 0.05


def test_the_mechanism_whose_lines_were_recorded_is_named(motions):
    """Lines of the stick-slip motion are recorded; small motion in permanent contact has one."""
    seen = motions["stick"]
    standing = seen.levels["x"] > -60
    assert standing.sum() > 1, "the cycle has harmonics"
    recorded = recording(seen.base, standing)
    found = diagnosed(harmonics_problem(recorded, told(), motions, MODES), kept=9, draws=2000)
    assert "stick at contact" in [c.name for c in found.decision.named]
    told_so = harmonics_reasons(recorded, told(), motions, MODES)
    assert any(f"stick: base {seen.base:.0f} Hz" in r for r in told_so)


def test_one_line_at_the_growing_mode_is_consistent_with_small_motion(motions):
    base = growing_root().imag / (2 * np.pi)
    asked = harmonics_problem(recording(base, [1, 0, 0, 0]), told(), motions, MODES)
    found = diagnosed(asked, kept=9, draws=2000)
    assert found.decision.verdict == "consistent"


def test_the_fastest_growing_mode_counts():
    assert growing(MODES) == growing_root()
    with pytest.raises(ConfigError, match="a model of which a mode grows"):
        growing(filled(ComplexModes, unstable_operating=[], unstable_root=np.empty(0, complex)))


def test_the_trapezoidal_rule_shows_lower_frequencies():
    """Newmark's average acceleration: w h / 2 -> arctan(w h / 2); 2250 Hz at 4e-5 s appear at 2193 Hz."""
    assert stepped(2250.0, 4e-5) == pytest.approx(2193, abs=0.5)
    assert unstepped(stepped(1500.0, 4e-5), 4e-5) == pytest.approx(1500)
    assert stepped(1500.0, 1e-9) == pytest.approx(1500)


def test_what_step_window_and_band_hide_is_told(motions):
    said = " ".join(harmonics_reasons(recording(150.0, [1, 1, 1, 1]), told(), motions, MODES))
    assert f"the mode behind it lies at {unstepped(150.0, 1e-4):.0f} Hz" in said
    assert "lines of 30 ms are 33 Hz apart" in said
    assert f"spectra to 0.4 kHz hold {int(400 // motions['loss_of_contact_and_stick'].base)} of 4 lines" in said


@pytest.mark.exact
def test_amplitudes_scale_with_what_switches_a_mechanism(motions):
    """Loss of contact alone: the load, stick alone: the speed; a whole motion of its own shows it."""
    found = outcomes(pair(), told(), motions, ["loss_of_contact", "stick", "loss_of_contact_and_stick"])
    load, speed = (next(v for k, v in found.items() if k.startswith(name)) for name in ("normal_load", "speed"))
    assert load["loss_of_contact"] * 0.115 == pytest.approx([np.log(2)]) and load["stick"] == [0]
    assert speed["stick"] * 0.115 == pytest.approx([np.log(2)]) and speed["loss_of_contact"] == [0]
    slow = shown(pair(), told(speed="40 mrad/s"))["stick"]
    assert slow.amplitude["x"] / motions["stick"].amplitude["x"] == pytest.approx(2, rel=0.02)
    whole = sum(one["loss_of_contact_and_stick"][0] * 0.115 for one in (load, speed))
    assert whole == pytest.approx(np.log(2), rel=0.05), "twice both is twice the amplitude"


def test_sensors_that_the_model_lacks_are_refused():
    with pytest.raises(ConfigError, match="sensors among x, y, found z"):
        shown(pair(), told(spectra={"z": {"list": "x"}}))
