"""Practice files of the squealing brake: its case, its files; and, slow, the diagnosis of one."""

import json

import numpy as np
import pytest
import yaml

from pipeline.blind_trial.generators.brake import brake, squealing_brake, squealing_stops
from pipeline.contract import documents
from tests.studies import brake as taps
from tests.studies import brake_stops
from tests.studies.brake_stops import CONFIG, PRACTICE, made, practice, solved, write
from tests.studies.forced import recorded


def test_the_case_is_the_disc_brake_on_inclined_abutments():
    case, other = (yaml.safe_load(path.read_text()) for path in (CONFIG, taps.CONFIG))
    for pad in ("outer", "inner"):
        along = case["lumped"]["springs"][f"abutment_{pad}"].pop("along")
        other["lumped"]["springs"][f"abutment_{pad}"].pop("along")
        assert [along[f"pad_{pad}.{axis}"] for axis in "xz"] == pytest.approx(
            [np.cos(squealing_brake.INCLINED), np.sin(squealing_brake.INCLINED)], abs=1e-5)
    assert case["lumped"]["sensors"].pop("caliper") == {"along": {"caliper.z": 1}}
    assert case["lumped"] == other["lumped"]
    assert case["diagnosis"]["parameters"] == other["diagnosis"]["parameters"]
    held_out, = case["diagnosis"]["held_out"]
    assert held_out in {f"{squealing_stops.name(*point)}_1" for point in squealing_stops.POINTS}
    shown = case["bench"]["channels"]
    assert set(shown) == {*brake.CHANNELS, *squealing_stops.FURTHER}
    assert shown["pressure"]["gain"] * squealing_stops.PISTON == pytest.approx(1.0)


@pytest.mark.parametrize("number", [0, 1, pytest.param(2, marks=pytest.mark.slow), 3])
def test_every_practice_brake_squeals_everywhere(number):
    whole, truth = made(number)
    assert len(truth["stops"]) == len(squealing_stops.POINTS) and bool(whole.hidden) == bool(PRACTICE[number][1])
    assert min(stop["growth_rate"] for stop in truth["stops"].values()) > brake_stops._SLOWEST


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(squealing_stops.simulated, "__defaults__", (0.002,))
    monkeypatch.setattr(brake, "DURATION", 0.01)


def test_files_hold_taps_at_rest_and_stops(tmp_path, short):
    truth = write(0, tmp_path)
    runs = recorded(tmp_path / "recordings.h5").runs
    assert sum(name.startswith("stop") for name in runs) == 18 and "rest_700N_2" in runs
    assert not any(name.startswith("sliding") for name in runs)
    assert json.loads((tmp_path / "truth.json").read_text()) == truth and not (tmp_path / "nominal.yaml").exists()


def test_practice_files_have_their_truth_beside_them(tmp_path, short):
    practice(tmp_path, [0])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["squealing_brake_0.h5", "squealing_brake_0_truth.json"]


@pytest.mark.slow
@pytest.mark.study
def test_friction_that_falls_is_named_and_predicts_the_held_out_stop(tmp_path):
    practice(tmp_path, [1])
    answer = solved(tmp_path / "squealing_brake_1.h5", saturated_squeal=None)
    effect, = answer["effects"]
    assert answer["verdict"] == "missing" and (effect["name"], effect["place"]) == ("falling_friction", "contact")
    assert documents.read_yaml(CONFIG)["diagnosis"]["held_out"] == answer["fit"]["held_out"]["runs"]
    assert answer["fit"]["held_out"]["after"] < 0.5 * answer["fit"]["held_out"]["recalibrated"]
