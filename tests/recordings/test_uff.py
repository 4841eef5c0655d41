"""Universal files."""

import os
from pathlib import Path

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.uff import read_uff

SAMPLES = Path(os.environ.get("BRAKECHAIN_DATA", "../shared/data")) / "uff_samples"
TIME = {"binary": 0, "func_type": 1, "rsp_node": 7, "rsp_dir": -3, "rsp_ent_name": "Acc 1", "ref_node": 1, "ref_dir": 0,
        "ord_data_type": 4, "abscissa_spacing": 1, "abscissa_min": 0.0, "abscissa_inc": 1e-3, "num_pts": 5,
        "abscissa_spec_data_type": 17, "abscissa_axis_lab": "Time", "abscissa_axis_units_lab": "s",
        "ordinate_spec_data_type": 12, "ordinate_axis_lab": "Acceleration", "ordinate_axis_units_lab": "g",
        "orddenom_spec_data_type": 0, "orddenom_axis_units_lab": "NONE", "id1": "made for a test"}


def write(path, **change):
    import pyuff

    given = {**TIME, "x": np.arange(5) / 1000, "data": np.arange(5.0), **change}
    numbers = {name: value for name, value in given.items() if not name.endswith("_lab")}
    whole = {name: value or 0 for name, value in pyuff.prepare_58(**numbers, return_full_dict=True).items()
             if value is None or np.size(value) == 1}
    pyuff.UFF(str(path)).write_sets({**whole, **given}, mode="overwrite")
    return path


def test_time_signals(tmp_path):
    channels, frf, modes = read_uff(write(tmp_path / "a.uff"))
    found = channels["acc_1"]
    assert not frf and not modes and str(found.unit) == "m/s^2" and str(found.measures) == "acceleration"
    np.testing.assert_allclose(found.samples, 9.80665 * np.arange(5), rtol=1e-6)
    assert float(found.rate) == pytest.approx(1000) and found.direction.tolist() == [0, 0, -1]


def test_a_unit_that_the_file_lacks_is_asked_for(tmp_path):
    path = write(tmp_path / "a.uff", ordinate_axis_units_lab="NONE")
    with pytest.raises(ConfigError, match=r"data set 1 \(acc_1\): expected a unit .* add units: \{acc_1"):
        read_uff(path)
    assert str(read_uff(path, {"acc_1": "mm/s^2"})[0]["acc_1"].unit) == "m/s^2"


def test_frequency_responses(tmp_path):
    path = write(tmp_path / "a.uff", func_type=4, ref_node=2, ref_dir=1, orddenom_axis_units_lab="N",
                 ordinate_axis_units_lab="m/s2", x=np.array([0.0, 10.0, 20.0]), data=np.array([1.0, 2j, 3.0]),
                 ord_data_type=6, num_pts=3, abscissa_inc=10.0, abscissa_axis_units_lab="Hz")
    response = read_uff(path)[1]["acc_1"]
    assert response.frequency.tolist() == [0, 10, 20] and str(response.unit) == "m/s^2/N"
    assert response.response[1] == pytest.approx(2j) and str(response.reference) == "node 2 direction 1"


def test_the_unit_of_the_file_counts_and_a_name_that_it_lacks_is_refused(tmp_path):
    path = write(tmp_path / "a.uff")
    assert str(read_uff(path, {"acc_1": "mm"})[0]["acc_1"].unit) == "m/s^2"
    with pytest.raises(ConfigError, match="units: expected responses among acc_1, found acc_2"):
        read_uff(path, {"acc_2": "mm"})


def test_a_file_that_is_cut_off_is_refused(tmp_path):
    path = write(tmp_path / "a.uff")
    whole = path.read_bytes()
    path.write_bytes(whole[:-4])
    with pytest.raises(ConfigError, match="a whole universal file, found one whose last data set does not end"):
        read_uff(path)
    path.write_bytes(whole + whole[:len(whole) // 2])
    with pytest.raises(ConfigError, match="a whole universal file"):
        read_uff(path)


def test_refuses_what_is_no_universal_file(tmp_path):
    (tmp_path / "b.uff").write_text("not at all")
    with pytest.raises(ConfigError, match="b.uff: expected"):
        read_uff(tmp_path / "b.uff")


@pytest.mark.measured
@pytest.mark.skipif(not SAMPLES.is_dir(), reason=f"no universal files at {SAMPLES}; set BRAKECHAIN_DATA")
@pytest.mark.parametrize("name, channel, rate, unit", [
    ("Sample_UFF58_ascii.uff", "mic_01", 65536, "Pa"), ("MPSTD_Set001_2024_10_08.uff", "1pz", 3200, "m/s^2")])
def test_public_samples(name, channel, rate, unit):
    found = read_uff(SAMPLES / name)[0][channel]
    assert float(found.rate) == pytest.approx(rate, rel=1e-5) and str(found.unit) == unit


def test_labels_of_windows_and_g_in_any_place(tmp_path):
    """Bytes of cp1252 keep their unit; g is gravity wherever it stands, in the file and in the case."""
    path = write(tmp_path / "a.uff", ordinate_axis_units_lab="mm/sX")
    path.write_bytes(path.read_bytes().replace(b"mm/sX", b"mm/s\xb2"))
    found = read_uff(path)[0]["acc_1"]
    assert str(found.unit) == "m/s^2" and found.samples[1] == pytest.approx(1e-3)
    frf = {"func_type": 4, "x": np.array([0.0, 10.0, 20.0]), "data": np.array([1.0, 2.0, 3.0 + 0j]), "ord_data_type": 6,
           "num_pts": 3, "abscissa_inc": 10.0, "abscissa_axis_units_lab": "Hz"}
    for label, below, units in (("g", "N", {}), ("g/N", "NONE", {}), ("NONE", "NONE", {"acc_1": "g/N"})):
        path = write(tmp_path / "b.uff", ordinate_axis_units_lab=label, orddenom_axis_units_lab=below, **frf)
        response = read_uff(path, units)[1]["acc_1"]
        assert str(response.unit) == "m/s^2/N" and response.response[0] == pytest.approx(9.80665), (label, units)


def test_a_label_that_names_the_quantity_counts_where_no_code_does(tmp_path):
    path = write(tmp_path / "a.uff", ordinate_spec_data_type=0, ordinate_axis_lab="Sound pressure",
                 ordinate_axis_units_lab="Pa")
    assert str(read_uff(path)[0]["acc_1"].measures) == "sound_pressure"
    path = write(tmp_path / "a.uff", ordinate_spec_data_type=0, ordinate_axis_lab="NONE", ordinate_axis_units_lab="N")
    assert str(read_uff(path)[0]["acc_1"].measures) == "force"
