"""The study of squealing benches: its plan, its score, and one case of either kind."""

import json

import pytest

from pipeline.blind_trial.generators.brake.squealing_brake import FOREIGN, ONE_WAY, TWO_WAY
from tests.studies import lines


def test_the_plan_has_as_many_controls_as_two_way_benches():
    kinds = [plan.kind for plan in lines.plans()]
    assert kinds.count(TWO_WAY) == 12 == kinds.count(ONE_WAY) + kinds.count(FOREIGN)
    assert len({plan.seed for plan in lines.plans()}) == 24


def test_only_the_verdict_of_the_kind_is_right():
    assert lines.scored(TWO_WAY, {"verdict": "flexible"}) == "right"
    assert lines.scored(ONE_WAY, {"verdict": "flexible"}) == lines.scored(TWO_WAY, {"verdict": "none"}) == "wrong"
    assert lines.scored(FOREIGN, {"verdict": "undecided"}) == "undecided"
    rows = lines.table([(TWO_WAY, {"verdict": "flexible"}), (FOREIGN, {"verdict": "none"})])
    assert rows[0] == "two_way: 1 right, 0 undecided, 0 wrong" and "0 of 1" in rows[-1]


def test_a_case_keeps_its_truth_apart(tmp_path):
    lines.write(lines.Plan(3, TWO_WAY), tmp_path)
    assert json.loads((tmp_path / "truth.json").read_text())["kind"] == TWO_WAY
    assert sorted(p.name for p in (tmp_path / "public").iterdir()) == ["nominal.yaml", "recordings.h5"]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "verdict"), [(TWO_WAY, "flexible"), (ONE_WAY, "rigid")])
def test_a_concealed_bench_reaches_its_verdict(tmp_path, kind, verdict):
    lines.write(lines.Plan(0, kind), tmp_path)
    assert lines.solved(tmp_path / "public", draws=200)["verdict"] == verdict
