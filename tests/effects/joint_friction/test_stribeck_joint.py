"""Stribeck friction in a joint."""

import numpy as np
import pytest

from tests.effects.sliding import steady_speed

VALUES = {"force": 1.0, "rise": 0.5, "speed": 0.3, "damping": 0.8}


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.1, 0.6])
def test_slides_steadily_on_its_curve(speed):
    force = 3.0 * speed + 1 + 0.5 * np.exp(-speed / 0.3) + 0.8 * speed
    assert steady_speed("stribeck_joint", VALUES, force, near=1.2 * speed) == pytest.approx(speed, rel=1e-4)
