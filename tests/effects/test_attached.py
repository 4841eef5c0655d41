"""Elements beside joints, masses and springs at points."""

import numpy as np

from pipeline.effects.attached import at_point, beside_joint
from pipeline.physics.time_stepping.elements import Power
from tests.effects.benches import rubbing


def test_an_element_stands_beside_its_joint():
    element, = beside_joint(rubbing(), "drag", "joint_1", Power(3.0)).model.elements
    assert (element.name, element.law) == ("drag joint_1", Power(3.0))
    np.testing.assert_array_equal(element.row, [0, 1, 0])


def test_a_value_at_a_point_acts_along_its_sensor():
    base = rubbing()
    for matrix in ("mass", "stiffness"):
        added = getattr(at_point(base, matrix, "sensor_2", 0.7).model, matrix) - getattr(base.model, matrix)
        np.testing.assert_allclose(added, np.diag([0, 0, 0.7]), rtol=1e-12)
