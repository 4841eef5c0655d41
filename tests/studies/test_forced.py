"""The study of forced rigs: its plan, its scores, its rates; and, slow, a sample of it."""

from types import SimpleNamespace

import pytest

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.metrics.criteria import judged
from tests.studies.forced import Plan, plans, run, score_of, table


def test_every_piece_stands_at_two_places_and_two_noise_levels_beside_130_controls():
    found = plans()
    assert sum(not p.hidden for p in found) == 130 and len({p.seed for p in found}) == len(found)
    for name, piece in HIDDEN.items():
        own = {(p.place, p.level) for p in found if p.hidden == name}
        assert len(own) == (2 if piece.place == "shaker" else 4)
    assert {p.masses for p in found} == {1, 2, 3, 4} and {p.colour > 0 for p in found} == {True, False}


def truth(kind, effect="coulomb", place="link_1"):
    effects = [] if kind == "control" else [{"name": effect, "place": place}]
    return {"class": kind, "effects": effects, "noise": 0.01}


def told(verdict, *named):
    return {"verdict": verdict, "effects": [{"name": n, "place": p} for n, p in named]}


def test_the_table_tells_rates_with_their_intervals():
    lines = table([(truth("control"), told("parameters")), (truth("effect"), told("missing", ("coulomb", "link_1")))])
    assert any(line.startswith("false alarms on controls") and "0 of 1" in line for line in lines)
    assert any("type and place at 1%" in line and "100.0%" in line for line in lines)


def test_laws_alike_are_looked_for_only_where_something_else_is_named(monkeypatch):
    looked = []
    monkeypatch.setattr(case_files, "truth", lambda case, looked_for=("effect", "foreign"): (
        looked.append(case.kind in looked_for), truth(case.kind))[1])
    for kind, answer, times in (("effect", told("missing", ("coulomb", "link_1")), 0), ("control", told("unknown"), 0),
                                ("effect", told("missing", ("backlash", "link_1")), 1),
                                ("foreign", told("unknown"), 1)):
        looked.clear()
        score_of(SimpleNamespace(kind=kind), answer)
        assert sum(looked) == times


@pytest.mark.slow
@pytest.mark.study
def test_a_control_of_one_mass_is_told_as_wrong_values_down_to_the_noise_and_kept(tmp_path):
    plan = Plan(1, "", 0, 0.01, 1, 0.0)
    known, answer = run(plan, tmp_path, kept=2)
    assert answer["verdict"] == "parameters" and judged(known, answer)["right"]
    for part in ("training", "held_out"):
        assert answer["fit"][part]["recalibrated"] < 1.05 * answer["fit"][part]["noise_floor"]
    assert run(plan, tmp_path, kept=2)[1] == answer
