"""Files of a switching rig: the stages read them, their units mean what they say, nothing betrays the truth."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from pipeline.blind_trial.generators.switching.rig import drawn
from pipeline.blind_trial.generators.switching.switching_case import made
from pipeline.blind_trial.generators.switching.switching_files import alike, nominal, truth, write
from pipeline.blind_trial.generators.systems import SYSTEMS, Draw
from pipeline.contract.units import to_si
from pipeline.recordings.neutral import read_neutral
from stages.bench import bench
from stages.lumped import lumped
from tests.blind_trial.generators.imported import imported
from tests.studies.forced import filled


def test_two_files_that_the_stages_accept(tmp_path):
    for seed in range(3):
        told = write(Draw(seed, "switching_rig", "control", (), 0.0, 0.01), tmp_path / f"{seed}")
        assert sorted(p.name for p in (tmp_path / f"{seed}").iterdir()) == ["nominal.yaml", "recordings.h5"]
        document = yaml.safe_load((tmp_path / f"{seed}" / "nominal.yaml").read_text())
        model = lumped(settings=filled(document, lumped))
        assert len(model.mass) == told["bodies"] and filled(document, bench).channels
        runs = read_neutral(tmp_path / f"{seed}" / "recordings.h5")
        assert list(runs) == ["take_1", "take_2", "take_3", "take_4"] and told["class"] == "control"
        assert told["way"] not in (tmp_path / f"{seed}" / "nominal.yaml").read_text() or told["way"] in ("wall", "blow")


def test_values_are_stated_in_units_of_their_own():
    case = made(5, "control")
    document = nominal(case)
    for k, mass in enumerate(case.belief.mass):
        assert to_si(document["lumped"]["masses"][f"body_{k + 1}"]["mass"], "kg", "") == pytest.approx(mass, rel=1e-5)
    for k, stiffness in enumerate(case.belief.stiffness):
        stated = document["lumped"]["springs"][f"mount_{k + 1}"]["stiffness"]
        assert to_si(stated, "N/m", "") == pytest.approx(stiffness, rel=1e-5)
    assert truth(case)["parameters"]["masses.body_1"] == case.truth.mass[0]
    assert "effects" not in document["diagnosis"] and truth(case)["effects"] == []


@pytest.mark.parametrize("at, way, found", [(0, "sweep", ["hydraulic_compliance"]), (1, "sweep", []), (0, "wall", [])])
def test_a_law_of_the_pushed_body_beside_a_wall_is_like_one_of_the_input(at, way, found):
    rig = drawn(np.random.default_rng(1), "row")
    case = replace(made(5, "control"), name="viscoelastic_pad", index=0, at=at, way=way, runs=(), truth=rig)
    assert [law["name"] for law in alike(case)] == found


@pytest.mark.parametrize("quantity, found", [("velocity", ["asymmetric_friction"]), ("displacement", [])])
def test_friction_of_two_strengths_is_that_of_their_mean_where_no_position_is_seen(quantity, found):
    case = made(5, "control")
    sensors = tuple(replace(s, quantity=quantity) for s in case.sensors)
    case = replace(case, name="asymmetric_friction", form="asymmetric_friction", index=0, sensors=sensors)
    assert [law["name"] for law in alike(case)] == found


def test_it_is_a_system_of_the_trial_that_stands_apart_from_the_diagnosis():
    assert SYSTEMS["switching_rig"].hides["sensor"] and np.isclose(SYSTEMS["switching_rig"].weight, 0.1)
    assert not [m for m in imported("pipeline.blind_trial.generators.switching.switching_files") if m.startswith((
        "pipeline.effects", "pipeline.case_models", "pipeline.diagnosis", "pipeline.inference", "pipeline.physics",
        "pipeline.systems", "stages"))]


@pytest.mark.parametrize("form, found", [("added_stiffness", ["sensor_gain", "jenkins"]), ("joint_damping", []),
                                         ("compliant_arm", ["sensor_gain"])])
def test_a_change_of_one_body_seen_by_one_sensor_is_a_gain(form, found):
    case = made(5, "control")
    one = replace(case, form=form, name=form, index=0, sensors=case.sensors[:1],
                  truth=drawn(np.random.default_rng(1), "single"))
    assert [law["name"] for law in alike(one)] == found


@pytest.mark.parametrize("beyond, told, alike_too", [(30.0, ["coulomb", "asymmetric_friction"], []),
                                                     (3.0, ["coulomb"], ["asymmetric_friction"])])
def test_two_strengths_of_friction_are_two_laws_of_the_catalogue_where_both_show(beyond, told, alike_too):
    case = made(5, "control")
    sensors = tuple(replace(s, quantity="displacement") for s in case.sensors)
    case = replace(case, kind="effect", name="asymmetric_friction", form="asymmetric_friction", index=0,
                   sensors=sensors, beyond=beyond)
    effects = truth(case)["effects"]
    assert [e["name"] for e in effects] == told and [a["name"] for a in effects[0]["alike"]] == alike_too
