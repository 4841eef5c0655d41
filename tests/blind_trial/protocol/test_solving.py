"""Solving: case by case, once for a sealed set, and with the code that it was committed with."""

import json
import shutil

import pytest

from pipeline.blind_trial.protocol import code_digest, making, sealing, solver_process, solving
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.contract.errors import BrakechainError
from pipeline.contract.executors import InProcess, LocalProcesses
from tests.blind_trial.protocol.small_set import TOLD, TRUTH, refusing, small_set, solved

KEY = sealing.Fernet.generate_key()


@pytest.fixture
def sealed_set(tmp_path):
    making.seal(small_set(tmp_path / "set"), lambda: KEY)
    return tmp_path / "set"


def test_answers_are_kept_case_by_case_and_together(tmp_path, monkeypatch):
    folder, heard = small_set(tmp_path / "set"), []
    count = solved(folder, monkeypatch, tell=lambda done, total: heard.append((done, total)))
    assert count == 3 * len(solving.METHODS) == len(heard)
    kept = TrialSet(folder).read("answers.json")["answers"]
    assert set(kept) == set(solving.METHODS) and set(kept["diagnosis"]) == set(TOLD)
    assert kept["diagnosis"]["002"]["verdict"] == "missing" and len(kept["diagnosis"]["002"]["code"]) == 64


def test_what_was_stopped_goes_on_and_what_is_answered_stays(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")

    def stopped(case, method, limit):
        if case.name == "002":
            raise KeyboardInterrupt
        return refusing(case, method, limit)

    monkeypatch.setattr(solving, "answered", stopped)
    with pytest.raises(KeyboardInterrupt):
        solving.solve(folder, InProcess(), ("diagnosis",))
    assert not (folder / "answers.json").exists()
    assert solved(folder, monkeypatch, methods=("diagnosis",)) == 2
    kept = TrialSet(folder).read("answers.json")["answers"]["diagnosis"]
    assert [kept[n]["verdict"] for n in sorted(kept)] == ["refused", "missing", "missing"]
    assert solved(folder, monkeypatch, methods=("diagnosis",)) == 0


def test_a_method_that_answered_some_cases_alone_is_left_out(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    monkeypatch.setattr(solving, "METHODS", ("diagnosis", "other"))
    TrialSet(folder).write("answers/other/001.json", {"verdict": "unknown"})
    solved(folder, monkeypatch, methods=("diagnosis",))
    assert list(TrialSet(folder).read("answers.json")["answers"]) == ["diagnosis"]


def test_cases_are_shared_out_over_processes(tmp_path):
    folder, work = small_set(tmp_path / "set", {n: TRUTH[n] for n in ("001", "002")}), LocalProcesses(2)
    try:
        assert solving.solve(folder, work, ("diagnosis",)) == 2
    finally:
        work.close()
    kept = TrialSet(folder).read("answers.json")["answers"]["diagnosis"]
    assert [one["verdict"] for one in kept.values()] == ["refused"] * 2
    assert all("chain: expected a chain, or sections" in one["reasons"][0] for one in kept.values())


def test_answers_of_other_code_are_renewed_in_an_open_set_alone(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    solved(folder, monkeypatch, methods=("diagnosis",))
    monkeypatch.setattr(code_digest, "of_answers", lambda files: "other")
    assert solved(folder, monkeypatch, methods=("diagnosis",)) == 3


def test_a_sealed_set_is_solved_once(sealed_set, monkeypatch):
    assert solved(sealed_set, monkeypatch) == 3 * len(solving.METHODS)
    with pytest.raises(BrakechainError, match="a sealed set is solved once"):
        solved(sealed_set, monkeypatch)


def test_methods_that_were_not_asked_may_be_added_to_a_sealed_set_until_it_is_scored(sealed_set, monkeypatch):
    solved(sealed_set, monkeypatch, methods=("stlsq",))
    shutil.rmtree(sealed_set / "answers" / "stlsq")
    assert solved(sealed_set, monkeypatch, methods=("diagnosis", "stlsq")) == 3
    assert list(TrialSet(sealed_set).read("answers.json")["answers"]) == ["stlsq", "diagnosis"]
    with pytest.raises(BrakechainError, match="found answers of stlsq; a sealed set is solved once"):
        solved(sealed_set, monkeypatch, methods=("stlsq",))
    TrialSet(sealed_set).write("result.json", {})
    with pytest.raises(BrakechainError, match="found its result; a sealed set is solved once"):
        solved(sealed_set, monkeypatch)


def test_answers_to_other_files_and_for_want_of_time_are_renewed_in_an_open_set(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    late = {**TOLD, "003": {**solver_process.refused("no answer within 10 s"), "limit": 10.0}}
    assert solved(folder, monkeypatch, late, methods=("diagnosis",), limit=10.0) == 3
    assert solved(folder, monkeypatch, methods=("diagnosis",), limit=10.0) == 0
    assert solved(folder, monkeypatch, methods=("diagnosis",), limit=20.0) == 1
    (folder / "cases" / "002" / "recordings.h5").write_bytes(b"other")
    assert solved(folder, monkeypatch, methods=("diagnosis",)) == 1


def test_a_sealed_set_is_not_solved_by_other_code_nor_with_other_cases(sealed_set, monkeypatch):
    kept = json.loads((sealed_set / "code.json").read_text())
    (sealed_set / "code.json").write_text(json.dumps({**kept, "stages/diagnosis.py": "0"}))
    with pytest.raises(BrakechainError, match=r"1 files changed before it was solved: stages/diagnosis\.py"):
        solved(sealed_set, monkeypatch)
    (sealed_set / "code.json").write_text(json.dumps(kept))
    (sealed_set / "cases" / "001" / "recordings.h5").write_bytes(b"other")
    with pytest.raises(BrakechainError, match="the cases were changed after the set was made"):
        solved(sealed_set, monkeypatch)


def test_code_that_changes_while_a_case_is_solved_is_noticed(tmp_path, monkeypatch):
    states = iter(["before", "after"])
    monkeypatch.setattr(code_digest, "of_answers", lambda files: next(states))
    with pytest.raises(BrakechainError, match="code that changed meanwhile"):
        solved(small_set(tmp_path / "set"), monkeypatch)


def test_a_method_that_nobody_knows_is_refused(tmp_path, monkeypatch):
    with pytest.raises(BrakechainError, match="--methods: expected some of diagnosis"):
        solved(small_set(tmp_path / "set"), monkeypatch, methods=("guessing",))
