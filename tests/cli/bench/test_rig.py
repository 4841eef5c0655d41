"""What a first case of recorded files is written from."""

import os
from pathlib import Path

import pytest

from pipeline.cli.bench.rig import rig
from pipeline.contract import ConfigError
from tests.cli.bench.rigs import decays, driven, drop


def test_a_long_record_is_cut_and_one_run_held_out(tmp_path):
    found = rig([driven(tmp_path)])
    assert list(found.runs[0]) == ["part_1", "part_2", "part_3", "part_4"] and found.held_out in found.runs[0]
    assert found.values.mass[0, 0] == pytest.approx(0.1, rel=0.02) and found.roles.balance


def test_two_files_are_cut_but_for_the_last(tmp_path):
    found = rig([driven(tmp_path, "a.csv"), driven(tmp_path, "b.csv", seed=1)])
    assert list(found.runs[0]) == ["a_1", "a_2", "a_3", "a_4"] and list(found.runs[1]) == ["b"] == [found.held_out]


def test_free_decays_are_one_run_each_with_a_fitted_start(tmp_path):
    found = rig([decays(tmp_path)])
    assert len(found.runs[0]) == 3 and found.start == "fitted" and not found.roles.balance
    assert found.noise["x"] == pytest.approx(1e-6, rel=0.2)


def test_a_record_too_short_to_be_cut_is_one_run(tmp_path):
    found = rig([drop(tmp_path, "first.csv"), drop(tmp_path, "second.csv", seed=1)])
    assert [list(runs) for runs in found.runs] == [["first"], ["second"]] and found.held_out == "second"


def test_files_of_other_channels_are_another_case(tmp_path):
    with pytest.raises(ConfigError, match="make another case"):
        rig([driven(tmp_path), decays(tmp_path)])


@pytest.mark.measured
def test_public_records_are_understood():
    data = Path(os.environ["BRAKECHAIN_DATA"]) / "recordings"
    arm = rig(sorted((data / "double_pendulum").glob("*.csv")))
    assert [s.name for s in arm.roles.responses] == ["pos_meas1", "pos_meas2"]
    assert [(s.name, k) for s, k in arm.roles.drives] == [("tau_meas1", 0), ("tau_meas2", 1)] and arm.roles.balance
    drive = rig([data / "emps" / "DATA_EMPS.mat", data / "emps" / "DATA_EMPS_PULSES.mat"])
    assert drive.held_out == "DATA_EMPS_PULSES" and "repeats every 6240" in drive.how[0]
    assert drive.values.mass[0, 0] == pytest.approx(95.1089 / 35.15, rel=0.01), "the authors' mass over N/V"
    steel = rig([data / "steel_loops" / "example_1.csv"])
    assert steel.values.stiffness[0, 0] == pytest.approx(2e11, rel=0.5) and not steel.values.mass.any()
