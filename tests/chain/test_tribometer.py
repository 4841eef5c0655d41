"""The recording of a real tribometer: what the issue asks of its diagnosis. Measured data, minutes: a slow test.

The same beside a friction map: seconds."""

import json

import numpy as np
import pytest

from pipeline.contract import store
from pipeline.products import Diagnosis, FrictionUpdate
from tests.commands import ROOT, brakechain

RIVALS = {"compliant_arm": "arm", "micro_slip": "contact"}


@pytest.mark.measured
def test_the_map_beside_the_tribometer_is_updated_and_predicts_strokes_that_it_did_not_see(tmp_path):
    """Two patches instead of four; all of them are those of the slow test of every case."""
    brakechain("run", ROOT / "configs" / "tribometer_map.yaml", "--run", tmp_path / "run",
               "--set", "report.dots_per_inch=50", "--set", "surface.pairs=2")
    told = store.read(FrictionUpdate, tmp_path / "run" / "friction_update.h5")
    assert str(told.verdict) == "values" and "level" in told.term[told.needed > 0]
    assert len(told.friction) > 30 and 0.4 < told.friction.min() < told.friction.max() < 0.5
    before, after = (np.sqrt(np.mean(np.log(p / told.friction) ** 2)) for p in (told.mapped, told.unseen))
    assert after < 0.03 < 0.5 < before
    assert (tmp_path / "run" / "tribometer_map_updated.yaml").exists()
    assert "Measured friction differs from the map in its level" in (tmp_path / "run" / "report.html").read_text()


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.measured
def test_micro_slip_and_the_arm_tie_until_another_load_or_arm_is_taken(tmp_path):
    brakechain("run", ROOT / "configs" / "tribometer.yaml", "--run", tmp_path / "run")
    told = json.loads((tmp_path / "run" / "diagnosis.json").read_text())
    assert told["verdict"] == "tie" and {e["name"]: e["place"] for e in told["effects"]} == RIVALS
    held_out = told["fit"]["held_out"]
    assert held_out["after"] <= 0.06 and min(held_out["before"], held_out["recalibrated"]) > 0.5
    following = told["next_experiment"]
    assert following["conditions"][0] in ("normal_load = 2 N", "normal_load = 10 N", "joints.arm.stiffness x 5")
    assert {s.split(" at ")[0] for s in following["separates"]} == set(RIVALS)
    found = store.read(Diagnosis, tmp_path / "run" / "diagnosis.h5")
    assert min(found.posterior[found.named]) > 0.05, "neither is excluded"
