"""A forecast says what earlier runs took, in proportion to the work, and what it does not know."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.early.reference_pace import Reference
from pipeline.cli import pace
from pipeline.cli.pace import Pace


@pytest.fixture
def clock(monkeypatch):
    now = SimpleNamespace(time=0.0)
    monkeypatch.setattr(pace.time, "monotonic", lambda: now.time)
    return now


def made(monkeypatch, folder, measure=1.0, workers=2, stages=None):
    """A Pace with a table of reference of these ``stages``."""
    table = folder / "reference.json"
    if folder.is_dir():
        table.write_text(json.dumps({"processor": 0.5, "stages": stages or {}}))
        monkeypatch.setattr(pace, "Reference", lambda: Reference(table))
    monkeypatch.setattr(pace, "measured", lambda: 1.0)
    monkeypatch.setattr(pace, "peak_memory", lambda sections: 7e9)
    monkeypatch.setattr(pace, "work", lambda sections: dict.fromkeys(("structure", "probability", "report"), measure))
    return Pace(SimpleNamespace(case=SimpleNamespace(sections={"structure": True})), workers, folder)


def state(name, variant="", reasons=("new",), **options):
    stage = SimpleNamespace(**{"name": name, "alone": False, "reads_all": name == "report", "inputs": {},
                               "output": name, **options})
    return SimpleNamespace(stage=stage, variant=variant, reasons=reasons)


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


def test_times_of_another_size_grow_as_those_of_the_reference_do(monkeypatch, tmp_path, clock):
    """Twice the work takes three times as long there, and here."""
    table = {"structure": [[1.0, 10.0, 0.0], [2.0, 30.0, 0.0]], "probability": [], "report": []}
    run(made(monkeypatch, tmp_path, stages=table), clock, 60.0)
    larger = made(monkeypatch, tmp_path, measure=2.0, stages=table)
    assert larger._seconds("structure") == pytest.approx(3 * 60)
    assert larger._seconds("probability") == pytest.approx(2 * 60), "in proportion where it says nothing"


def test_runs_of_a_few_elements_say_little(monkeypatch, tmp_path, clock):
    """They neither push out the notes of a larger case nor say how fast the machine is: they mostly start."""
    table = {"structure": [[0.01, 0.2, 0.0], [1.0, 60.0, 0.0]], "probability": [[1.0, 80.0, 0.0]]}
    large = made(monkeypatch, tmp_path, stages=table)
    clock.time += 60.0
    large.note(state("structure"), 60.0)
    small = made(monkeypatch, tmp_path, measure=0.01, stages=table)
    for _ in range(7):
        small.begin()
        clock.time += 2.0
        small.note(state("structure"), 2.0)
    again = made(monkeypatch, tmp_path, stages=table)
    assert again._seconds("structure") == pytest.approx(60.0)
    assert again._seconds("probability") == pytest.approx(80.0)


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


def test_where_nothing_has_run_the_reference_tells_by_the_pace_of_the_processor(monkeypatch, tmp_path, clock):
    """Half the pace of the reference by dense algebra, so 1.4 times its 100 and 80 CPU s, the latter side by side."""
    table = {"structure": [[1.0, 100.0, 0.0]], "probability": [[1.0, 80.0, 1.0]]}
    first = made(monkeypatch, tmp_path, stages=table)
    slower = np.sqrt(2)
    assert first.forecast(STATES) == "this will take about 3 min by the times of another machine, scaled to this one"
    assert first._seconds("probability") == pytest.approx(40 * slower)
    assert first._seconds("structure") == pytest.approx(100 * slower)
    assert made(monkeypatch, tmp_path, workers=1, stages=table)._seconds("probability") == pytest.approx(80 * slower)
    monkeypatch.setattr(pace, "measured", lambda: 1 / 0)
    assert first._seconds("structure") == pytest.approx(100 * slower), "measured once"


def test_what_has_run_tells_the_pace_of_what_has_not(monkeypatch, tmp_path, clock):
    """Structure took thrice the time of the reference here: so will draws, twice as many as there."""
    table = {"structure": [[2.0, 100.0, 0.0]], "probability": [[1.0, 80.0, 0.5]]}
    first = made(monkeypatch, tmp_path, measure=2.0, stages=table)
    first.begin()
    clock.time += 300.0
    first.note(state("structure"), 300.0)
    assert first._seconds("probability") == pytest.approx(3 * 2 * 80 * 0.75)


def test_what_runs_beside_a_long_task_is_counted_once(monkeypatch, tmp_path, clock):
    """80 s of draws, 40 by two processes, are done beside the long task; what reads its product waits for it."""
    table = {"structure": [[1.0, 50.0, 0.0]], "probability": [[1.0, 40.0, 1.0]], "report": [[1.0, 5.0, 0.0]]}
    states = [state("structure", alone=True), *STATES[1:]]
    assert made(monkeypatch, tmp_path, stages=table).forecast(states).startswith("this will take about 78 s")
    first = made(monkeypatch, tmp_path, stages=table)
    assert first._side_by_side([s.stage for s in states]) == pytest.approx(np.sqrt(2) * 20)
    assert made(monkeypatch, tmp_path, workers=1, stages=table)._side_by_side([s.stage for s in states]) == 0
    reader = state("probability", inputs={"before": ("structure",)})
    assert first._side_by_side([states[0].stage, reader.stage]) == 0
    table["structure"] = [[1.0, 20.0, 0.0]]
    shorter = made(monkeypatch, tmp_path, stages=table)
    beside = shorter._side_by_side([s.stage for s in states])
    assert beside == pytest.approx(np.sqrt(2) * 10), "half of the draws are made after"


def test_too_little_memory_is_said_before_the_start(monkeypatch, tmp_path, clock):
    brake = made(monkeypatch, tmp_path)
    monkeypatch.setattr(pace, "available_memory", lambda: 5e9)
    assert "expected 7 GB of memory for this model, found 5 GB available" in brake.short_of_memory(STATES)
    assert brake.short_of_memory(STATES[1:]) == "", "what holds the model is there"
    for enough in (8e9, None):
        monkeypatch.setattr(pace, "available_memory", lambda enough=enough: enough)
        assert brake.short_of_memory(STATES) == ""
