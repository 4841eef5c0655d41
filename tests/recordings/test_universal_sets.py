"""Data sets of universal files by their bytes: both places of the closing mark, marks in the data, lost bytes."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import Run
from pipeline.recordings.samples import channel
from pipeline.recordings.uff import read_uff
from pipeline.recordings.uff_writer import write_uff
from pipeline.recordings.universal_sets import universal_sets
from tests.recordings.test_uff import write

VALUES = np.sin(0.1 * np.arange(200)) + 0.01


def binary(tmp_path, values=VALUES, directly=True):
    """A binary file as the definition has it, or with a line break before its closing mark."""
    path = tmp_path / "a.uff"
    write_uff(path, Run(description="", repeat_of="", channels={
        "acc_1": channel(values, "g", "acceleration", 1000.0, 0.0, "acc_1")}))
    if not directly:
        path.write_bytes(path.read_bytes()[:-len(b"    -1\n")] + b"\n    -1\n")
    return path


@pytest.mark.parametrize("directly", [True, False])
def test_the_closing_mark_may_follow_the_data_or_stand_on_a_line(tmp_path, directly):
    path = binary(tmp_path, directly=directly)
    assert path.read_bytes().endswith(b"\n    -1\n") != directly
    np.testing.assert_array_equal(read_uff(path)[0]["acc_1"].samples, 9.80665 * VALUES)
    path.write_bytes(2 * path.read_bytes())
    assert list(read_uff(path)[0]) == ["acc_1", "acc_1_2"]


def test_bytes_that_look_like_a_mark_are_data(tmp_path):
    value = np.frombuffer(b"\n    -1\n", "<f8")[0]
    path = binary(tmp_path, np.array([value, 2 * value, value]), directly=False)
    assert len(universal_sets(path.read_bytes(), path)) == 1


@pytest.mark.parametrize("directly", [True, False])
@pytest.mark.parametrize("lost", [1000, 1500, 2400])
def test_a_lost_byte_is_found(tmp_path, lost, directly):
    path = binary(tmp_path, directly=directly)
    whole = path.read_bytes()
    for damaged in (whole[:lost] + whole[lost + 1:], whole[:lost] + b"\0" + whole[lost:]):
        path.write_bytes(damaged)
        with pytest.raises(ConfigError, match="data set 1: expected|a line '    -1'|does not end"):
            read_uff(path)


@pytest.mark.parametrize("old, new, told", [
    (b"       200         1", b"       201         1", "1608 bytes, those of the points that it declares, found 1600"),
    (b"     1     2          11", b"     1     2           x", "byte order, number format, lines and bytes"),
    (b"    58b", b"    xxb", "the number of its kind")])
def test_heads_that_contradict_themselves_are_refused(tmp_path, old, new, told):
    path = binary(tmp_path)
    content = path.read_bytes()
    assert old in content
    path.write_bytes(content.replace(old, new))
    with pytest.raises(ConfigError, match=told):
        read_uff(path)


def test_rubbish_between_data_sets_is_refused(tmp_path):
    content = binary(tmp_path).read_bytes()
    assert len(universal_sets(content + b"\n  \n" + content, "a.uff")) == 2
    with pytest.raises(ConfigError, match="data set 2: expected a data set, begun by a line"):
        universal_sets(content + b"rubbish\n" + content, "a.uff")


@pytest.mark.parametrize("content, told", [(b"", "an empty one"), (b"hello", "a universal file"),
                                           (b"    -1\n    15\n", "does not end")])
def test_what_is_no_universal_file_is_refused(content, told):
    with pytest.raises(ConfigError, match=told):
        universal_sets(content, "a.uff")


@pytest.mark.parametrize("stated", [0, 200, 1608, 3200])
def test_a_wrong_number_of_bytes_is_told_and_the_points_are_read(tmp_path, stated):
    path, told = binary(tmp_path), []
    path.write_bytes(path.read_bytes().replace(b"    1600     0", b"%8d     0" % stated))
    np.testing.assert_array_equal(read_uff(path, tell=told.append)[0]["acc_1"].samples, 9.80665 * VALUES)
    assert told == [f"{path}: data set 1: its head says {stated} bytes of data, its points are 1600: these are read"]
    path.write_bytes(path.read_bytes()[:-300] + b"    -1\n")
    with pytest.raises(ConfigError, match=f"1600 bytes, those of the points that it declares, found {stated}"):
        read_uff(path)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")      # pyuff leaves the file open
@pytest.mark.parametrize("even", [0, 1])
@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize("func_type", [1, 4])
def test_binary_data_as_pyuff_writes_them(tmp_path, func_type, whole, even):
    """The bytes of its head are those of real values at an even spacing; single precision is written as double."""
    x = 0.25 * np.arange(200)
    values = VALUES if func_type == 1 else VALUES * np.exp(0.3j * x)
    kind = {(1, True): 4, (1, False): 2, (4, True): 6, (4, False): 5}[func_type, whole]
    path, told = write(tmp_path / "a.uff", "add", binary=1, func_type=func_type, x=x, data=values, num_pts=200,
                       abscissa_inc=0.25, abscissa_spacing=even, ord_data_type=kind, force_double=whole,
                       ordinate_axis_units_lab="m/s^2", abscissa_spec_data_type=17 if func_type == 1 else 18,
                       abscissa_axis_units_lab="s" if func_type == 1 else "Hz"), []
    channels, frf, _ = read_uff(path, tell=told.append)
    found = channels["acc_1"].samples if func_type == 1 else frf["acc_1"].response
    np.testing.assert_array_equal(found, values)
    assert len(told) == (0 if func_type == 1 and whole and even else 1) and all("its head says" in t for t in told)
