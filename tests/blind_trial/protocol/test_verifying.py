"""Verifying: anyone can see that truth, commitment, answers and result belong together."""

import json
import re

import pytest

from pipeline.blind_trial.protocol import making, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet, canonical, sha256
from pipeline.blind_trial.protocol.scoring import score, scored_as
from pipeline.blind_trial.protocol.verifying import difference, verify
from pipeline.contract.errors import BrakechainError
from tests.blind_trial.protocol.small_set import TRUTH, small_set, solved


@pytest.fixture
def published(tmp_path, monkeypatch):
    sealing.new_key(tmp_path / "a.key")
    making.seal(small_set(tmp_path / "set"), lambda: sealing.read_key(tmp_path / "a.key"))
    solved(tmp_path / "set", monkeypatch)
    score(tmp_path / "set", tmp_path / "a.key")
    (tmp_path / "a.key").unlink()
    return tmp_path / "set"


def spoilt(path, change):
    values = json.loads(path.read_text())
    change(values)
    path.write_text(json.dumps(values))


def test_a_published_set_holds_with_its_cases_and_without(published):
    told = verify(published)
    assert len(told) == 6 and TrialSet(published).about["commitment"] in "\n".join(told)
    for case in (published / "cases").rglob("*.*"):
        case.unlink()
    for case in [*(published / "cases").iterdir(), published / "cases"]:
        case.rmdir()
    assert verify(published) == told[:-1]


@pytest.mark.parametrize("file, change, message", [
    ("truth.json", lambda v: v["001"].update({"class": "effect"}), "truth.json is not what was sealed"),
    ("result.json", lambda v: v["cases"]["003"].update(truth=TRUTH["001"]), "not the score of these answers"),
    ("result.json", lambda v: v["set"].update(commitment="0" * 64), "not the score of these answers"),
    ("answers.json", lambda v: v["answers"]["diagnosis"]["003"].update(verdict="unknown"), "not what was solved"),
    ("answers.json", lambda v: (v["answers"]["diagnosis"]["003"].update(code="0"), v.update(digest=sha256(canonical(
        v["answers"])))), "other code than that of the commitment")])
def test_what_was_changed_afterwards_is_found(published, file, change, message):
    spoilt(published / file, change)
    with pytest.raises(BrakechainError, match=message):
        verify(published)


def test_values_that_are_wrong_in_the_truth_are_told_and_not_compared(published):
    def compared():
        return TrialSet(published).read("result.json")["methods"]["diagnosis"]["parameters"]["nominal"]["count"]

    before = compared()
    wrong = {"system": "rig", "parameters": ["masses.a"], "reason": "grams, not kilograms"}
    TrialSet(published).write("errata.yaml", {"errata": [wrong]})
    with pytest.raises(BrakechainError, match="not the score of these answers"):
        verify(published)
    found = TrialSet(published)
    found.write("result.json", scored_as(found, found.read("truth.json"), found.read("answers.json")["answers"]))
    assert "errata.yaml: not compared are masses.a of rig: grams, not kilograms" in verify(published)
    assert (before, compared()) == (1, 0)


def test_another_commitment_and_other_cases_are_found(published):
    (published / "cases" / "002" / "nominal.yaml").write_text("# other\n")
    with pytest.raises(BrakechainError, match=r"the cases are not those of set\.yaml"):
        verify(published)
    about = (published / "set.yaml").read_text()
    (published / "set.yaml").write_text(about.replace(TrialSet(published).about["commitment"], "0" * 64))
    with pytest.raises(BrakechainError, match="truth or commitment was changed"):
        verify(published)


def test_an_open_set_has_nothing_to_hide_and_an_unscored_one_nothing_to_verify(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    with pytest.raises(BrakechainError, match="a set that was scored"):
        verify(folder)
    solved(folder, monkeypatch)
    score(folder)
    assert verify(folder)[0] == "open set: nothing was sealed"


@pytest.mark.parametrize("now, where", [
    ({"a": {"count": 3, "low": 0.5}}, None), ({"a": {"count": 3, "low": 0.50004}}, None),
    ({"a": {"count": 3, "low": 0.501}}, r"result\.a\.low"), ({"a": {"count": 4, "low": 0.5}}, r"result\.a\.count"),
    ({"a": {"count": True, "low": 0.5}}, r"result\.a\.count"), ({"a": {"count": 3}}, "low on one side only"),
    ({"a": [3, 0.5]}, r"result\.a")])
def test_results_differ_where_a_count_a_word_or_a_number_does(now, where):
    found = difference(now, {"a": {"count": 3, "low": 0.5}})
    assert found is None if where is None else re.search(where, found)


@pytest.mark.parametrize("file, change", [
    ("answers.json", lambda v: v.pop("answers")), ("answers.json", lambda v: v["answers"].update(diagnosis=3)),
    ("truth.json", lambda v: v["001"].update(effects=7)), ("result.json", lambda v: v.update(errata=5))])
def test_files_of_other_types_are_one_sentence(published, file, change):
    spoilt(published / file, change)
    with pytest.raises(BrakechainError, match="expected"):
        verify(published)
