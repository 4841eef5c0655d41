"""Rate-and-state friction of a joint, ageing law."""

import numpy as np
import pytest

from pipeline.physics.friction.joint_friction import REFERENCE_SPEED as V
from tests.effects.sliding import RATE_STATE, sliding_error, steady_force, steady_speed


@pytest.mark.exact
def test_slides_steadily_by_the_logarithm_of_the_speed():
    speed, force = 0.2, steady_force(0.2)
    assert steady_speed("rate_state_ageing", RATE_STATE, force, near=0.1) == pytest.approx(speed, rel=1e-4)


@pytest.mark.exact
def test_sliding_is_that_of_scipy_at_order_two():
    def law(x, v, z):
        return (1 + 0.03 * np.log(v / V) + 0.02 * np.log(V * z[0] / 5e-3)), (1 - v * z[0] / 5e-3,)

    errors = [sliding_error("rate_state_ageing", RATE_STATE, law, (5e-3 / 0.1,), step, steady_force(0.1))
              for step in (4e-3, 2e-3)]
    assert errors[1] < 1e-4 and errors[0] / errors[1] > 3
