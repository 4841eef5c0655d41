"""TDMS files of npTDMS."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.tdms import read_tdms
from tests.recordings.files_of_others import RATE, SINE, tdms


def test_channels_of_numbers_with_their_units_and_rates(tmp_path):
    found = read_tdms(tdms(tmp_path / "a.tdms"))
    assert list(found) == ["bench/pad", "bench/note"] and found["bench/note"].remark == "it holds no numbers"
    pad = found["bench/pad"]
    assert pad.unit == "g" and pad.rate == pytest.approx(RATE) and pad.begin == 0.5
    np.testing.assert_array_equal(pad.values, SINE)


def test_a_channel_without_increment_has_no_rate(tmp_path):
    assert read_tdms(tdms(tmp_path / "a.tdms", wf_increment=0.0))["bench/pad"].rate is None


@pytest.mark.parametrize("share", [0.1, 0.5, 0.98])
def test_a_file_that_is_cut_off_is_refused(tmp_path, share):
    path = tdms(tmp_path / "a.tdms")
    path.write_bytes(path.read_bytes()[:int(share * path.stat().st_size)])
    with pytest.raises(ConfigError, match="whole TDMS file|undamaged TDMS file"):
        read_tdms(path)


@pytest.mark.parametrize("content", [b"", b"hello"])
def test_what_is_no_tdms_file_is_refused(tmp_path, content):
    (tmp_path / "a.tdms").write_bytes(content)
    with pytest.raises(ConfigError, match="a channel of numbers, found none"):
        read_tdms(tmp_path / "a.tdms")


def test_segments_are_joined_in_the_precision_of_the_file(tmp_path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(tmp_path / "a.tdms")) as writer:
        for k in range(3):
            writer.write_segment([ChannelObject("b", name, (SINE + k).astype(kind)) for name, kind in (
                ("short", "i2"), ("single", "f4"), ("long", "i4"), ("double", "f8"))])
    found = read_tdms(tmp_path / "a.tdms")
    for name, kind, held in (("short", "i2", "f4"), ("single", "f4", "f4"), ("long", "i4", "f8"),
                             ("double", "f8", "f8")):
        values = found[f"b/{name}"].values
        assert values.dtype == held
        np.testing.assert_array_equal(values, np.concatenate([(SINE + k).astype(kind) for k in range(3)]))


T0 = np.datetime64("2026-03-29T00:59:58.250000")


def written(path, *channels, group="g"):
    """A file of ``channels`` (name, values, properties), each in its group."""
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(path)) as writer:
        writer.write_segment([ChannelObject(told.pop("group", group), name, values, properties=told)
                              for name, values, told in channels])
    return path


def test_tasks_that_start_later_begin_later(tmp_path):
    """Start times of the waveforms, to the microsecond, and their offsets; one without a start time says so."""
    later = T0 + np.timedelta64(3_000_004, "us")
    found = read_tdms(written(tmp_path / "a.tdms", *(
        (name, SINE, {"wf_increment": 1e-3, "wf_start_offset": offset, **start}) for name, offset, start in (
            ("mic", 0.0, {"wf_start_time": T0}), ("line", 0.5, {"wf_start_time": later}), ("pad", 0.25, {}),
            ("unset", 0.0, {"wf_start_time": np.datetime64("1904-01-01T00:00:00")})))))
    assert [w.begin for w in found.values()] == pytest.approx([0.0, 3.500004, 0.25, 0.0], abs=1e-9)
    assert "starts 3.000004 s after the first" in found["g/line"].remark and not found["g/mic"].remark
    assert all("no start time" in found[f"g/{name}"].remark for name in ("pad", "unset"))
    assert {w.stamp for w in found.values()} == {((T0 - np.datetime64(0, "us")).astype(int) / 1e6, 1e-3)}


@pytest.mark.parametrize("name, unit, times", [
    ("Time", "s", 2.0 + np.arange(50) / 10), ("Zeit (ms)", "", 2000.0 + 100.0 * np.arange(50)),
    ("t", "ms", (2000 + 100 * np.arange(50)).astype("i4"))])
def test_a_channel_of_times_is_the_clock_of_those_beside_it(tmp_path, name, unit, times):
    found = read_tdms(written(tmp_path / "a.tdms", (name, times, {"unit_string": unit}),
                              ("line", np.arange(50.0), {"unit_string": "bar"})))
    assert list(found) == ["g/line"] and found["g/line"].rate == pytest.approx(10) and found["g/line"].begin == 2.0


def test_each_channel_has_the_times_before_it(tmp_path):
    found = read_tdms(written(tmp_path / "a.tdms", ("t_1", np.arange(20.0), {}), ("a", np.zeros(20), {}),
                              ("t_2", 5 + np.arange(20.0) / 4, {}), ("b", np.zeros(20), {})))
    assert {name: (w.rate, w.begin) for name, w in found.items()} == {"g/a": (1.0, 0.0), "g/b": (4.0, 5.0)}


def test_instants_and_seconds_since_1904_are_on_one_clock(tmp_path):
    """Absolute times of two loggers, one as time stamps, one as LabVIEW counts seconds, beside a waveform."""
    since_1904 = (T0 - np.datetime64("1904-01-01", "us")) / np.timedelta64(1, "s")
    uneven = np.array([0, 10_137, 21_291, 30_004, 41_512], "timedelta64[us]")
    found = read_tdms(written(
        tmp_path / "a.tdms", ("mic", SINE, {"wf_increment": 1e-3, "wf_start_time": T0}),
        ("Timestamp", T0 + np.timedelta64(2, "s") + uneven, {"group": "bus"}),
        ("speed", np.arange(5.0), {"group": "bus"}),
        ("Time", since_1904 + 1.5 + np.arange(9) / 8, {"group": "log"}), ("line", np.zeros(9), {"group": "log"})))
    assert set(found) == {"g/mic", "bus/speed", "log/line"} and found["bus/speed"].rate is None
    np.testing.assert_allclose(found["bus/speed"].times, [2.0, 2.010137, 2.021291, 2.030004, 2.041512], atol=1e-9)
    assert found["log/line"].rate == pytest.approx(8) and found["log/line"].begin == pytest.approx(1.5, abs=1e-5)


def test_times_go_before_an_interval_that_contradicts_them(tmp_path):
    """LabVIEW writes an interval of 1 s where none was set."""
    found = read_tdms(written(tmp_path / "a.tdms", ("Time", np.arange(50) / 10, {}),
                              ("line", np.zeros(50), {"wf_increment": 1.0})))
    assert found["g/line"].rate == pytest.approx(10) and "not of its wf_increment, 1 s" in found["g/line"].remark


def test_a_temperature_is_no_clock_and_another_name_is_stated(tmp_path):
    path = written(tmp_path / "a.tdms", ("T", 20.0 + np.arange(9), {"unit_string": "degC"}),
                   ("X0", 1.0 + np.arange(9) / 8, {}), ("line", np.zeros(9), {}))
    assert [w.rate for w in read_tdms(path).values()] == [None] * 3
    found = read_tdms(path, time="g/X0")
    assert list(found) == ["g/T", "g/line"] and {(w.rate, w.begin) for w in found.values()} == {(8.0, 1.0)}
    with pytest.raises(ConfigError, match="time: expected one of g/T, g/X0, g/line, found 'X0'"):
        read_tdms(path, time="X0")
    with pytest.raises(ConfigError, match="times that rise, in a unit of time, found others, in s"):
        read_tdms(path, time="g/line")


def test_the_unit_of_the_axis_counts(tmp_path):
    found = read_tdms(written(tmp_path / "a.tdms", *(
        (unit, SINE, {"wf_increment": 0.5, "wf_start_offset": 10.0, "wf_xunit_string": unit})
        for unit in ("ms", "s", "Hz"))))
    assert [(w.rate, w.begin) for w in found.values()] == [(2000.0, 0.01), (2.0, 10.0), (None, 0.0)]
    assert "no signal over time" in found["g/Hz"].remark


@pytest.mark.parametrize("order", ["t_1 t_2 a", "a t_1 t_2", "a t_1 b t_2"])
def test_of_several_channels_of_times_the_one_that_is_taken_is_told_and_stated(tmp_path, order):
    times = {"t_1": np.arange(20.0), "t_2": 5 + np.arange(20.0) / 4}
    path = written(tmp_path / "a.tdms", *((name, times.get(name, np.zeros(20)), {}) for name in order.split()))
    found = read_tdms(path)["g/a"]
    taken, other = ("t_1", "t_2") if found.rate == 1.0 else ("t_2", "t_1")
    assert f"its times are those of g/{taken}, not of g/{other}: time: g/{other} takes these" in found.remark
    for name, clock in (("t_1", (1.0, 0.0)), ("t_2", (4.0, 5.0))):
        stated = read_tdms(path, time=f"g/{name}")["g/a"]
        assert (stated.rate, stated.begin) == clock and "takes these" not in stated.remark
