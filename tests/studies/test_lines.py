"""The study of squealing benches: its plan, its score, and one case of either kind."""

import json

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake.squealing_brake import FOREIGN, ONE_WAY, TWO_WAY
from pipeline.contract import documents
from pipeline.contract.case import CaseText
from pipeline.contract.settings import without_origins
from pipeline.diagnosis.published.completed_case import chosen, companions
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
def test_a_concealed_one_way_bench_does_not_name_the_flexible_disc(tmp_path):
    lines.write(lines.Plan(0, ONE_WAY), tmp_path)
    assert str(lines.weighed(tmp_path / "public", draws=200).verdict) == "rigid"


@pytest.mark.slow
def test_a_concealed_two_way_bench_is_named_and_its_completed_case_squeals_at_the_lines(tmp_path):
    """Its unstable modes are the tones of the draw that it was completed from."""
    lines.write(lines.Plan(0, TWO_WAY), tmp_path)
    made = lines.weighed(tmp_path / "public", draws=200)
    assert str(made.verdict) == "flexible"
    case = CaseText("bench", documents.read_yaml(tmp_path / "public" / "nominal.yaml"))
    (name, text), = companions(made, case).items()
    (tmp_path / name).write_text(text)
    document = without_origins(documents.read_yaml(tmp_path / name), name)
    modes = lines.modes_of(document)[1]
    unstable = abs(modes.unstable_root.imag) / (2 * np.pi)
    row, draw = chosen(made.disc, made.evidence, made.weight)
    tones = made.tone[(made.tone_hypothesis == row) & (made.tone_draw == draw)]
    assert all(abs(tones / f - 1).min() < 2e-3 for f in unstable) and len(unstable)
    assert sum(abs(unstable / line - 1).min() < made.model_error for line in made.line) >= len(made.line) / 2
