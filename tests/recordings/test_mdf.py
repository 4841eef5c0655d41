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


def test_uneven_time_stamps_tell_no_rate(tmp_path):
    assert read_mdf(mdf(tmp_path / "a.mf4"))["disc speed"].rate is None


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
