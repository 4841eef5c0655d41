"""The table of reference: between its rows by powers, beyond them in proportion, far beyond nothing."""

import json

import pytest

from pipeline.case_models.early.reference_pace import Reference, measured


@pytest.fixture
def reference(tmp_path):
    """A stage that takes 4 s and 400 s for 1 and 100 units; half of the longer one is done side by side."""
    table = tmp_path / "table.json"
    table.write_text(json.dumps({"processor": 1.0, "stages": {"modes": [[100.0, 400.0, 0.5], [1.0, 4.0, 0.0]]}}))
    return Reference(table)


@pytest.mark.parametrize(("work", "workers", "seconds"), [
    (1.0, 1, 4), (10.0, 1, 40), (200.0, 1, 800), (0.5, 4, 2), (100.0, 2, 300), (10.0, 2, 35)])
def test_seconds_follow_work_and_processes(reference, work, workers, seconds):
    assert reference.seconds("modes", work, workers) == pytest.approx(seconds)


def test_of_other_stages_and_sizes_nothing_is_said(reference):
    assert reference.seconds("report", 1.0, 1) is None
    assert reference.seconds("modes", 0.05, 1) is reference.seconds("modes", 2000.0, 1) is None


def test_equal_work_of_two_runs_takes_their_mean_in_proportion(tmp_path):
    table = tmp_path / "table.json"
    table.write_text(json.dumps({"processor": 1.0, "stages": {"report": [[1.0, 4.0, 0.0], [1.0, 16.0, 0.0]]}}))
    assert Reference(table).seconds("report", 1.0, 2) == pytest.approx(8)


def test_the_table_that_comes_with_the_program_has_the_long_stages():
    table = Reference()
    for stage in ("micro_friction", "structure", "complex_modes", "convergence", "limit_cycle", "probability"):
        assert table._rows[stage], stage
    assert 0.1 < measured() / table.processor < 20
