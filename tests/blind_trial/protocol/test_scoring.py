"""Scoring: once, with the key, and only what belongs together."""

import json
import stat

import pytest

from pipeline.blind_trial.protocol import code_digest, making, scoring, sealing
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.blind_trial.protocol.scoring import score
from pipeline.contract.errors import BrakechainError
from tests.blind_trial.protocol.small_set import TRUTH, small_set, solved


@pytest.fixture
def key(tmp_path):
    sealing.new_key(tmp_path / "a.key")
    return tmp_path / "a.key"


@pytest.fixture
def sealed_set(tmp_path, key, monkeypatch):
    making.seal(small_set(tmp_path / "set"), lambda: sealing.read_key(key))
    solved(tmp_path / "set", monkeypatch)
    return tmp_path / "set"


def changed(path, **values):
    path.write_text(json.dumps({**json.loads(path.read_text()), **values}))


def test_a_score_publishes_truth_key_salt_and_result(sealed_set, key):
    scored = score(sealed_set, key)
    found = TrialSet(sealed_set)
    assert found.read("truth.json") == TRUTH and found.read("result.json") == scored
    opened = found.read_yaml("opened.yaml")
    assert opened["key"] == key.read_text().strip()
    assert sealing.commitment(opened["salt"], TRUTH) == found.about["commitment"]
    assert scored["methods"]["diagnosis"]["rates"]["type and place, one effect"]["hits"] == 1
    assert scored["cases"]["003"]["answers"]["diagnosis"]["why"][0] == "another effect was named"
    assert scored["set"]["commitment"] == found.about["commitment"]


def test_a_set_is_scored_once(sealed_set, key):
    score(sealed_set, key)
    with pytest.raises(BrakechainError, match="a sealed set that was not scored, found its result"):
        score(sealed_set, key)


def test_no_key_and_another_key_are_refused(sealed_set, key, tmp_path):
    with pytest.raises(BrakechainError, match="the key of the set at"):
        score(sealed_set, tmp_path / "none.key")
    sealing.new_key(tmp_path / "b.key")
    with pytest.raises(BrakechainError, match="what this key opens"):
        score(sealed_set, tmp_path / "b.key")
    assert not (sealed_set / "truth.json").exists() and not (sealed_set / "opened.yaml").exists()


def test_a_commitment_that_does_not_match_is_refused_and_nothing_is_opened(sealed_set, key):
    about = (sealed_set / "set.yaml").read_text()
    told = TrialSet(sealed_set).about["commitment"]
    (sealed_set / "set.yaml").write_text(about.replace(told, "0" * 64))
    with pytest.raises(BrakechainError, match="truth or commitment was changed"):
        score(sealed_set, key)
    assert not (sealed_set / "truth.json").exists()


def test_a_truth_that_was_sealed_anew_does_not_match(sealed_set, key):
    other = {**TRUTH, "003": TRUTH["001"]}
    content, _ = sealing.sealed(other, sealing.read_key(key))
    (sealed_set / "truth.sealed").write_bytes(content)
    with pytest.raises(BrakechainError, match="truth or commitment was changed"):
        score(sealed_set, key)


def test_code_that_changed_between_commitment_and_score_is_refused(sealed_set, key, monkeypatch):
    changed = {**code_digest.files(), "pipeline/blind_trial/metrics/criteria.py": "0"}
    monkeypatch.setattr(code_digest, "files", lambda: changed)
    name = r"changed before it was scored: pipeline/blind_trial/metrics/criteria\.py"
    with pytest.raises(BrakechainError, match=name):
        score(sealed_set, key)


def test_cases_and_answers_that_were_changed_are_refused(sealed_set, key):
    recorded = sealed_set / "cases" / "001" / "recordings.h5"
    (before, mode) = recorded.read_bytes(), stat.S_IMODE(recorded.stat().st_mode)
    recorded.write_bytes(b"other")
    with pytest.raises(BrakechainError, match="the cases were changed after the set was made"):
        score(sealed_set, key)
    recorded.write_bytes(before)
    recorded.chmod(mode)
    changed(sealed_set / "answers.json", answers={})
    with pytest.raises(BrakechainError, match="answers that were changed"):
        score(sealed_set, key)


def test_a_set_that_is_not_solved_is_not_scored(tmp_path, key):
    making.seal(small_set(tmp_path / "set"), lambda: sealing.read_key(key))
    with pytest.raises(BrakechainError, match="answers of all cases, found 0 of 3"):
        score(tmp_path / "set", key)
    assert not (tmp_path / "set" / "truth.json").exists()


def test_answers_of_baselines_alone_are_not_scored(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    solved(folder, monkeypatch, methods=("stlsq",))
    with pytest.raises(BrakechainError, match="answers of the diagnosis, found stlsq"):
        score(folder)


def test_an_open_set_is_scored_from_its_truth_wherever_it_lies_and_again(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    solved(folder, monkeypatch)
    assert score(folder) == score(folder)
    (folder / "truth.json").rename(tmp_path / "elsewhere.json")
    assert score(folder, truth_file=tmp_path / "elsewhere.json")["cases"]["001"]["truth"] == TRUTH["001"]
    with pytest.raises(BrakechainError, match=r"truth\.json: expected a readable JSON file"):
        score(folder)
    (tmp_path / "elsewhere.json").write_text(json.dumps({"001": TRUTH["001"]}))
    with pytest.raises(BrakechainError, match="002, 003 in only one of both"):
        score(folder, truth_file=tmp_path / "elsewhere.json")


def test_an_open_set_is_not_scored_with_answers_to_other_files(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    solved(folder, monkeypatch)
    (folder / "cases" / "002" / "nominal.yaml").write_text("# other\n")
    with pytest.raises(BrakechainError, match=r"found \d to other files; run again"):
        score(folder)


def test_nothing_is_opened_where_the_score_fails(sealed_set, key, monkeypatch):
    def failing(*_):
        raise KeyError("noise")

    monkeypatch.setattr(scoring, "result", failing)
    with pytest.raises(BrakechainError, match="found others .KeyError: 'noise'.") as error:
        score(sealed_set, key)
    assert isinstance(error.value.__cause__, KeyError)
    assert not (sealed_set / "truth.json").exists() and not (sealed_set / "opened.yaml").exists()


def test_an_open_set_is_not_scored_with_answers_of_other_code(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "set")
    solved(folder, monkeypatch)
    monkeypatch.setattr(code_digest, "of_answers", lambda files: "other")
    with pytest.raises(BrakechainError, match="of other code; run again"):
        score(folder)
