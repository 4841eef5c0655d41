"""MDF files of asammdf."""

import gc

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.mdf import read_mdf
from tests.recordings.files_of_others import RATE, SINE, mdf

pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")


@pytest.fixture(autouse=True)
def gone():
    """What asammdf leaves of a file that it cannot read complains when it is deleted: here, not in another test."""
    yield
    gc.collect()


def test_channels_with_their_own_rates(tmp_path):
    found = read_mdf(mdf(tmp_path / "a.mf4"))
    assert list(found) == ["pad", "line", "disc", "disc speed"]
    assert [w.unit for w in found.values()] == ["m/s2", "bar", "degC", "rad/s"]
    assert found["pad"].rate == pytest.approx(RATE) and found["disc"].rate == pytest.approx(10)
    np.testing.assert_array_equal(found["pad"].values, SINE)
    assert found["line"].values[-1] == 999


def test_uneven_time_stamps_stay(tmp_path):
    found = read_mdf(mdf(tmp_path / "a.mf4"))["disc speed"]
    assert found.rate is None
    np.testing.assert_allclose(found.times, (np.arange(10) / 10) ** 2)


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.9])
def test_a_file_that_is_cut_off_is_refused(tmp_path, share):
    path = mdf(tmp_path / "a.mf4")
    path.write_bytes(path.read_bytes()[:int(share * path.stat().st_size)])
    with pytest.raises(ConfigError, match="undamaged MDF file"):
        read_mdf(path)


def test_channels_of_one_name_in_one_group_are_both_kept(tmp_path):
    import asammdf

    time = np.arange(10) / 10
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(np.arange(10.0), time, unit="N", name="a"),
                     asammdf.Signal(-np.arange(10.0), time, unit="N", name="a")])
        file.save(str(tmp_path / "a.mf4"))
    assert [w.values[1] for w in read_mdf(tmp_path / "a.mf4").values()] == [1, -1]


@pytest.mark.parametrize("version, compression", [("3.30", 0), ("4.10", 0), ("4.10", 1), ("4.10", 2), ("4.20", 0)])
def test_long_channels_are_read_in_blocks(tmp_path, monkeypatch, version, compression):
    """Old and new, compressed or not: values, scaling and time stamps of all blocks, in the precision of the file."""
    import asammdf

    count = 100_000
    time, values = 3.0 + np.arange(count) / RATE, np.arange(count, dtype=np.float32)
    scaled = asammdf.Signal(np.arange(count, dtype="u2"), time, unit="bar", name="line",
                            conversion={"a": 0.5, "b": -1.0})
    with asammdf.MDF(version=version) as file:
        file.append([asammdf.Signal(values, time, unit="Pa", name="mic"), scaled])
        file.save(str(tmp_path / "a.mf4"), overwrite=True, compression=compression)
    monkeypatch.setattr("pipeline.recordings.mdf._BLOCK", 1 << 16)
    mic, line = read_mdf(next(tmp_path.iterdir())).values()
    np.testing.assert_array_equal(mic.values, values)
    np.testing.assert_array_equal(line.values, 0.5 * (np.arange(count) % 2**16) - 1.0)
    assert (mic.values.dtype, line.values.dtype) == (np.float32, float) and (mic.unit, line.unit) == ("Pa", "bar")
    assert mic.rate == pytest.approx(RATE) and mic.begin == line.begin == pytest.approx(3.0)


def written(path, *groups, version="4.10", start=None, compression=0):
    """A file of groups of signals (name, values, unit, more) with the times (sample,) before them."""
    import asammdf

    with asammdf.MDF(version=version) as file:
        if start is not None:
            file.start_time = start
        for times, *signals in groups:
            file.append([asammdf.Signal(values, times, name=name, unit=unit, **more)
                         for name, values, unit, more in signals])
        return file.save(str(path), overwrite=True, compression=compression)


TIME = np.arange(3000) / 1000
BEGIN = 2.5 + TIME


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("compression", [0, 2])
def test_invalid_samples_are_gaps_of_their_channel_alone(tmp_path, monkeypatch, order, compression):
    """Whichever channel of the group comes first: neither loses its instants; in blocks as in one."""
    invalid = (TIME < 0.75) | ((TIME >= 2.0) & (TIME < 2.1))
    signals = [("line", np.full(len(TIME), 20, "u2"), "bar", {"invalidation_bits": invalid}),
               ("mic", np.sin(TIME).astype("f4"), "Pa", {})][::order]
    path = written(tmp_path / "a.mf4", (BEGIN, *signals), compression=compression)
    monkeypatch.setattr("pipeline.recordings.mdf._BLOCK", 1 << 12)
    found = read_mdf(path)
    np.testing.assert_array_equal(np.isnan(found["line"].values), invalid)
    np.testing.assert_array_equal(found["mic"].values, np.sin(TIME).astype("f4"))
    assert {(round(w.rate, 6), w.begin) for w in found.values()} == {(1000.0, 2.5)}
    assert "850 of 3000 samples are missing: the file marks" in found["line"].remark and not found["mic"].remark


def test_a_channel_that_is_invalid_throughout_is_left_out_aloud(tmp_path):
    path = written(tmp_path / "a.mf4", (TIME, ("dead", TIME, "bar", {"invalidation_bits": np.ones(len(TIME), bool)}),
                                        ("mic", TIME, "Pa", {})))
    found = read_mdf(path)
    assert not len(found["dead"].values) and "all of its samples as invalid" in found["dead"].remark
    assert len(found["mic"].values) == len(TIME)


def block(kind, **more):
    from asammdf.blocks.v4_blocks import ChannelConversion

    return ChannelConversion(conversion_type=kind, **more)


RAW = np.where(TIME < 2.0, 140, np.where(TIME < 2.5, 254, 255)).astype("u1")


def conversions():
    linear = block(1, a=0.5, b=-40.0)
    return {"values": block(7, val_param_nr=2, ref_param_nr=3, val_0=254, text_0=b"Error", val_1=255, text_1=b"n/a",
                            links_nr=7, default_addr=linear),
            "ranges": block(8, val_param_nr=2, ref_param_nr=2, lower_0=251, upper_0=255, text_0=b"fault", links_nr=6,
                            default_addr=linear),
            "both ranges": block(8, val_param_nr=4, ref_param_nr=3, lower_0=0, upper_0=250, text_0=linear, lower_1=251,
                                 upper_1=255, text_1=b"fault", links_nr=7, default_addr=b"?")}


@pytest.mark.parametrize("kind", ["values", "ranges", "both ranges"])
@pytest.mark.parametrize("raw", [RAW, RAW[::30], RAW.astype(float)])
def test_texts_beside_a_conversion_to_numbers_are_gaps(tmp_path, kind, raw):
    """Codes of errors as MDF 4 states them; asammdf converts a few samples in another way than many."""
    time = np.linspace(0.0, 2.999, len(raw))
    found = read_mdf(written(tmp_path / "a.mf4", (time, ("temp", raw, "degC", {
        "conversion": conversions()[kind]}))))["temp"]
    np.testing.assert_array_equal(found.values, np.where(raw < 250, 0.5 * raw - 40.0, np.nan))
    assert "they stand for texts" in found.remark and "as they stand" not in found.remark


def test_numbers_beside_texts_without_a_conversion_are_said(tmp_path):
    errors = {"val_0": 254, "text_0": b"Error"}
    path = written(tmp_path / "a.mf4", (TIME, ("temp", RAW, "degC", {"conversion": errors})))
    found = read_mdf(path)["temp"]
    assert found.values[0] == 140 and np.isnan(found.values[2200]) and found.values[-1] == 255
    assert "2500 of 3000 samples are taken as they stand" in found.remark


@pytest.mark.parametrize("version", ["3.30", "4.10"])
def test_channels_of_texts_alone_are_left_out_aloud(tmp_path, version):
    gear = {"val_0": 0, "text_0": b"off", "val_1": 1, "text_1": b"on"}
    path = written(tmp_path / "a", (TIME, ("gear", (TIME > 1).astype("u1"), "", {"conversion": gear}),
                                    ("mic", TIME, "Pa", {})), version=version)
    found = read_mdf(path)
    assert not len(found["gear"].values) and found["gear"].remark == "it holds texts alone"
    assert len(found["mic"].values) == len(TIME)


def test_texts_of_mdf_3_are_gaps(tmp_path):
    path = written(tmp_path / "a", (TIME, ("temp", RAW, "degC", {"conversion": {
        "val_0": 254, "text_0": b"Error", "val_1": 255, "text_1": b"n/a"}})), version="3.30")
    found = read_mdf(path)["temp"]
    np.testing.assert_array_equal(found.values, np.where(RAW < 250, 140.0, np.nan))


def test_a_group_over_angle_is_no_signal_over_time(tmp_path):
    """Its master channel counts degrees of a shaft."""
    import asammdf

    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(TIME, TIME, name="mic", unit="Pa")])
        file.append([asammdf.Signal(TIME, 360 * TIME, name="torque", unit="N m")])
        file.groups[1].channels[0].sync_type = 2
        path = file.save(str(tmp_path / "a.mf4"), overwrite=True)
    found = read_mdf(path)
    assert found["torque"].rate is None and found["torque"].times is None and "over angles" in found["torque"].remark
    assert found["mic"].rate == pytest.approx(1000)


@pytest.mark.parametrize("version", ["3.30", "4.10"])
def test_the_start_of_the_measurement_is_its_stamp(tmp_path, version):
    from datetime import UTC, datetime, timedelta, timezone

    start = datetime(2026, 3, 29, 2, 30, 0, 250000, timezone(timedelta(hours=2)))
    found = read_mdf(written(tmp_path / "a", (BEGIN, ("mic", TIME, "Pa", {})), version=version, start=start))["mic"]
    assert found.stamp == (datetime(2026, 3, 29, 0, 30, 0, 250000, UTC).timestamp(), 1e-3) and found.begin == 2.5
