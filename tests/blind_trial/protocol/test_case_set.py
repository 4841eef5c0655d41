"""Folders of sets: what they hold, and what is refused."""

import pytest

from pipeline.blind_trial.protocol.case_set import TrialSet, canonical, in_format, read_json
from pipeline.contract.errors import BrakechainError, ConfigError, ProductError
from tests.blind_trial.protocol.small_set import small_set


def test_a_folder_made_by_hand_is_a_set(tmp_path):
    found = TrialSet(small_set(tmp_path / "mine"))
    assert found.name == "mine" and list(found.cases) == ["001", "002", "003"] and not found.sealed
    first = found.digest()
    (tmp_path / "mine" / "cases" / "002" / "recordings.h5").write_bytes(b"other")
    assert found.digest() != first


@pytest.mark.parametrize("spoil, message", [
    (lambda f: (f / "cases" / "002" / "recordings.h5").unlink(), "found no recordings.h5"),
    (lambda f: (f / "cases").rename(f / "case"), "expected folders of cases")])
def test_a_folder_that_is_no_set_is_refused(tmp_path, spoil, message):
    spoil(small_set(tmp_path / "mine"))
    with pytest.raises(BrakechainError, match=message):
        TrialSet(tmp_path / "mine").cases  # noqa: B018


def test_another_format_and_unreadable_json_are_refused(tmp_path):
    folder = small_set(tmp_path / "mine")
    (folder / "set.yaml").write_text("format: other/2\n")
    with pytest.raises(BrakechainError, match="format: brakechain-trial/1"):
        TrialSet(folder)
    (folder / "truth.json").write_text("{")
    with pytest.raises(BrakechainError, match="a readable JSON file"):
        read_json(folder / "truth.json")


def test_the_canonical_text_is_blind_to_the_order_of_keys():
    assert canonical({"b": 1, "a": [2.5]}) == canonical({"a": [2.5], "b": 1}) == b'{"a":[2.5],"b":1}'


def test_what_values_of_others_lead_to_is_one_sentence(tmp_path):
    with pytest.raises(ConfigError, match=r"expected files of a set as .* found others \(KeyError: 'answers'\)"), (
            in_format(tmp_path)):
        {}["answers"]  # noqa: B018
    with pytest.raises(ProductError, match="as it is"), in_format(tmp_path):
        raise ProductError("as it is")
