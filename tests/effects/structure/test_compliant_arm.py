"""An arm in series with a joint."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, period, sprung


@pytest.mark.exact
def test_frequency():
    bench = named("compliant_arm").on(sprung(damping=0.0), "joint_0", {"compliance": 1e-3, "behind": 0.5})
    found = respond(bench, let_go(0.01, duration=3.0))["x"]
    assert 2 * np.pi / period(found) == pytest.approx(np.sqrt(400 / 1.4), rel=1e-6)


@pytest.mark.exact
def test_a_damper_behind_the_arm_is_that_of_spring_and_damper_in_series():
    """Against the dynamic stiffness of a Kelvin-Voigt joint in series with the arm, at its first order in c."""
    rig, size = sprung(damping=0.02), 1e-3
    joints = named("compliant_arm").on(rig, "joint_0", {"compliance": size, "behind": 1.0}).model.joints
    angular = 20.0
    joint = rig.model.joints.stiffness[0] + 1j * angular * rig.model.joints.damping[0]
    series = 1 / (1 / joint + size)
    assert joints.stiffness[0] == pytest.approx(series.real, rel=1e-5)
    assert angular * joints.damping[0] == pytest.approx(series.imag, rel=1e-5)
