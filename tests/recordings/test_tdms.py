"""TDMS files of npTDMS."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.tdms import read_tdms
from tests.recordings.files_of_others import RATE, SINE, tdms


def test_channels_of_numbers_with_their_units_and_rates(tmp_path):
    found = read_tdms(tdms(tmp_path / "a.tdms"))
    assert list(found) == ["bench/pad"]
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
