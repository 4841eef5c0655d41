"""A diagnosis ends with an answer, whatever the case: random benches through the command, and a failure within it."""

import json

import numpy as np
import pytest

from pipeline.inference import procedure
from tests.commands import brakechain
from tests.fuzz.diagnoses import BAD, Outcome, apart, ran
from tests.fuzz.random_benches import Bench

#: (seed, number) of benches that once ended in an internal error or without a verdict
MENDED = ((3, 3), (3, 7), (5, 12), (31, 91), *(pytest.param(*each, marks=pytest.mark.slow)
                                               for each in ((3, 4), (3, 11), (5, 9), (5, 26), (31, 14))))


def first(kind, seed=1):
    """Number of the first bench of a kind."""
    return next(number for number in range(1, 100) if Bench([seed, number]).kind == kind)


@pytest.mark.parametrize("seed, number", MENDED)
def test_what_once_failed_is_answered_or_refused_in_a_sentence(seed, number, tmp_path):
    kind, said = ran(seed, number, tmp_path)
    assert kind not in BAD, said


@pytest.mark.slow
@pytest.mark.parametrize("number", range(1, 13))
def test_random_benches_end_with_an_answer(number, tmp_path):
    kind, said = ran(6, number, tmp_path)
    assert kind not in BAD, said


def test_courses_as_documented_run(tmp_path):
    bench = Bench([1, first("course")])
    bench.document["diagnosis"] |= {"effects": ["coulomb"], "kept": 1, "solver": False}
    assert bench.document["bench"]["courses"]["base"]
    bench.write(tmp_path)
    brakechain("run", tmp_path / "case.yaml", "--run", tmp_path / "run", "--until", "bench", "--workers", 1)


def simple(folder):
    """A small bench that is answered at once."""
    bench = next(b for b in (Bench([2, n]) for n in range(60))
                 if b.kind == "force" and b.size == 1 and len(b.runs) > 1 and min(b.lengths) > 60)
    bench.document["bench"] = {key: value for key, value in bench.document["bench"].items()
                               if key in ("step", "channels", "inputs")}
    bench.document["diagnosis"] = {"effects": ["coulomb"], "draws": 200, "solver": False,
                                   "parameters": {"joints.spring_0.stiffness": {"spread": 0.1}},
                                   "noise": {"std": {"m0": "1e-3 " + bench._unit(bench.sensors["m0"])}}}
    bench.write(folder)


def test_an_internal_error_of_the_diagnosis_is_an_answer_with_the_failure(tmp_path, monkeypatch):
    def fails(*_, **__):
        raise np.linalg.LinAlgError("Singular matrix")

    simple(tmp_path)
    monkeypatch.setattr(procedure, "screen_catalogue", fails)
    printed = brakechain("run", tmp_path / "case.yaml", "--run", tmp_path / "run", "--workers", 1)
    answer = json.loads((tmp_path / "run" / "diagnosis.json").read_text())
    assert answer["verdict"] == "unknown" and not answer["effects"] and not answer["leading"]
    for told in (answer["reasons"][0], (tmp_path / "run" / "report.html").read_text(), printed.stdout + printed.stderr):
        assert "LinAlgError: Singular matrix" in told and "please report it" in told
    assert "Traceback" not in printed.stdout + printed.stderr


def test_a_process_that_dies_or_takes_too_long_is_told(monkeypatch):
    from tests.fuzz import diagnoses

    monkeypatch.setattr(diagnoses, "ran", lambda *_: ("answered", "unknown"))
    assert apart(1, 0).kind == "answered"

    def forever(*_):
        while True:
            pass

    monkeypatch.setattr(diagnoses, "ran", forever)
    assert apart(1, 0, longest=1).kind == "slow"
    monkeypatch.setattr(diagnoses, "ran", lambda *_: 1 / 0)
    dead = apart(1, 0)
    assert isinstance(dead, Outcome) and dead.kind == "internal" and "ZeroDivisionError" in dead.said
