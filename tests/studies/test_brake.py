"""The study of the practice disc brake: its case, its plan and its scores; and, slow, a sample of it."""

import json

import pytest
import yaml

from pipeline.blind_trial.generators.brake import brake as generator
from pipeline.blind_trial.generators.brake import brake_model
from pipeline.blind_trial.generators.brake.brake_parts import SHAPES
from pipeline.contract.units import to_si
from pipeline.effects import CATALOGUE
from tests.studies import brake
from tests.studies.brake import ANOTHER, CONFIG, EFFECTS, PRACTICE, Plan, plans, practice, run, table, write


def numbers(entry):
    """The entry with its quantities as numbers in SI."""
    if isinstance(entry, dict):
        return {key: numbers(value) for key, value in entry.items()}
    if isinstance(entry, list):
        return [numbers(value) for value in entry]
    if isinstance(entry, str) and entry[0] in "-0123456789":
        unit = entry.split(" ", 1)[1]
        return to_si(entry, {"N/um": "N/m", "kHz": "Hz", "us": "s"}.get(unit, unit), "case")
    return entry


def near(first, second):
    if isinstance(first, dict):
        return set(first) == set(second) and all(near(first[key], second[key]) for key in first)
    if isinstance(first, float) or isinstance(second, float):
        return first == pytest.approx(second, rel=1e-5, abs=1e-5)
    return first == second


def test_the_case_is_what_the_drawing_of_the_brake_says():
    case, drawing = (yaml.safe_load(text) for text in (
        CONFIG.read_text(), yaml.safe_dump(brake_model.nominal(SHAPES[0]))))
    assert near(numbers(case["lumped"]), numbers(drawing["lumped"]))
    assert near(numbers(case["bench"]), numbers(drawing["bench"]))
    assert case["diagnosis"]["parameters"] == drawing["diagnosis"]["parameters"]
    assert {*EFFECTS, *generator.DECOYS} <= set(case["diagnosis"]["effects"]) <= {e.name for e in CATALOGUE}


def test_eleven_effects_two_draws_six_controls_and_what_no_catalogue_has():
    found = plans()
    assert len(EFFECTS) == 11 and len({p.seed for p in found}) == len(found) == 31
    assert all(sum(p.hidden == name for p in found) == 2 for name in EFFECTS)
    assert sum(p.kind == "control" for p in found) == 6 and sum(p.kind == "foreign" for p in found) == 3


def told(verdict, *named):
    return {"verdict": verdict, "effects": [{"name": n, "place": "contact"} for n in named]}


def true(kind, *hidden):
    return {"class": kind, "effects": [{"name": n, "place": "contact"} for n in hidden], "left": 50.0}


def test_the_table_tells_rates_with_their_intervals():
    lines = table([(true("effect", "contact_damping"), told("missing", "contact_damping")),
                   (true("effect", "contact_memory"), told("unknown")), (true("control"), told("parameters")),
                   (true("foreign", "resonant_clip"), told("unknown"))])
    counted = {line.split("  ")[0]: line for line in lines}
    assert "1 of 1" in counted["contact_damping"] and "0 of 1" in counted["contact_memory"]
    assert "1 of 2" in counted["all effects"] and "0 of 1" in counted["false alarms on controls"]
    assert "1 of 1" in counted["out of the catalogue: unknown"] and "95 %" in lines[-1]


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(generator, "DURATION", 0.01)


def test_practice_files_have_their_truth_beside_them(tmp_path, short, monkeypatch):
    monkeypatch.setattr(brake, "PRACTICE", (("control", ""), ("wrong_value", ""), (ANOTHER, "")))
    practice(tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(
        f"brake_{k}{end}" for k in range(3) for end in (".h5", "_truth.json"))
    truth = [json.loads((tmp_path / f"brake_{k}_truth.json").read_text()) for k in range(3)]
    assert [t["class"] for t in truth] == ["control", "wrong_value", ANOTHER] and truth[1]["wrong"]


def test_another_brake_is_another_brake():
    disc = zip(brake.OTHER_SHAPE, SHAPES[0], strict=True)
    assert all(abs(one / other - 1) > 0.15 for one, other in disc)
    assert all(abs(factor - 1) > 0.2 for factor in brake.OTHER.values())


def test_a_draw_that_squeals_is_drawn_anew(tmp_path, short, monkeypatch):
    tried = []

    def squeals_first(draw, folder, shape):
        tried.append(draw.seed)
        if len(tried) == 1:
            raise brake.ConvergenceError("practice brake", "a brake that does not squeal", "growth")
        (folder / "nominal.yaml").write_text("")
        return {"seed": draw.seed}

    monkeypatch.setattr(brake.brake_files, "write", squeals_first)
    assert write(Plan(5, "control", ""), tmp_path) == {"seed": 100_005} and tried == [5, 100_005]


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("number", [PRACTICE.index(("control", "")), PRACTICE.index(("effect", "doublet_split")),
                                    PRACTICE.index((ANOTHER, ""))])
def test_a_case_is_answered_and_kept(tmp_path, number):
    truth, answer = run(Plan(number, *PRACTICE[number]), tmp_path)
    assert (tmp_path / "answer.json").exists()
    if truth["class"] == ANOTHER:
        assert answer["verdict"] in ("unknown", "refused") and not answer["effects"]
    else:
        assert brake.judged(truth, answer)["right"], answer["reasons"]
