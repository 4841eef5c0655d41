"""The study of the second family: its composition, its rates, its files."""

from collections import Counter

import pytest

from pipeline.blind_trial.generators.switching.switching_files import APART, BESIDE
from pipeline.blind_trial.generators.systems import Draw
from tests.studies.second_family import COUNTS, PAIRS, case, described, plans, solve, table


def test_a_set_has_60_cases_before_its_pairs_and_its_seed_alone_decides():
    draws = plans(1)[:-PAIRS]
    assert Counter(d.kind for d in draws) == COUNTS and len(draws) == 60 == len({d.seed for d in draws})
    assert plans(1)[:-PAIRS] == draws != plans(2)[:-PAIRS]
    assert len({d.hidden for d in draws if d.kind == "foreign"}) >= 8
    assert Counter(d.system for d in draws)["pulled_block"] >= 8
    assert len({d.hidden for d in draws if d.kind == "effect"}) >= 13 and {d.noise for d in draws} == {0.01, 0.05}


def test_half_of_the_pairs_act_at_one_spring():
    pairs = plans(1)[-PAIRS:]
    assert Counter(d.hidden[2] for d in pairs) == {BESIDE: PAIRS // 2, APART: PAIRS // 2}
    assert len({frozenset(d.hidden[:2]) for d in pairs}) == PAIRS == len({d.seed for d in plans(1)}) - 60


@pytest.mark.parametrize("where", [BESIDE, APART])
def test_a_pair_tells_both_laws_and_where_they_are(tmp_path, where):
    truth = case(Draw(7, "switching_rig", "pair", ("cubic_stiffness", "quadratic_damping", where), 0.0, 0.01), tmp_path)
    assert [e["name"] for e in truth["effects"]] == ["cubic_stiffness", "quadratic_damping"]
    assert len({e["place"] for e in truth["effects"]}) == (1 if where == BESIDE else 2)
    assert truth["left"] >= 12 and all(e["parameters"]["coefficient"] > 0 for e in truth["effects"])


def test_pairs_are_counted_by_their_springs_and_half_a_pair_is_told():
    pair = {"class": "pair", "noise": 0.01, "left": 50.0, "effects": [{"name": "coulomb", "place": "mount_1"},
                                                                    {"name": "backlash", "place": "mount_2"}]}
    both = {"verdict": "missing", "effects": pair["effects"]}
    rows = table([(pair, both), (pair, {**both, "effects": pair["effects"][:1]})])
    assert any(r.startswith("pairs at two springs") and "1 of 2" in r for r in rows)
    assert any(r.startswith("pairs: one named alone") and "1 of 2" in r for r in rows)


def test_rates_are_those_of_the_trial():
    effect = {"class": "effect", "effects": [{"name": "coulomb", "place": "mount_1"}], "noise": 0.01, "left": 50.0,
              "visible": 7.0}
    foreign = {"class": "foreign", "effects": [{"name": "lift", "place": "mount_1"}], "noise": 0.05, "left": 50.0}
    named = {"verdict": "missing", "effects": [{"name": "coulomb", "place": "mount_1"}]}
    rows = table([(effect, named), (foreign, named), ({"class": "control", "effects": [], "noise": 0.01},
                                                      {"verdict": "parameters", "effects": []})])
    assert "1 of 1" in rows[0] and any(r.startswith("foreign: not misnamed") and "0 of 1" in r for r in rows)
    assert any(r.startswith("controls: false alarms") and "0 of 1" in r for r in rows)


def test_a_case_is_made_once(tmp_path, capsys):
    draw = Draw(7, "switching_rig", "control", (), 0.0, 0.01)
    first = case(draw, tmp_path / "7")
    assert case(draw, tmp_path / "7") == first and "control" in described(draw, first)
    assert solve(tmp_path, 2, True, draw) is None and "control" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.study
def test_a_control_is_told_right(tmp_path):
    truth, answer = solve(tmp_path, 2, False, Draw(7, "switching_rig", "control", (), 0.0, 0.01))
    assert truth["class"] == "control" and answer["verdict"] in ("consistent", "parameters")
