"""Channels by what their files say: which are made, left out or asked for, and what is told."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.runs.imported import Imported
from pipeline.recordings.runs.tracks import channels_of
from stages.recording import Track, Waveforms
from tests.recordings.files_of_others import RATE, SINE, mdf, sound, tdms


def made(path, kind, **more):
    """(channels, stamp, what was told) of a file under these settings."""
    told = []
    settings = Waveforms(kind=kind, file=path, **more)
    return *channels_of(settings, Imported(False, told.append), Track), told


def test_uneven_channels_are_put_on_a_grid_and_said_together(tmp_path):
    channels, stamp, told = made(mdf(tmp_path / "a.mf4"), "mdf")
    assert list(channels) == ["pad", "line", "disc", "disc_speed"] and stamp is not None
    assert len(told) == 1 and "a.mf4: disc_speed: time stamps are" in told[0]
    speed = channels["disc_speed"]
    instants = np.arange(len(speed.samples)) / float(speed.rate)
    np.testing.assert_allclose(speed.samples, 10 - 100 / 9 * np.sqrt(instants), atol=1.2)


def test_texts_are_left_out_aloud(tmp_path):
    channels, _, told = made(tdms(tmp_path / "a.tdms"), "tdms")
    assert list(channels) == ["bench_pad"] and told == [f"{tmp_path / 'a.tdms'}: bench/note left out: it holds no"
                                                        " numbers"]
    with pytest.raises(ConfigError, match="note: expected samples, found none: it holds no numbers"):
        made(tmp_path / "a.tdms", "tdms", columns={"note": Track(column="bench/note", unit="V")})


def test_a_channel_of_times_is_named_in_tdms_files_alone(tmp_path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(tmp_path / "a.tdms")) as writer:
        writer.write_segment([ChannelObject("log", name, values, properties={"unit_string": unit})
                              for name, values, unit in (("X0", np.arange(9) / 8, ""), ("line", SINE[:9], "bar"))])
    channels, *_ = made(tmp_path / "a.tdms", "tdms", time="log/X0")
    assert {name: float(c.rate) for name, c in channels.items()} == {"log_line": 8.0}
    with pytest.raises(ConfigError, match="time: expected no channel of times"):
        made(mdf(tmp_path / "a.mf4"), "mdf", time="disc")


def test_a_column_may_make_several_channels(tmp_path):
    columns = {name: Track(column="1", unit=unit) for name, unit in (("mic", "Pa"), ("pad", "g"))}
    channels, *_ = made(sound(tmp_path / "a.wav", rate=int(RATE)), "audio", columns=columns)
    assert [str(c.unit) for c in channels.values()] == ["Pa", "m/s^2"]
    with pytest.raises(ConfigError, match="pad.column: expected one of 1, 2, found '3'"):
        made(tmp_path / "a.wav", "audio", columns={"pad": Track(column="3")})


def test_a_calibrator_of_another_channel_is_refused(tmp_path):
    sound(tmp_path / "a.wav")
    calibrator = SimpleNamespace(file=tmp_path / "a.wav", column="9", level=94.0)
    with pytest.raises(ConfigError, match="calibrator.column: expected one of 1, 2, found '9'"):
        made(tmp_path / "a.wav", "audio", columns={"mic": Track.model_construct(
            column="1", unit=None, measures=None, factor=1.0, role="response", place="", direction=(),
            calibrator=calibrator)})


def test_long_channels_of_a_bus_are_those_of_memory(tmp_path, monkeypatch):
    """Their time stamps, which they have in common, lie in a file without a name while they are read."""
    import asammdf

    monkeypatch.setattr("pipeline.contract.mapped.LARGE", 1 << 10)
    times = 1.0 + np.arange(2000) / 100 + 1e-3 * np.sin(np.arange(2000))
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(np.sin(times), times, name=name, unit="bar") for name in ("front", "rear")])
        path = file.save(str(tmp_path / "a.mf4"))
    channels, _, told = made(path, "mdf")
    assert len(told) == 1 and "front, rear: time stamps are" in told[0]
    for one in channels.values():
        instants = float(one.begin) + np.arange(len(one.samples)) / float(one.rate)
        np.testing.assert_allclose(one.samples, 1e5 * np.sin(instants), atol=20.0)


def times_in(path, unit="", name="Time"):
    """A TDMS file of 10 kHz from 0.5 s on, by a channel of times in ms."""
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(path)) as writer:
        writer.write_segment([
            ChannelObject("log", one, values, properties={"unit_string": label})
            for one, values, label in ((name, 500.0 + np.arange(200) / 10, unit), ("line", SINE[:200], "bar"))])
    return path


def test_times_without_a_unit_are_told_and_the_case_states_it(tmp_path):
    channels, _, told = made(times_in(tmp_path / "a.tdms"), "tdms")
    assert float(channels["log_line"].rate) == pytest.approx(10) and len(told) == 1
    assert "log_line: log/Time states no unit: its times are read in s; else time_unit: ms" in told[0]
    for path, more in ((tmp_path / "a.tdms", {"time_unit": "ms"}), (times_in(tmp_path / "b.tdms", "ms"), {}),
                       (times_in(tmp_path / "c.tdms", "", "Time [ms]"), {}),
                       (times_in(tmp_path / "d.tdms", "milliseconds"), {})):
        channels, _, told = made(path, "tdms", **more)
        line = channels["log_line"]
        assert (float(line.rate), float(line.begin)) == (pytest.approx(1e4), 0.5) and not told
    with pytest.raises(ConfigError, match="time_unit: expected no channel of times"):
        made(mdf(tmp_path / "a.mf4"), "mdf", time_unit="ms")


@pytest.mark.parametrize("rate, told", [(1000.0, True), (RATE, False)])
def test_a_rate_of_the_case_that_the_file_contradicts_is_told(tmp_path, rate, told):
    channels, _, said = made(tdms(tmp_path / "a.tdms"), "tdms", sample_rate=f"{rate} Hz")
    assert float(channels["bench_pad"].rate) == pytest.approx(RATE)
    assert any("bench_pad: the file states 51200 Hz, which is taken" in line for line in said) == told
