"""A forecast says what earlier runs took, in proportion to the work, and what it does not know."""

import json
from types import SimpleNamespace

import pytest

from pipeline.cli import pace
from pipeline.cli.pace import Pace


@pytest.fixture
def clock(monkeypatch):
    now = SimpleNamespace(time=0.0)
    monkeypatch.setattr(pace.time, "monotonic", lambda: now.time)
    return now


def made(monkeypatch, folder, measure=1.0, workers=2):
    monkeypatch.setattr(pace, "work", lambda sections: dict.fromkeys(("structure", "probability", "report"), measure))
    return Pace(SimpleNamespace(case=SimpleNamespace(sections={"structure": True})), workers, folder)


def state(name, variant="", reasons=("new",)):
    return SimpleNamespace(stage=SimpleNamespace(name=name), variant=variant, reasons=reasons)


STATES = [state("structure"), state("probability"), state("report")]


def run(made, clock, seconds, variants=0):
    """Notes of a run whose stages take ``seconds`` each, the last with variants."""
    made.begin()
    for name in ("structure", "probability"):
        for _ in range(variants if name == "probability" else 0):
            made.note(state("structure", "finer"), 1.0)
        clock.time += seconds
        made.note(state(name), seconds)


def test_nothing_is_known_at_first_then_the_times_of_the_last_run(monkeypatch, tmp_path, clock):
    first = made(monkeypatch, tmp_path)
    assert first.forecast(STATES) == ("how long this takes is not known: no run of structure, probability on this"
                                            " machine yet")
    assert first.forecast([state("structure", reasons=())]) == "", "nothing is computed"
    run(first, clock, 60.0)
    again = made(monkeypatch, tmp_path)
    assert again.forecast(STATES) == "this will take about 2 min by the times of earlier runs on this machine"
    assert again.forecast(STATES[:1]).startswith("this will take about 60 s by")
    assert "not known" in made(monkeypatch, tmp_path, workers=1).forecast(STATES), "other processes, other times"


def test_times_are_in_proportion_to_the_work_and_those_of_the_same_work_count_first(monkeypatch, tmp_path, clock):
    run(made(monkeypatch, tmp_path, measure=1.0), clock, 60.0)
    assert "about 6 min" in made(monkeypatch, tmp_path, measure=3.0).forecast(STATES)
    assert "not known" in made(monkeypatch, tmp_path, measure=11.0).forecast(STATES), "too far to tell"
    for seconds in (200.0, 240.0, 900.0):       # a run beside another one took longer: the median is told
        run(made(monkeypatch, tmp_path, measure=3.0), clock, seconds)
    assert "about 8 min" in made(monkeypatch, tmp_path, measure=3.0).forecast(STATES)


def test_what_has_not_run_is_named(monkeypatch, tmp_path, clock):
    first = made(monkeypatch, tmp_path)
    clock.time += 50.0
    first.note(state("structure"), 50.0)
    told = first.forecast(STATES)
    assert told == ("this will take about 50 s by the times of earlier runs on this machine, and what probability will"
                    " take, no run of which is known")


def test_runs_that_went_on_with_finished_variants_do_not_count(monkeypatch, tmp_path, clock):
    run(made(monkeypatch, tmp_path), clock, 100.0, variants=4)
    run(made(monkeypatch, tmp_path), clock, 30.0, variants=1)
    kept = made(monkeypatch, tmp_path)
    assert kept._seconds("probability") == 100.0 and kept._seconds("structure") == 65.0


@pytest.mark.parametrize("content", ["{", "[]", '{"structure with 2": 3}', '{"structure with 2": [[1, 2]]}',
                                     '{"structure with 2": [[0, 5, 0]]}', '{"structure with 2": [["a", 5, 0]]}'])
def test_a_damaged_file_of_notes_is_none(monkeypatch, tmp_path, clock, content):
    (tmp_path / "pace.json").write_text(content)
    first = made(monkeypatch, tmp_path)
    assert "not known" in first.forecast(STATES)
    run(first, clock, 60.0)
    assert len(json.loads((tmp_path / "pace.json").read_text())) == 2


def test_a_folder_that_cannot_be_written_is_left(monkeypatch, tmp_path, clock):
    (tmp_path / "file").write_text("")
    run(made(monkeypatch, tmp_path / "file"), clock, 60.0)
    assert (tmp_path / "file").read_text() == ""
