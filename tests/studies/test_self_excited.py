"""The study of self-excited benches: its plan and its scores; and, slow, a sample of it."""

import pytest

from pipeline.blind_trial.generators.benches.pin_bench import HIDDEN
from tests.studies.self_excited import Plan, plans, run, scored, table


def test_nine_effects_four_draws_and_sixty_controls():
    found = plans()
    assert len(HIDDEN) == 9 and len({p.seed for p in found}) == len(found) and sum(not p.hidden for p in found) == 60
    assert all(sum(p.hidden == name for p in found) == 4 for name in HIDDEN)


def told(verdict, *named):
    return {"verdict": verdict, "effects": [{"name": n, "place": "contact"} for n in named]}


@pytest.mark.parametrize("hidden, answer, right, alarm", [
    ("runout", told("missing", "runout"), True, False), ("runout", told("unknown"), False, False),
    ("runout", told("missing", "falling_friction"), False, False), ("", told("parameters"), True, False),
    ("", told("missing", "runout"), False, True), ("", told("unknown"), False, False),
    ("sensor_gain", told("sensor", "sensor_gain", "sensor_gain"), True, False)])
def test_what_counts_as_right(hidden, answer, right, alarm):
    assert scored(hidden, answer) == {"right": right, "false_alarm": alarm}


def test_the_table_tells_rates_with_their_intervals():
    lines = table([("runout", told("missing", "runout")), ("", told("parameters"))])
    assert lines[-1].startswith("false alarms on controls") and "0 of 1" in lines[-1] and "95 %" in lines[-1]


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("hidden, verdict", [("", "parameters"), ("falling_friction", "missing")])
def test_a_case_is_answered_and_kept(tmp_path, hidden, verdict):
    assert run(Plan(1, hidden), tmp_path)["verdict"] == verdict and (tmp_path / "answer.json").exists()
