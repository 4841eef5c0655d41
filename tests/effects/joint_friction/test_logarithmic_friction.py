"""Friction of a joint that follows the logarithm of the speed."""

import numpy as np
import pytest

from pipeline.physics.friction.joint_friction import REFERENCE_SPEED as V
from tests.effects.sliding import pulled, steady_speed

VALUES = {"force": 1.0, "direct": 0.03}


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.02, 0.4])
def test_slides_steadily_by_the_logarithm_of_the_speed(speed):
    force = 3.0 * speed + 1 + 0.03 * np.log(speed / V)
    assert steady_speed("logarithmic_friction", VALUES, force, near=0.1) == pytest.approx(speed, rel=1e-4)


@pytest.mark.exact
def test_below_its_force_the_joint_creeps_ever_more_slowly():
    """At 1 um/s and below the force is F_0 and less: a pull of half of it does not move the joint."""
    e, _ = pulled("logarithmic_friction", VALUES, top=0.5, duration=2.0)
    assert 0 <= e[-1] < 1e-8
