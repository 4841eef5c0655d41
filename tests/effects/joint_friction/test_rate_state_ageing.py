"""Rate-and-state friction of a joint, ageing law."""

import numpy as np
import pytest

from pipeline.physics.friction.joint_friction import REFERENCE_SPEED as V
from tests.effects.sliding import sliding_error, steady_speed

VALUES = {"force": 1.0, "direct": 0.03, "evolution": 0.02, "length": 5e-3}
#: what keeps the mass sliding at the speed with which it begins, where its contact has settled
STEADY = 3.0 * 0.1 + 1 + 0.01 * np.log(0.1 / V)


@pytest.mark.exact
def test_slides_steadily_by_the_logarithm_of_the_speed():
    speed = 0.2
    force = 3.0 * speed + 1 + 0.01 * np.log(speed / V)
    assert steady_speed("rate_state_ageing", VALUES, force, near=0.1) == pytest.approx(speed, rel=1e-4)


@pytest.mark.exact
def test_sliding_is_that_of_scipy_at_order_two():
    def law(x, v, z):
        return (1 + 0.03 * np.log(v / V) + 0.02 * np.log(V * z[0] / 5e-3)), (1 - v * z[0] / 5e-3,)

    errors = [sliding_error("rate_state_ageing", VALUES, law, (5e-3 / 0.1,), step, STEADY) for step in (4e-3, 2e-3)]
    assert errors[1] < 1e-4 and errors[0] / errors[1] > 3
