"""Recordings of another machine: refused where many poles lie far from any mode, not named where they stay there."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.features import other_machine
from pipeline.diagnosis.features.other_machine import OtherMachine, refuse
from pipeline.diagnosis.features.poles import Features
from pipeline.diagnosis.output.files import as_json
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.physics.signals.pole_identification import Poles
from pipeline.views.chapters.bench.diagnosis import headline, note
from tests.views.diagnosis_for_views import diagnosis, run

RULES = DEFAULTS.poles
MODES = 2 * np.pi * np.arange(400.0, 4000.0, 400.0)         # rad/s, nine of them


def shown(frequencies):
    """Features of a run whose poles lie at these frequencies (n,) Hz; shapes tell nothing."""
    root = 2j * np.pi * np.asarray(frequencies) - 5.0
    return Features(SimpleNamespace(name="rest"), Poles(root, np.ones(len(root)), np.ones((len(root), 1))), {}, {})


@pytest.fixture
def model(monkeypatch):
    monkeypatch.setattr(other_machine, "modes", lambda bench, run: (1j * MODES - 5.0, np.ones((len(MODES), 1))))


def test_values_that_are_off_and_a_mode_that_the_model_lacks_are_no_other_machine(model):
    refuse(None, {"rest": shown(1.08 * MODES / (2 * np.pi)), "lifted": shown([400, 560, 800, 1200, 1600])}, RULES)
    refuse(None, {"turn": replace(shown([400]), seen=None)}, RULES)


def test_many_poles_far_from_all_modes_are_refused_with_what_to_do(model):
    with pytest.raises(ConfigError) as refused:
        refuse(None, {"rest": shown([120, 140, 160, 180, 800, 1200, 1600]), "sliding": shown([400, 810])}, RULES)
    told = str(refused.value)
    assert "4 of 9 poles (in rest: 120, 140, 160, 180 Hz) farther off" in told and "25%" in told
    assert "is this a recording of that machine?" in told


def test_a_machine_whose_values_are_all_a_fifth_off_is_fitted(monkeypatch):
    apart = 400.0 * 2.0**np.arange(6)
    monkeypatch.setattr(other_machine, "modes", lambda bench, run: (2j * np.pi * apart - 5.0, np.ones((6, 1))))
    refuse(None, {"rest": shown(0.8 * apart)}, RULES)
    with pytest.raises(ConfigError, match="6 of 6 poles"):
        refuse(None, {"rest": shown(0.75 * apart)}, RULES)


def test_few_poles_are_never_refused(model):
    refuse(None, {"rest": shown([120, 140, 160])}, RULES)


def solved(off):
    """A Diagnosis that names Coulomb friction, its eight poles predicted ``off`` (8,) as shares of themselves."""
    seen = np.arange(400.0, 3600.0, 400.0)
    names = [f"pole {k + 1} {what}" for k in range(8) for what in ("frequency", "growth rate")]
    measured, model = (np.column_stack((f, np.full(8, -5.0))).reshape(-1, 1) for f in (seen, seen * (1 + off)))
    one = replace(run(0), time=np.zeros(1), measured=measured, valid=np.ones((16, 1), int), nominal=model,
                  recalibrated=model, completed=model, noise=np.ones(16))
    return diagnosis(channel=names, channel_unit=["Hz", "rad/s"] * 8, runs={"rest": one})


def test_what_no_value_explains_names_nothing():
    told = OtherMachine(RULES).revised(solved(np.array([0.05, -0.04, 0.07, 0.05, 0, 0, 0, 0])), None)
    assert told.verdict.item() == "unknown" and not len(told.named) and not as_json(told)["effects"]
    assert headline(told)[0] == "The recordings do not fit this model: are they of another machine?"
    first = "4 of 8 poles (in rest: 400, 800, 1200, 1600 Hz): more than 3%"
    assert dict(note(told))["What is missing"].startswith(first)
    assert "Is this a recording of the machine" in as_json(told)["reasons"][0]


def test_a_missing_mode_leaves_the_verdict():
    found = solved(np.array([0.05, -0.04, 0.07, 0, 0, 0, 0, 0]))
    assert OtherMachine(RULES).revised(found, None) is found
