"""What names and units say of a column."""

import pytest

from pipeline.recordings.survey.meanings import meaning, split_unit


@pytest.mark.parametrize("name, measures, unit, stated", [
    ("Position [mm]", "displacement", "mm", True), ("Force (kN)", "force", "kN", True),
    ("pos_meas1", "displacement", "m", False),
    ("tau_meas2", "torque", "N m", False), ("i_motor", "current", "A", False), ("encoder", "counts", "1", False),
    ("e_true", "strain", "1", False), ("Sigma_true", "stress", "MPa", False), ("Weg/mm", "displacement", "mm", True),
    ("theta", "angle", "rad", False), ("accX", "acceleration", "m/s^2", False), ("blah", "", "1", False)])
def test_a_column_is_known_by_its_name_and_unit(name, measures, unit, stated):
    found = meaning(name)
    assert (found.measures, found.unit, found.stated) == (measures, unit, stated)


def test_positions_beside_torques_are_angles():
    found = meaning("pos_meas1", turning=True)
    assert (found.measures, found.unit, found.turns, found.index) == ("angle", "rad", True, "1")


def test_what_was_asked_for_filtered_or_of_the_base_is_seen():
    assert meaning("pos_des1").asked and meaning("tau_con2").asked and not meaning("pos_meas1").asked
    assert meaning("pos_filt1").filtered and meaning("base").base


def test_brackets_that_hold_no_unit_stay_in_the_name():
    assert split_unit("Channel (left)") == ("Channel (left)", "")


def test_a_unit_that_no_channel_has_is_none():
    assert not meaning("force", "EU").stated and meaning("force", "EU").unit == "N"
    assert meaning("mic", "PA").measures == "pressure" and meaning("a", "G").measures == "acceleration"
