"""Universal files that are written: read again here and by pyuff."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import FrequencyResponse, Run
from pipeline.recordings.samples import channel
from pipeline.recordings.uff import read_uff
from pipeline.recordings.uff_writer import write_uff

SAMPLES = np.sin(0.3 * np.arange(500))


@pytest.fixture
def run():
    return Run(description="", repeat_of="", channels={
        "pad": channel(SAMPLES, "g", "acceleration", 51200.0, 0.25, "pad", place="node 7", direction=(0, 0, -1)),
        "hammer_at_the_finger": channel(3 * SAMPLES, "N", "force", 51200.0, 0.0, "hammer", role="excitation")}, frf={
        "drive": FrequencyResponse(frequency=2.0 * np.arange(5), response=np.exp(1j * np.arange(5)), unit="m/s^2/N",
                                   place="node 7 direction -3", reference="node 2 direction 1")})


@pytest.mark.exact
def test_what_is_written_is_read(tmp_path, run):
    write_uff(tmp_path / "a.uff", run)
    channels, frf, _ = read_uff(tmp_path / "a.uff")
    assert list(channels) == ["pad", "hammer_at_the_finger"] and list(frf) == ["drive"]
    for name, one in channels.items():
        given = run.channels[name]
        np.testing.assert_array_equal(one.samples, given.samples)
        assert float(one.rate) == 51200.0 and float(one.begin) == pytest.approx(float(given.begin))
        for field in ("unit", "measures", "role"):
            assert str(getattr(one, field)) == str(getattr(given, field)), field
    assert channels["pad"].direction.tolist() == [0, 0, -1] and str(channels["pad"].place) == "node 7"
    found, given = frf["drive"], run.frf["drive"]
    np.testing.assert_array_equal(found.response, given.response)
    np.testing.assert_allclose(found.frequency, given.frequency)
    for field in ("unit", "place", "reference"):
        assert str(getattr(found, field)) == str(getattr(given, field)), field


def test_pyuff_reads_it(tmp_path, run):
    import pyuff

    write_uff(tmp_path / "a.uff", run)
    pad, hammer, drive = pyuff.UFF(str(tmp_path / "a.uff")).read_sets()
    np.testing.assert_array_equal(pad["data"], 9.80665 * SAMPLES)
    assert pad["rsp_node"] == 7 and pad["rsp_dir"] == -3 and pad["ordinate_axis_units_lab"].strip() == "m/s^2"
    np.testing.assert_array_equal(hammer["data"], 3 * SAMPLES)
    np.testing.assert_array_equal(drive["data"], run.frf["drive"].response)
    assert (drive["ordinate_spec_data_type"], drive["orddenom_spec_data_type"]) == (12, 13)
    assert (drive["ordinate_axis_units_lab"].strip(), drive["orddenom_axis_units_lab"].strip()) == ("m/s^2", "N")
    assert drive["func_type"] == 4 and drive["ref_node"] == 2 and drive["ref_dir"] == 1


def test_what_cannot_be_written_is_refused(tmp_path, run):
    with pytest.raises(ConfigError, match="a run with channels or frequency responses, found none"):
        write_uff(tmp_path / "a.uff", Run(description="", repeat_of=""))
    uneven = replace(run.frf["drive"], frequency=np.array([0.0, 1.0, 3.0, 4.0, 5.0]))
    with pytest.raises(ConfigError, match="frf drive: expected an even frequency axis"):
        write_uff(tmp_path / "a.uff", replace(run, frf={"drive": uneven}))


def test_missing_samples_come_back(tmp_path):
    gapped = channel(np.where(np.arange(500) // 50 == 2, np.nan, SAMPLES), "N", "force", 1000.0, 0.0, "a")
    write_uff(tmp_path / "a.uff", Run(description="", repeat_of="", channels={"a": gapped}))
    again = read_uff(tmp_path / "a.uff")[0]["a"]
    assert again.missing.tolist() == [[100, 150]]
    np.testing.assert_array_equal(again.samples, gapped.samples)
