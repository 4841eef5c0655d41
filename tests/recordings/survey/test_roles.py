"""Which channels answer and which act."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.survey.contents import Signal
from pipeline.recordings.survey.meanings import meaning
from pipeline.recordings.survey.roles import roles

DRAW = np.random.default_rng(1)


def signals(*names, turning=False, **values):
    return [Signal(n, n, meaning(n, turning=turning), 100.0, {"run": values.get(n, DRAW.standard_normal(200))})
            for n in names]


def test_a_robot_has_a_coordinate_for_each_joint():
    same = DRAW.standard_normal(200)
    found = roles(signals("pos_meas1", "pos_meas2", "vel_meas1", "pos_filt1", "tau_con1", "tau_con2", "tau_meas1",
                          "tau_meas2", "tau_fric1", turning=True, pos_meas1=same, pos_filt1=same,
                          tau_fric1=np.zeros(200)))
    assert [s.name for s in found.responses] == ["pos_meas1", "pos_meas2"] and found.balance
    assert [(s.name, k) for s, k in found.drives] == [("tau_meas1", 0), ("tau_meas2", 1)]
    assert found.left_out["tau_fric1"] == "it never changes" and "copies" in found.left_out["pos_filt1"]
    assert "asked for" in found.left_out["tau_con1"]


def test_a_base_that_moves_is_no_response():
    found = roles(signals("base", "position"))
    assert [s.name for s in found.responses] == ["position"] and found.base.name == "base" and not found.balance


def test_where_nothing_tells_the_first_acts_and_it_is_said():
    found = roles(signals("V2", "V1"))
    assert found.guessed and found.responses[0].name == "V2" and found.drives[0][0].name == "V1"


def test_forces_alone_show_no_motion():
    with pytest.raises(ConfigError, match="one that shows a motion"):
        roles(signals("force"))
