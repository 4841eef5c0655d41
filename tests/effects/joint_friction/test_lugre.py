"""LuGre friction in a joint."""

import numpy as np
import pytest

from tests.effects.sliding import sliding_error, steady_speed

VALUES = {"force": 1.0, "rise": 0.4, "speed": 0.2, "length": 2e-3, "damping": 0.5}


@pytest.mark.exact
def test_slides_steadily_on_the_curve_of_stribeck():
    speed = 0.5
    force = 3.0 * speed + 1 + 0.4 * np.exp(-(speed / 0.2) ** 2) + 0.5 * speed
    assert steady_speed("lugre", VALUES, force, near=0.4) == pytest.approx(speed, rel=1e-4)


@pytest.mark.exact
def test_sliding_is_that_of_scipy_at_order_two():
    def law(x, v, z):
        change = (v - abs(v) * z[0] / (1 + 0.4 * np.exp(-(v / 0.2) ** 2))) / 2e-3
        return z[0] + np.sqrt(2e-3) * change + 0.5 * v, (change,)

    errors = [sliding_error("lugre", VALUES, law, (0.0,), step) for step in (2e-3, 1e-3)]
    assert errors[1] < 1e-3 and errors[0] / errors[1] > 3
