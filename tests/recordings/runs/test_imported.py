"""Files that join a run of another one: by what, what is told, and what is refused."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import Condition, Run
from pipeline.recordings.runs.imported import Imported, later, span
from pipeline.recordings.samples import channel


def file(name, **more):
    return SimpleNamespace(**{"file": Path(name), "offset": None, "offset_std": 0.0, "common": None} | more)


def one(begin=0.0, values=None, rate=100.0):
    values = np.exp(-((np.arange(600) / rate - 3) / 0.05) ** 2) if values is None else values
    return channel(values, "bar", "pressure", rate, begin, "a")


def started(stamp=None):
    """What a sound file has made so far: run stop, 0 to 6 s."""
    told = []
    made = Imported(False, told.append)
    channels, clocks = made.on_clock(file("q.wav"), ["stop"], {"mic": one()}, stamp)
    made.add({"stop": Run(description="a stop", repeat_of="", channels=channels, clocks=clocks)}, "q.wav")
    assert not told and not clocks
    return made, told


def joined(made, second, channels, stamp=None):
    channels, clocks = made.on_clock(second, ["stop"], channels, stamp)
    made.add({"stop": Run(description="", repeat_of="", channels=channels, clocks=clocks)}, str(second.file))
    return made.runs["stop"]


def test_a_stated_offset_moves_a_file():
    made, told = started()
    run = joined(made, file("Bremsdrücke 1.tdms", offset=1.5, offset_std=0.01), {"line": one(0.5)})
    assert float(run.channels["line"].begin) == 2.0 and str(run.description) == "a stop"
    clock = run.clocks["Bremsdruecke_1_tdms"]
    assert (float(clock.offset), float(clock.offset_std)) == (1.5, 0.01) and str(clock.origin) == "stated in the case"
    assert told == made.remarks and "1.5 s +- 0.01 s are added to its times for run stop" in told[0]


def test_time_stamps_of_both_place_a_file():
    made, told = started((1000.0, 1.0))
    run = joined(made, file("p.mf4"), {"line": one()}, (1003.25, 1e-3))
    clock = run.clocks["p_mf4"]
    assert float(run.channels["line"].begin) == float(clock.offset) == 3.25
    assert float(clock.offset_std) == pytest.approx(1 / np.sqrt(12), rel=1e-3)
    assert "in steps of 0.001 s and 1 s" in told[0]


def test_a_third_file_is_placed_on_the_clock_of_the_run():
    """The first file was moved itself: stamps count from where its times were."""
    made = Imported(False, lambda sentence: None)
    channels, _ = made.on_clock(file("q.wav", offset=10.0), ["stop"], {"mic": one()}, (1000.0, 1e-3))
    made.add({"stop": Run(description="", repeat_of="", channels=channels)}, "q.wav")
    run = joined(made, file("p.mf4"), {"line": one()}, (1002.0, 1e-3))
    assert float(run.channels["mic"].begin) == 10 and float(run.channels["line"].begin) == 12


def test_a_common_pulse_places_a_file():
    made, told = started((1000.0, 1e-3))
    late = np.exp(-((np.arange(600) / 200 - 1.25) / 0.05) ** 2)
    common = SimpleNamespace(channel="trigger", other="mic")
    run = joined(made, file("p.tdms", common=common), {"trigger": one(0.0, late, 200.0), "line": one(0.5)}, (0.0, 1.0))
    clock = run.clocks["p_tdms"]
    assert float(clock.offset) == pytest.approx(1.75, abs=3 * float(clock.offset_std)) and clock.offset_std < 0.01
    assert float(run.channels["line"].begin) == pytest.approx(0.5 + float(clock.offset))
    assert "where trigger and mic fit best (correlation 1.00)" in told[0] and " +- " in told[0]


@pytest.mark.parametrize("more, stamps, told", [
    ({}, (None, None), "no time stamp in q.wav nor in p.tdms; state offset: SECONDS"),
    ({}, ((1.0, 1.0), None), "no time stamp in p.tdms; state offset"),
    ({}, ((1000.0, 1.0), (8200.0, 1.0)), "those of q.wav, 0 s to 6 s, found 7200 s to 7206 s by the time stamps"),
    ({"common": SimpleNamespace(channel="x", other="mic")}, (None, None), "common.channel: expected one of line"),
    ({"common": SimpleNamespace(channel="line", other="x")}, (None, None), "common.other: expected one of mic"),
    ({"common": SimpleNamespace(channel="line", other="mic"), "offset": 1.0}, (None, None), "no offset beside it")])
def test_what_cannot_be_placed_is_asked_for(more, stamps, told):
    made, _ = started(stamps[0])
    with pytest.raises(ConfigError, match=told):
        joined(made, file("p.tdms", **more), {"line": one()}, stamps[1])


def test_a_first_file_has_no_common_channel():
    with pytest.raises(ConfigError, match="a run of a file further up in the list"):
        Imported(False, print).on_clock(file("p.tdms", common=SimpleNamespace(channel="line", other="mic")), ["stop"],
                                        {"line": one()})


def test_names_are_taken_once_and_tables_need_no_clock():
    made, _ = started()
    with pytest.raises(ConfigError, match="stop: expected channels whose names the run does not have yet, found mic"):
        joined(made, file("p.tdms", offset=0.0), {"mic": one()})
    made.add({"stop": Run(description="", repeat_of="first", conditions={
        "speed": Condition(value=[1.0], time=[0.0], unit="rad/s")})}, "mu.csv")
    assert str(made.runs["stop"].repeat_of) == "first" and list(made.runs["stop"].conditions) == ["speed"]
    made.add({"stop": Run(description="", repeat_of="", conditions=made.runs["stop"].conditions)}, "again.csv")
    with pytest.raises(ConfigError, match="conditions whose names the run does not have yet, found speed"):
        made.add({"stop": Run(description="", repeat_of="", conditions={
            "speed": Condition(value=[2.0], time=[0.0], unit="rad/s")})}, "other.csv")


def test_channels_that_cannot_be_used_end_the_import_or_are_told():
    def refused():
        raise ConfigError("a", "b", "c")

    told = []
    assert list(Imported(True, told.append).channels({"x": refused, "y": one})) == ["y"] and "left out: a: " in told[0]
    with pytest.raises(ConfigError, match="a: expected b, found c"):
        Imported(False, told.append).channels({"x": refused})


def test_spans_of_channels():
    assert span(later({"a": one(), "b": one(2.0, rate=300.0)}, 1.0)) == (1.0, 7.0)
