"""Truths in other words than the document's are refused before anything is sealed."""

import json

import pytest

from pipeline.blind_trial.protocol import making
from pipeline.contract.errors import ConfigError
from tests.blind_trial.protocol.small_set import TRUTH, small_set


@pytest.mark.parametrize("change, said", [
    ({"class": "efect"}, r"truth\.json: 002: class: expected one of control, .*, found 'efect'"),
    ({"effects": "coulomb"}, r"002: effects: expected a list of"), ({"effects": [{"name": "coulomb"}]}, "002: effects"),
    ({"effects": [{"name": "a", "place": "b", "alike": ["c"]}]}, "002: alike of a: expected a list"),
    ({"left": "many"}, "002: left: expected a number, found 'many'"),
    ({"parameters": {"masses.a": "1 kg"}}, r"002: parameters\.masses\.a: expected a number, found '1 kg'")])
def test_a_truth_in_other_words_is_refused(tmp_path, change, said):
    folder = small_set(tmp_path / "set")
    (folder / "truth.json").write_text(json.dumps({**TRUTH, "002": {**TRUTH["002"], **change}}))
    with pytest.raises(ConfigError, match=said):
        making.seal(folder, lambda: b"")
    assert not (folder / "set.yaml").exists() and not (folder / "truth.sealed").exists()


def test_a_truth_without_effects_is_refused(tmp_path):
    folder = small_set(tmp_path / "set")
    (folder / "truth.json").write_text(json.dumps({**TRUTH, "002": {"class": "effect"}}))
    with pytest.raises(ConfigError, match="002: effects: expected a list of .*, found None"):
        making.seal(folder, lambda: b"")
