"""Sections of the parts of a lumped system: what they read and refuse."""

import numpy as np
import pytest

from pipeline.case_models.lumped.parts import Inertia, Input, Pendulum, Spring
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill


def test_values_about_an_axis_have_units_of_their_own():
    spring = fill(Spring, {"between": ["arm.rotation", "ground"], "torsional_stiffness": "2 N mm/deg"}, "spring")
    assert spring.torsional_stiffness == pytest.approx(2e-3 * 180 / np.pi) and spring.stiffness == 0
    given = fill(Input, {"along": {"arm.rotation": 1}, "torque": "30 N mm"}, "input")
    assert given.torque == pytest.approx(0.03) and given.force is None
    assert fill(Input, {"displaces": "bar", "angle": "90 deg"}, "input").angle == pytest.approx(np.pi / 2)
    assert fill(Pendulum, {"swings": {"arm.rotation": 1}, "mass": "1 kg", "length": "1 m"}, "p").gravity == 9.80665


@pytest.mark.parametrize(("kind", "given", "said"), [
    (Spring, {"torsional_stiffness": "2 N/m"}, "a quantity in N m/rad"), (Inertia, {"along": {}, "mass": "0 kg"}, "0"),
    (Input, {"torque": "2 N"}, "a quantity in N m"), (Input, {"angle": "2 m"}, "a quantity in rad")])
def test_other_units_are_refused(kind, given, said):
    with pytest.raises(ConfigError, match=said):
        fill(kind, given, "part")
