"""The door of the baselines: an answer, or a refusal with its reason."""

import json
import sys

import pytest

from pipeline.blind_trial import baselines
from pipeline.blind_trial.baselines import __main__ as door
from pipeline.contract.errors import ConfigError


def answering(monkeypatch, tmp_path, answer):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["baselines", "toy"])
    monkeypatch.setattr(door, "load", lambda name: answer)
    door.main()


def test_an_answer_is_left_where_the_diagnosis_leaves_its_own(tmp_path, monkeypatch):
    answering(monkeypatch, tmp_path, lambda folder: {"verdict": "unknown", "effects": [], "folder": folder.name})
    assert json.loads((tmp_path / "products" / "diagnosis.json").read_text())["folder"] == tmp_path.name


def test_a_refusal_is_one_sentence_and_leaves_no_answer(tmp_path, monkeypatch, capsys):
    def refuses(folder):
        raise ConfigError("toy", "samples", "a list of lines")

    with pytest.raises(SystemExit):
        answering(monkeypatch, tmp_path, refuses)
    assert capsys.readouterr().err == "error: toy: expected samples, found a list of lines\n"
    assert not (tmp_path / "products").exists()


def test_every_baseline_can_be_loaded():
    assert all(callable(baselines.load(name)) for name in baselines.BASELINES)
