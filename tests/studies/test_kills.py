"""The study of deaths: it sees what is damaged, and a killed run recovers."""

import pytest

from tests.studies.kills import CASES, EXECUTORS, KILLS, Undisturbed, add, damaged, rows, solved, undisturbed


def test_more_than_three_hundred_deaths_are_planned():
    assert len(CASES) * len(EXECUTORS) * KILLS >= 300


def test_a_file_that_differs_is_seen_and_one_that_lacks_is_not_damaged(tmp_path):
    (tmp_path / "report.html").write_text("one")
    (tmp_path / ".lock").write_text("1")
    whole = Undisturbed({"report.html": "another", "modes.csv": "0"}, 1.0)
    assert damaged(tmp_path, whole) == 1 and damaged(tmp_path / "none", whole) == 0


def test_rows_come_back(tmp_path):
    for executor in EXECUTORS:
        add(tmp_path / "kills.csv", ("belt", executor, 3, 2, 0, "yes", 12, "abc"))
    assert [(row["executor"], row["struck"]) for row in rows(tmp_path / "kills.csv")] == [(e, "2") for e in EXECUTORS]


@pytest.mark.slow
@pytest.mark.study
def test_a_run_and_a_worker_that_die_leave_what_is_whole(tmp_path):
    whole = undisturbed("two_mode_flutter", tmp_path / "whole")
    for executor in ("2", "dask"):
        row = solved("two_mode_flutter", executor, tmp_path / executor, whole, 2, 1)
        assert row[4] == 0 and row[5] == "yes"
