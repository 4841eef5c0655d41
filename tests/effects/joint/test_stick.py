"""The elastic way before friction of a joint slides."""

import pytest

from pipeline.effects.joint.stick import stick_stiffness
from tests.effects.benches import sprung


@pytest.mark.exact
def test_the_mass_on_that_spring_has_a_fixed_number_of_steps_in_a_period():
    """w h = sqrt(0.15), whatever mass and step."""
    for mass, step in ((1.0, 1e-4), (95.0, 1e-3)):
        bench = sprung(mass=mass, step=step)
        angular = (stick_stiffness(bench, bench.joint("joint_0")[0]) / mass) ** 0.5
        assert angular * step == pytest.approx(0.15**0.5)
