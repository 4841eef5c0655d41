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


def write(path, mode="overwrite", force_double=True, **change):
    import pyuff

    given = {**TIME, "x": np.arange(5) / 1000, "data": np.arange(5.0), **change}
    numbers = {name: value for name, value in given.items() if not name.endswith("_lab")}
    whole = {name: value or 0 for name, value in pyuff.prepare_58(**numbers, return_full_dict=True).items()
             if value is None or np.size(value) == 1}
    pyuff.UFF(str(path)).write_sets({**whole, **given}, mode=mode, force_double=force_double)
    return path


RESPONSE = {"func_type": 4, "ref_node": 2, "ref_dir": 1, "x": np.array([0.0, 10.0, 20.0]),
            "data": np.array([1.0, 2j, 3.0]), "ord_data_type": 6, "num_pts": 3, "abscissa_inc": 10.0,
            "abscissa_spec_data_type": 18, "abscissa_axis_lab": "Frequency", "abscissa_axis_units_lab": "Hz",
            "ordinate_axis_units_lab": "m/s2", "orddenom_spec_data_type": 13, "orddenom_axis_units_lab": "N"}


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


def test_the_unit_of_the_case_counts_and_a_name_that_the_file_lacks_is_refused(tmp_path):
    path, told = write(tmp_path / "a.uff"), []
    found = read_uff(path, {"acc_1": "mm/s^2"}, tell=told.append)[0]["acc_1"]
    assert found.samples[1] == pytest.approx(1e-3) and not told
    found = read_uff(path, {"acc_1": "mm"}, tell=told.append)[0]["acc_1"]
    assert (str(found.unit), str(found.measures)) == ("m", "displacement")
    assert told == [f"{path}: acc_1: its head says acceleration; by the unit in the case it is displacement"]
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


@pytest.mark.parametrize("code, label, size, unit, measures", [
    (15, "PA", 1.0, "Pa", "pressure"), (12, "G", 9.80665, "m/s^2", "acceleration"), (12, "g's", 9.80665, "m/s^2",
     "acceleration"), (12, "M/S^2", 1.0, "m/s^2", "acceleration"), (8, "mils", 25.4e-6, "m", "displacement"),
    (5, "deg C", 1.0, "K", "temperature"), (13, "LBF", 4.4482216, "N", "force"), (15, "bar(g)", 1e5, "Pa", "pressure"),
    (0, "RPM", np.pi / 30, "rad/s", "angular_velocity"), (1, "N.m", 1.0, "N m", "torque")])
def test_labels_as_systems_write_them(tmp_path, code, label, size, unit, measures):
    path = write(tmp_path / "a.uff", ordinate_spec_data_type=code, ordinate_axis_lab="NONE",
                 ordinate_axis_units_lab=label)
    found = read_uff(path)[0]["acc_1"]
    assert (str(found.unit), str(found.measures)) == (unit, measures)
    assert found.samples[3] - found.samples[2] == pytest.approx(size)


def test_what_a_label_is_taken_for_is_told_once(tmp_path):
    told = []
    for mode, name in (("overwrite", "Acc 1"), ("add", "Acc 2"), ("add", "Acc 3"), ("add", "Acc 4")):
        path = write(tmp_path / "a.uff", mode, rsp_ent_name=name, ordinate_axis_units_lab="G")
    read_uff(path, tell=told.append)
    assert told == [f"{path}: acc_1, acc_2, acc_3 and 1 more: unit 'G' is read as 9.80665 m/s^2"]


@pytest.mark.parametrize("label", ["EU", "C", "mol", "NONE"])
def test_one_bad_label_leaves_the_other_channels_and_the_case_corrects_it(tmp_path, label):
    write(tmp_path / "a.uff")
    path, told = write(tmp_path / "a.uff", "add", rsp_ent_name="Mic", ordinate_spec_data_type=0,
                       ordinate_axis_lab="NONE", ordinate_axis_units_lab=label), []
    assert list(read_uff(path, tell=told.append)[0]) == ["acc_1"]
    line, = told
    assert line.startswith(f"left out: {path}: data set 2 (mic)") and line.endswith("; add units: {mic: ...}")
    found = read_uff(path, {"mic": "Pa"}, tell=told.append)[0]
    assert list(found) == ["acc_1", "mic"] and str(found["mic"].unit) == "Pa" and len(told) == 1
    with pytest.raises(ConfigError, match=r"data set 2 \(mic\): unit: expected a unit .* found 'EU'"):
        read_uff(path, {"mic": "EU"})
    assert list(read_uff(path, {"mic": "EU"}, keep_going=True)[0]) == ["acc_1"]


@pytest.mark.parametrize("label, step", [("ms", 1.0), ("MSEC", 1.0), ("Milliseconds", 1.0), ("\u00b5s", 1000.0),
                                         ("us", 1000.0), ("SEC", 1e-3), ("NONE", 1e-3)])
@pytest.mark.parametrize("even", [0, 1])
def test_times_are_in_the_unit_of_the_abscissa(tmp_path, label, step, even):
    path = write(tmp_path / "a.uff", x=step * np.arange(7.0, 12.0), abscissa_inc=step, abscissa_min=7 * step,
                 abscissa_axis_units_lab=label, abscissa_spacing=even)
    found = read_uff(path)[0]["acc_1"]
    assert float(found.rate) == pytest.approx(1000, rel=1e-5) and float(found.begin) == pytest.approx(7e-3, rel=1e-5)
    assert float(read_uff(path, time_unit="ms")[0]["acc_1"].rate) == pytest.approx(1e3 / step, rel=1e-5)


@pytest.mark.parametrize("label, size", [("Hz", 1.0), ("kHz", 1e3), ("KHZ", 1e3), ("rad/s", 0.5 / np.pi),
                                         ("RPM", 1 / 60), ("NONE", 1.0), ("1/s", 1.0)])
def test_frequencies_are_in_the_unit_of_the_abscissa(tmp_path, label, size):
    path = write(tmp_path / "a.uff", **{**RESPONSE, "abscissa_axis_units_lab": label})
    assert read_uff(path)[1]["acc_1"].frequency == pytest.approx(size * np.array([0.0, 10.0, 20.0]))
    assert read_uff(path, frequency_unit="MHz")[1]["acc_1"].frequency[1] == pytest.approx(1e7)


@pytest.mark.parametrize("change, told", [
    ({"abscissa_axis_units_lab": "deg"}, "expected times as its abscissa, found 'deg'; add time_unit: ..."),
    ({"abscissa_axis_units_lab": "rpm", "abscissa_spec_data_type": 19},
     "expected times as its abscissa, found rotational speeds in rpm; add time_unit: s where its head is wrong"),
    ({"abscissa_axis_units_lab": "NONE", "abscissa_spec_data_type": 20}, "found orders"),
    ({"abscissa_axis_units_lab": "bogus"}, "unit of the abscissa: expected .* found 'bogus'.*; add time_unit: ..."),
    ({**RESPONSE, "abscissa_axis_units_lab": "s"},
     "expected frequencies as its abscissa, found 's'; add frequency_unit: ...")])
def test_an_abscissa_of_something_else_is_refused_with_the_setting(tmp_path, change, told):
    path = write(tmp_path / "a.uff", **change)
    with pytest.raises(ConfigError, match=rf"data set 1 \(acc_1\).*{told}"):
        read_uff(path)
    given = {"frequency_unit": "Hz"} if change.get("func_type") else {"time_unit": "ms"}
    assert "acc_1" in {**(found := read_uff(path, **given))[0], **found[1]}


@pytest.mark.parametrize("stated, size, unit", [
    ("mm/s^2", 1e-3, "m/s^2/N"), ("g", 9.80665, "m/s^2/N"), ("mm/N", 1e-3, "m/N"),
    ("g/lbf", 9.80665 / 4.4482216152605, "m/s^2/N")])
def test_the_unit_of_the_case_is_that_of_a_response_or_of_the_quotient(tmp_path, stated, size, unit):
    found = read_uff(write(tmp_path / "a.uff", **RESPONSE), {"acc_1": stated})[1]["acc_1"]
    assert (found.response[0], str(found.unit)) == (pytest.approx(size), unit)


def test_one_bad_label_leaves_the_other_responses(tmp_path):
    write(tmp_path / "a.uff", **RESPONSE)
    path, told = write(tmp_path / "a.uff", "add", **{**RESPONSE, "orddenom_axis_units_lab": "EU"}), []
    assert list(read_uff(path, tell=told.append)[1]) == ["acc_1"] and "found 'm/s2/EU'" in told[0]
    found = read_uff(path, {"acc_1_2": "m/s^2/lbf"}, tell=told.append)[1]
    assert found["acc_1_2"].response[0] == pytest.approx(1 / 4.4482216) and len(told) == 1


@pytest.mark.parametrize("code, powers, direction, size, unit", [
    (12, (0, 0), 1, 1e-3, "m/s^2"), (12, (0, 0), 4, 1.0, "rad/s^2"), (8, (0, 0), -5, 1.0, "rad"),
    (13, (0, 0), 6, 1e-3, "N m"),
    (13, (0, 0), 3, 1.0, "N"), (15, (0, 0), 0, 1e6, "Pa"), (2, (0, 0), 0, 1e6, "Pa"), (1, (1, 1), 0, 1e-3, "N m"),
    (1, (-2, 1), 0, 1e6, "Pa"), (3, (0, 0), 0, 1.0, "1")])
def test_files_in_a_system_of_units(tmp_path, code, powers, direction, size, unit):
    """mm and N; rotations have no length, moments one; a general quantity states its powers."""
    import pyuff

    path = write(tmp_path / "a.uff", ordinate_axis_units_lab="NONE", ordinate_axis_lab="NONE", rsp_dir=direction,
                 ordinate_spec_data_type=code, ordinate_len_unit_exp=powers[0], ordinate_force_unit_exp=powers[1])
    pyuff.UFF(str(path)).write_sets(pyuff.prepare_164(
        units_code=5, units_description="mm", temp_mode=2, length=1e3, force=1.0, temp=1.0, temp_offset=273.15), "add")
    found = read_uff(path)[0]["acc_1"]
    assert (found.samples[1], str(found.unit)) == (pytest.approx(size), unit)
