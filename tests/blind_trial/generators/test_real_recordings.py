"""Terms removed from complete models of real recordings: the case lacks what the truth tells, and no more."""

import numpy as np
import pytest
import yaml

from pipeline.blind_trial.generators.real_recordings import removable, write
from pipeline.blind_trial.generators.systems import RECORDED, Draw
from pipeline.contract.errors import ConfigError
from pipeline.recordings.neutral import read_neutral


@pytest.mark.measured
@pytest.mark.parametrize("system, hidden, place", [
    ("carriage", (), ""), ("carriage", ("coulomb",), "guide"), ("circuit", ("joint_damping",), "mount"),
    ("circuit", ("cubic_stiffness",), "mount"), ("tribometer", ("micro_slip",), "contact")])
def test_what_is_removed_is_missing_and_the_rest_is_there(tmp_path, system, hidden, place):
    truth = write(Draw(1, system, "effect" if hidden else "control", hidden, 0.0, 0.0), tmp_path)
    assert [(e["name"], e["place"]) for e in truth["effects"]] == [(name, place) for name in hidden]
    case = yaml.safe_load((tmp_path / "nominal.yaml").read_text())
    there = {name for (name,) in removable(system)["effect"]} - {"joint_damping"}
    assert there & set(case.get("effects", {})) == there - set(hidden)
    if system == "circuit":
        assert ("damping" in case["lumped"]["springs"]["mount"]) == (hidden != ("joint_damping",))
    runs = read_neutral(tmp_path / "recordings.h5")
    assert set(case["diagnosis"]["held_out"]) < set(runs) and "measured:" not in str(case)


@pytest.mark.measured
def test_recordings_are_cut_and_scaled_as_the_case_states(tmp_path):
    write(Draw(1, "tribometer", "control", (), 0.0, 0.0), tmp_path)
    run = read_neutral(tmp_path / "recordings.h5")["early"]
    load = run.channels["load"].samples
    assert len(load) == 800 and np.median(load) == pytest.approx(5, 0.01)
    assert 0.1e-3 < np.ptp(run.channels["position"].samples) < 0.4e-3


def test_without_the_recordings_it_says_where_they_should_be(tmp_path, monkeypatch):
    monkeypatch.delenv("BRAKECHAIN_DATA", raising=False)
    with pytest.raises(ConfigError, match="BRAKECHAIN_DATA"):
        write(Draw(1, "carriage", "control", (), 0.0, 0.0), tmp_path)
    assert set(RECORDED) == {"carriage", "circuit", "tribometer"}
