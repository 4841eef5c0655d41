"""The knock-out study: its plan, what it takes from the catalogue, its score; and, slow, one case of it."""

import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.rig_case import kind_of
from pipeline.effects import CATALOGUE
from tests.studies.forced import Plan, run
from tests.studies.knock_out import CONTAINING, misnamed, plans, removed, results_of, table


def test_every_effect_is_removed_in_at_least_150_cases():
    found = plans()
    effects = {name for name in HIDDEN if kind_of((name,)) == "effect"}
    assert {p.hidden for p in found} == effects and len(found) >= 150 and len({p.seed for p in found}) == len(found)


def test_laws_that_contain_an_effect_go_with_it():
    known = {effect.name for effect in CATALOGUE}
    for name, containing in CONTAINING.items():
        assert {name, *containing} <= known and set(removed(name)) >= {name, *containing}
    assert removed("cubic_stiffness") == ("cubic_stiffness",) and "moving_base" in removed("compliant_arm")


def test_only_a_name_is_wrong():
    assert misnamed({"verdict": "missing"}) and misnamed({"verdict": "tie"}) and misnamed({"verdict": "sensor"})
    assert not misnamed({"verdict": "unknown"}) and not misnamed({"verdict": "parameters"})
    seen = {"left": 9.0, "noise": 0.01}
    rows = table([(seen, {"verdict": "unknown"}), (seen, {"verdict": "missing"}),
                  ({"left": 2.0, "noise": 0.1}, {"verdict": "missing"})])
    assert "1 of 2" in rows[0] and "0 of 1" in rows[-1]


def test_rows_of_the_ledger_count_as_answers():
    rows = [{"noise": "0.1", "left": "20.5", "verdict": "missing", "named": "dahl at joint_1", "cpu_seconds": "9"}]
    (truth, answer), = results_of(rows)
    assert truth == {"noise": 0.1, "left": 20.5} and misnamed(answer) and answer["effects"][0]["name"] == "dahl"


@pytest.mark.slow
@pytest.mark.study
def test_cubic_stiffness_that_the_catalogue_lacks_is_not_named_otherwise(tmp_path):
    answer = run(Plan(7, "cubic_stiffness", 0, 0.01, 2, 0.0), tmp_path, kept=4, without=removed("cubic_stiffness"))[1]
    assert not misnamed(answer) and answer["verdict"] == "unknown"
