"""Friction that rises with speed."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import slider, steady


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.5, 2.0, -3.0])
def test_steady_friction_is_linear_in_speed(speed):
    bench = named("viscous").on(slider(), "contact", {"slope": 0.2})
    found = respond(bench, steady(speed=speed))["t"]
    np.testing.assert_allclose(found[1:], np.sign(speed) * 0.3 * (1 + 0.2 * abs(speed)) * 40.0, rtol=1e-6)
