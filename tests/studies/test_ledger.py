"""The ledger of a study: rows come back, the later one of a case counts, a name with a comma is kept."""

from tests.studies.ledger import COLUMNS, Ledger, answer_of


def answer(verdict, *effects):
    return {"verdict": verdict, "effects": [{"name": n, "place": p} for n, p in effects], "cpu_seconds": 12.4}


def test_answers_come_back_from_their_rows(tmp_path):
    ledger = Ledger(tmp_path / "new" / "study.csv")
    assert ledger.rows() == {}
    ledger.tidy()
    assert not ledger.path.exists()
    ledger.add("b", "coulomb", 0.01, 31.26, answer("missing", ("coulomb", "joint_1"), ("play, wide", "joint_2")))
    ledger.add("a", "", 0.1, 4.0, answer("unknown"))
    assert list(ledger.rows()) == ["a", "b"]
    row = ledger.rows()["b"]
    assert (row["hidden"], row["noise"], row["left"], row["cpu_seconds"]) == ("coulomb", "0.01", "31.3", "12")
    assert answer_of(row)["effects"] == [{"name": "coulomb", "place": "joint_1"},
                                         {"name": "play, wide", "place": "joint_2"}]
    assert answer_of(ledger.rows()["a"]) == {"verdict": "unknown", "effects": [], "cpu_seconds": 12.0}


def test_the_later_row_of_a_case_counts(tmp_path):
    ledger = Ledger(tmp_path / "study.csv")
    for verdict in ("unknown", "missing"):
        ledger.add("b", "coulomb", 0.01, 31.0, answer(verdict))
    ledger.add("a", "coulomb", 0.01, 31.0, answer("unknown"))
    before = ledger.rows()
    ledger.tidy()
    lines = ledger.path.read_text().splitlines()
    assert lines[0] == ",".join(COLUMNS) and len(lines) == 3 and lines[1].startswith("a,")
    assert ledger.rows() == before and before["b"]["verdict"] == "missing"
