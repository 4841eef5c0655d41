"""The chapter of a recording."""

import numpy as np

from pipeline.contract import store
from pipeline.contract.mapped import map_of
from pipeline.products import MeasuredFriction, Recording, Run
from pipeline.recordings.samples import channel
from pipeline.views.chapters.bench.recording import chapter
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench import recording

KINDS = ("conditions", "frf", "modes", "lines", "topography", "friction")


def run(values, repeat_of=""):
    signal = channel(values, "kN", "force", 100.0, 0.0, "test", role="excitation")
    return Run(description="hammer", repeat_of=repeat_of, channels={"force": signal}, **{k: {} for k in KINDS})


def test_the_chapter_tells_every_channel_and_what_is_missing():
    values = np.sin(np.arange(200) / 5)
    values[50:100] = np.nan
    made = chapter(Recording(source=["a.mat 0123"], runs={"first": run(values), "again": run(values, "first")}), Look())
    assert made.see == "2 runs from a.mat." and made.conclude.startswith("1 run repeats another")
    assert made.tables[0].rows[0][:4] == ("first", "force", "force", "excitation") and len(made.figures) == 2
    assert made.tables[0].rows[0][4].startswith("1") and "25" in made.tables[0].rows[0][7]


def test_the_picture_shows_samples_and_gaps():
    whole, gap = np.sin(np.arange(200) / 5), np.sin(np.arange(200) / 5)
    gap[50:100] = np.nan
    first = recording.channels(run(whole), 60)
    assert recording.channels(run(whole), 60) == first != recording.channels(run(gap), 60)
    assert recording.channels(run(2 * whole), 60) != first


def test_the_picture_spans_every_channel(monkeypatch):
    """A channel that begins late leaves the others whole."""
    drawn = []
    monkeypatch.setattr(recording, "png", lambda figure, dpi: drawn.append(figure.axes[0].get_xlim()))
    early, late = (channel(np.ones(200), "Pa", "pressure", 100.0, begin, "a") for begin in (0.0, 3.0))
    recording.channels(Run(description="", repeat_of="", channels={"mic": early, "line": late}), 60)
    assert drawn == [(0.0, 4.99)]


def test_the_chapter_tells_the_remarks():
    told = Recording(source=["a.mat 0123"], remarks=["a.mat: x: so"], runs={"first": run(np.ones(9))})
    assert chapter(told, Look()).tables[-1].rows == (("a.mat: x: so",),)


def test_a_channel_in_a_file_looks_as_in_memory(tmp_path):
    values = np.sin(np.arange(300_000) / 5000) * np.linspace(-2, 1, 300_000)
    store.write(Recording(source=[], runs={"long": run(values)}), tmp_path / "recording.h5", {})
    outside, inside = (store.read(Recording, tmp_path / "recording.h5", whole).runs["long"] for whole in (False, True))
    assert map_of(outside.channels["force"].samples) is not None
    assert recording.channels(outside, 60) == recording.channels(inside, 60)
    assert recording.largest(outside.channels["force"]) == 1e3 * np.abs(values).max()


def rubbed(scale=1.0):
    told = MeasuredFriction(friction=scale * np.array([0.4, 0.42, 0.5, 0.52]), friction_std=np.full(4, 0.01),
                            pressure=np.full(4, 1e6), speed=[1.0, 2.0, 1.0, 2.0], distance=[0.0, 0.0, 0.01, 0.01],
                            temperature=np.full(4, 293.15))
    empty = {k: {} for k in (*KINDS, "channels") if k != "friction"}
    return Recording(source=["pad.h5 0123"], runs={"drag": Run(description="", repeat_of="", friction={"cell": told},
                                                               **empty)})


def test_measured_friction_is_drawn_and_no_empty_table_of_channels_shown():
    made = chapter(rubbed(), Look())
    assert "mean over speeds; runs drag" in made.figures[0].caption and not made.conclude
    assert [t.title for t in made.tables] == ["Other measurements"]
    assert recording.friction(rubbed()) == made.figures[0].image != recording.friction(rubbed(1.2))
