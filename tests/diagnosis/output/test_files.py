"""diagnosis.json and the completed case."""

import json
from dataclasses import replace

import numpy as np
import pytest
import yaml

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import Settings as EffectSettings
from pipeline.case_models.effect_block import product, with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.case import CaseText
from pipeline.contract.settings import fill, without_origins
from pipeline.diagnosis.output.files import as_json, companions
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.inference.fitting.noise import normalised_error
from tests.diagnosis.output.test_product import told
from tests.diagnosis.small_rig import BENCH, HIDDEN, laid_out, model, recording
from tests.views.chapters.test_squeal_check import CHECK

CASE = CaseText("rig", {"chain": "lumped_bench", "title": "Rig", "bench": BENCH})


def test_the_json_holds_the_verdict():
    found = as_json(told())
    assert found["schema"] == "brakechain-diagnosis/1" and found["verdict"] == "missing"
    effect, = found["effects"]
    assert effect["name"] == "cubic_stiffness" and effect["parameters"]["coefficient"]["unit"] == "N/m^3"
    assert found["fit"]["held_out"]["runs"] == ["level_4"]
    assert set(found["parameters"]) == {"joints.mount.stiffness", "joints.mount.damping"}
    assert not any("meaning" in parameter for parameter in found["parameters"].values())
    assert json.loads(companions(told(), CASE)["diagnosis.json"]) == found


def test_contacts_are_answered_by_their_names_too():
    found = told()
    named = replace(found, contacts=["tip" if k in found.named else "" for k in range(len(found.hypothesis))])
    assert as_json(named)["effects"][0]["contacts"] == ["tip"] and "contacts" not in as_json(found)["effects"][0]


def test_a_factor_says_that_it_is_one():
    factor = as_json(replace(told(), parameter_factor=[1, 0, 0]))["parameters"]["joints.mount.stiffness"]
    assert factor["meaning"] == "factor on the value of the model"


def test_a_candidate_that_cannot_be_fitted_stays_with_its_reason():
    """Micro-slip, which needs a contact, or what fails on the way: neither vanishes from the answer."""
    found = told()
    k = next(k for k in range(1, len(found.hypothesis)) if k not in found.named)
    failed = replace(found, objection=["time stepping at t = 2 s: expected ..." if i == k else "" for i in range(
        len(found.hypothesis))], refitted=[int(i != k) for i in range(len(found.hypothesis))])
    assert as_json(failed)["not_judged"] == [{"name": str(found.effect[k]), "place": str(found.place[k]),
                                              "reason": "time stepping at t = 2 s: expected ..."}]
    doubted = replace(failed, refitted=[1] * len(found.hypothesis), posterior=np.where(
        np.arange(len(found.hypothesis)) == k, 0.5, 0.0))
    assert as_json(doubted)["not_judged"] == []
    assert as_json(doubted)["alternatives"][0]["objection"].startswith("time stepping at t = 2 s")


def test_the_completed_case_has_the_same_held_out_error():
    files = companions(told(), CASE)
    case = without_origins(yaml.safe_load(files["rig_with_cubic_stiffness.yaml"]), "case")
    bench = with_effects(benches.built(model(), fill(benches.Settings, case["bench"], "bench")),
                         product(fill(EffectSettings, case["effects"], "effects")))
    one = recorded(recording(HIDDEN), laid_out())["level_4"]
    left = one.samples - shown(bench, one.run, one.channels)
    error = normalised_error(one, left)
    assert error == pytest.approx(told().fit[1, 2], rel=1e-9)


def test_the_grade_says_how_far_what_is_named_holds():
    assert as_json(told())["grade"] == "to the noise" and as_json(told())["model_error"] == 1
    assert as_json(replace(told(), in_part=np.ones((), int)))["grade"] == "in part"
    nothing = np.zeros(0, int)
    assert as_json(replace(told(), named=nothing))["grade"] == ""
    assert as_json(replace(told(), named=nothing, leading=np.ones(1, int), leading_takes=np.ones(1),
                           leading_stays=np.zeros(1), leading_values=np.array(["force 2 N"])))["grade"] == "leading"


def test_laws_that_cannot_be_told_apart_come_with_their_family():
    assert as_json(replace(told(), family=np.array("dry friction")))["family"] == "dry friction"
    assert as_json(told())["family"] == ""


def test_the_latent_force_is_written_as_numbers():
    lines = companions(told(), CASE)["latent_force.csv"].splitlines()
    assert lines[0].endswith("description, not identified physics.") and lines[1].startswith("run,time_s,force_N")
    assert len(lines) == 2 + sum(len(one.time) for one in told().latent.values())


def test_saturated_squeal_is_written_with_what_agrees():
    written = as_json(replace(told(), squeal={"slide": CHECK}))["saturated_squeal"]["slide"]
    assert written["recorded"]["features"]["frequency of laser"] == {"unit": "Hz", "mean": 2200.0, "spread": 2.0}
    assert written["completed"]["features"]["frequency of laser"]["agrees"] and written["completed"]["saturated"] == 3
    assert "agrees" not in written["completed"]["features"]["share of time open"], "no sensor shows it"
    assert written["recalibrated"]["features"] == {} and "saturated_squeal" not in as_json(told())


def test_a_wrong_sensor_is_written_as_a_case_reads_it():
    """Offsets in units of the channel are plain numbers in a case."""
    found = told()
    row, = found.named
    rename = {"effect": "sensor_offset_drift", "place": "x", "hypothesis": "sensor_offset_drift at x"}
    columns = {key: [value if k == row else str(old) for k, old in enumerate(getattr(found, key))]
               for key, value in rename.items()}
    own = list(found.parameter_owner).index(row)
    units = {"parameter": "sensor_offset_drift@x.offset", "parameter_unit": "unit of the channel"}
    columns |= {key: [value if k == own else str(old) for k, old in enumerate(getattr(found, key))]
                for key, value in units.items()}
    files = companions(replace(found, **columns), CASE)
    case = without_origins(yaml.safe_load(files["rig_with_sensor_offset_drift.yaml"]), "case")
    told_offset = case["effects"]["sensor_offset_drift"]["x"]["offset"]
    assert told_offset == pytest.approx(float(found.parameter_value[own]))
    with pytest.raises(ConfigError, match="drift: expected"):      # the one value that this case does not tell
        fill(EffectSettings, case["effects"], "effects")


def test_no_case_is_written_of_what_no_case_can_state():
    found = told()
    solver = ["time_step" if k in found.named else str(e) for k, e in enumerate(found.effect)]
    assert set(companions(replace(found, verdict="tie", effect=solver), CASE)) == {"diagnosis.json", "latent_force.csv"}


def test_nothing_is_written_where_nothing_is_missing():
    assert set(companions(told(hidden=False), CASE)) == {"diagnosis.json"}
    assert "rig_with_other_values.yaml" in companions(told(hidden=False, stiffness="430 N/m"), CASE)
