"""A short run of the fuzzer over every target, and every input that once failed."""

import tempfile
from collections import Counter

import pytest

from tests.fuzz import ledger
from tests.fuzz.targets import all_targets
from tests.fuzz.trial import BAD
from tests.fuzz.worker import tried

#: inputs of each target, about a second of processor; those of 'make fuzz' have other seeds
SHORT = {
    "table": 400,
    "friction": 300,
    "sep005": 300,
    "matlab": 150,
    "hdf5": 25,
    "uff": 80,
    "audio": 250,
    "tdms": 200,
    "mdf": 60,
    "matrix": 80,
    "mesh": 120,
    "scan": 20,
    "case": 40,
    "facts": 120,
    "schedule": 100,
    "quantity": 600,
    "product": 150,
    "inspect": 60,
    "run list": 500,
    "verify set": 15,
    "score set": 30,
    "tdms meaning": 30,
    "mdf meaning": 30,
    "audio meaning": 30,
    "files meaning": 30,
    "table meaning": 30,
    "matlab meaning": 60,
    "uff meaning": 10,
    "scan meaning": 20,
    "hdf5 meaning": 6,
}
#: targets of which every input is right
WHOLE = ("run list", "files meaning", "audio meaning", "hdf5 meaning")


@pytest.fixture(autouse=True)
def scratch(tmp_path, monkeypatch):
    """Files of children that are ended go with the folder of the test."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def test_every_target_has_a_short_run():
    assert set(SHORT) == set(all_targets())


@pytest.mark.parametrize("name", SHORT)
def test_no_input_fails(name):
    outcomes = dict(tried(all_targets()[name], 0, range(SHORT[name])))
    failed = {number: result for number, result in outcomes.items() if result.kind in BAD}
    assert not failed, f"python -m tests.fuzz --only {name!r} --seed 0: {failed}"
    kinds = Counter(result.kind for result in outcomes.values())
    assert len(outcomes) == SHORT[name] and kinds["read"] and (name in WHOLE or len(kinds) > 1), kinds


@pytest.mark.parametrize("seed", ledger.seeds(), ids=lambda s: f"{s['target']}-{s['seed']}-{s['number']}")
def test_what_once_failed(seed):
    ((_, result),) = tried(all_targets()[seed["target"]], seed["seed"], [seed["number"]])
    assert result.kind not in BAD, result
