"""Measured friction and worn faces against the rough pair of a chain: what is missing, and that it lies there."""

import json
from dataclasses import replace

import numpy as np
import pytest
import yaml

from pipeline.case_models.rough.pair import Settings as Section
from pipeline.contract import ConfigError
from pipeline.contract.case import CaseText
from pipeline.contract.settings import fill, without_origins
from pipeline.diagnosis.output.files import as_json, companions
from pipeline.diagnosis.rough_pair import rough_pair_problem
from pipeline.diagnosis.settings import Settings
from stages.diagnosis import diagnosis
from stages.friction_map import Settings as MapSettings
from stages.friction_map import friction_map
from stages.micro_friction import micro_friction
from tests.diagnosis.small_pad import ASKED, FILM, SECTION, TRANSFER, effects, micro, recording, rough, values

NAMES = ("third_body_film", "material_transfer", "wear_law", "shear_limit")


def asked(**changes):
    return fill(Settings, {**ASKED, **changes}, "diagnosis")


def told(recorded, micro_product=None, mapped=None, block=None, **changes):
    """Product Diagnosis by the stage."""
    return diagnosis(recording=recorded, surface=rough(), micro=micro_product or micro(), friction_map=mapped,
                     effects=block, settings=asked(**changes))


@pytest.fixture(scope="module")
def filmed():
    return told(recording(FILM, values(0.85, 1.2)))


def test_a_film_is_named_with_its_values(filmed):
    found = as_json(filmed)
    effect, = found["effects"]
    assert (found["verdict"], effect["name"], effect["place"]) == ("missing", "third_body_film", "asperities")
    assert found["location"]["stage"] == ["micro_friction"]
    size = {k: v["value"] for k, v in effect["parameters"].items()}
    assert size["gain"] / size["pressure"] == pytest.approx(0.5 / 2e6, rel=0.15), "only their ratio counts"
    assert size["distance"] == pytest.approx(2e-3, rel=0.15)
    assert found["parameters"]["disc_strength"]["value"] == pytest.approx(0.85 * 234e6, rel=0.03)
    assert found["parameters"]["pad.wear_coefficient"]["value"] == pytest.approx(1.2 * 4e-12, rel=0.03)


def test_what_sticks_to_the_disc_is_named():
    effect, = as_json(told(recording(TRANSFER)))["effects"]
    assert effect["name"] == "material_transfer"
    assert effect["parameters"]["share"]["value"] == pytest.approx(0.6, abs=0.03)


def test_other_values_alone_are_told_so():
    found = as_json(told(recording(section=values(0.8, 1.25))))
    assert found["verdict"] == "parameters" and not found["effects"]
    assert found["parameters"]["pad.wear_coefficient"]["value"] == pytest.approx(1.25 * 4e-12, rel=0.03)


@pytest.mark.slow
def test_the_paper_without_a_third_body_lacks_a_shear_limit():
    """Spots that shear like bare iron: friction of 4 where 0.4 is measured."""
    bare = replace(micro(), settings=np.array(Section(**SECTION, third_body_factor=1.0).model_dump_json()))
    effect, = as_json(told(recording(), bare))["effects"]
    assert effect["name"] == "shear_limit" and effect["parameters"]["factor"]["value"] == pytest.approx(0.1, rel=0.3)


@pytest.mark.slow
def test_friction_alone_names_no_transfer():
    """Without faces it is a pad that wears more slowly: other values suffice."""
    found = as_json(told(recording(TRANSFER, faces=False)))
    assert found["verdict"] in ("parameters", "unknown") and not found["effects"]


def test_the_completed_case_runs_and_predicts_as_the_diagnosis_says(filmed):
    case = CaseText("pad", {"micro_friction": {**SECTION}, "diagnosis": {"forward": "friction"}})
    files = companions(filmed, case)
    document = without_origins(yaml.safe_load(files["pad_with_third_body_film.yaml"]), "case")
    again = micro_friction(rough(), effects(document["effects"]),
                           settings=fill(Section, document["micro_friction"], "micro_friction"))
    found = told(recording(FILM, values(0.85, 1.2)), again, block=effects(document["effects"]))
    assert as_json(found)["verdict"] == "consistent"
    one, other = found.runs["drag_2"].nominal, filmed.runs["drag_2"].completed
    np.testing.assert_allclose(one[0], other[0], rtol=0.01)     # the model error: the runs of its table lie elsewhere
    np.testing.assert_allclose(one[1:], other[1:], rtol=1e-9)
    assert json.loads(files["diagnosis.json"])["verdict"] == "missing"


@pytest.mark.slow
def test_a_map_that_errs_between_its_points_is_a_hypothesis_of_its_own():
    """Recorded friction that follows a coarse map instead of the points that it was made from."""
    mapped = friction_map(micro(), settings=MapSettings())
    coarse = replace(mapped, friction=mapped.friction * (1 + 0.2 * np.sin(2e-6 * mapped.pressure))[:, None, None])
    asked_of = rough_pair_problem(recording(faces=False), rough(), micro(), coarse, None, asked(), map)
    forward, problem = asked_of.problem.predict, asked_of.problem
    nominal = problem.nominal.values(problem.nominal.nominal)
    runs = dict(recording(faces=False).runs)
    for run in problem.runs:
        table = runs[run.name].friction["load_cell"]
        shifted = replace(table, friction=forward(problem.nominal, nominal, run)[0] + forward.change[run.name])
        runs[run.name] = replace(runs[run.name], friction={"load_cell": shifted})
    found = as_json(told(replace(recording(faces=False), runs=runs), mapped=coarse))
    assert found["verdict"] == "numerics" and found["location"]["stage"] == ["friction_map"]


def test_candidates_are_those_of_asperities_that_the_case_does_not_state_already():
    found = rough_pair_problem(recording(), rough(), micro(), None, None, asked(), map)
    assert tuple(c.effects[0][0] for c in found.candidates) == tuple(sorted(NAMES, key=[
        c.effects[0][0] for c in found.candidates].index)) and len(found.candidates) == 4
    assert found.units == {"friction": "1", "pad wear": "m", "disc wear": "m"}
    stated = rough_pair_problem(recording(), rough(), micro(), None, effects(FILM), asked(), map)
    assert {c.effects[0][0] for c in stated.candidates} == set(NAMES) - {"third_body_film"}


@pytest.mark.parametrize("changes, said", [
    ({"held_out": ["drag_9"]}, "held_out"), ({"parameters": {"pad.density": {}}}, "parameters"),
    ({"priors": {"film.gain": {}}}, "priors"),
    ({"rubbing": {"distances": 40}}, "micro_friction.cycles")])
def test_unknown_names_are_refused(changes, said):
    with pytest.raises(ConfigError, match=said):
        rough_pair_problem(recording(), rough(), micro(), None, None, asked(**changes), map)


def test_a_chain_without_a_rough_pair_is_refused():
    with pytest.raises(ConfigError, match="micro_friction"):
        diagnosis(recording=recording(), settings=asked())
