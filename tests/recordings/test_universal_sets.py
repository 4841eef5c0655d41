"""Data sets of universal files by their bytes: both places of the closing mark, marks in the data, lost bytes."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import Run
from pipeline.recordings.samples import channel
from pipeline.recordings.uff import read_uff
from pipeline.recordings.uff_writer import write_uff
from pipeline.recordings.universal_sets import universal_sets

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
    (b"    1600     0", b"    1608     0", "1600 bytes, those of the points that it declares, found 1608"),
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
