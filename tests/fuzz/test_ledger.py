"""The ledger of runs and the list of seeds."""

from collections import Counter

import pytest

from tests.fuzz import ledger
from tests.fuzz.ledger import Row


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.setattr(ledger, "LEDGER", tmp_path / "fuzz.csv")
    monkeypatch.setattr(ledger, "SEEDS", tmp_path / "seeds.yaml")
    (tmp_path / "seeds.yaml").write_text("# seeds\n")


def test_a_run_goes_on_where_the_last_one_ended(files):
    assert ledger.next_number("table", 1) == 0
    ledger.append([Row("table", 1, 0, Counter(read=3, refused=2)), Row("mdf", 1, 0, Counter(read=1))])
    ledger.append([Row("table", 1, 5, Counter(read=3, hang=1), 2, 1.5, 9.0)])
    assert [ledger.next_number(*of) for of in (("table", 1), ("table", 2), ("mdf", 1))] == [9, 0, 1]
    assert ledger.LEDGER.read_text().splitlines()[0].split(",") == list(ledger.HEAD)


def test_the_table_sums_up():
    lines = ledger.table(
        [Row("table", 1, 0, Counter(read=3, refused=2), 1), Row("mdf", 1, 0, Counter(read=1, hang=1), 0, 2.0)]
    )
    assert lines[-1].split()[:5] == ["all", "7", "4", "0", "2"] and lines[-1].split()[-1] == "2.0"
    assert Row("mdf", 1, 0, Counter(read=1, hang=1)).failed == 1


def test_what_failed_is_kept_once(files):
    failure = {"target": "table", "seed": 1, "number": 60, "kind": "wrong", "said": "cut off: 'x': 1 for 2"}
    ledger.keep([failure, failure | {"number": 61}])
    ledger.keep([failure])
    assert [seed["number"] for seed in ledger.seeds()] == [60, 61] and ledger.seeds()[0] == failure
