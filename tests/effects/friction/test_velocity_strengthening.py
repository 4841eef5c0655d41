"""Contact friction that rises with the logarithm of the speed."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import slider, steady

VALUES = {"slope": 0.05, "reference_speed": 0.3, "cutoff_speed": 1e-4}


@pytest.mark.exact
@pytest.mark.parametrize("speed", [3e-3, 0.05, 0.3, 2.0])
def test_steady_friction_follows_the_logarithm(speed):
    """Far above the cut-off speed arcsinh(v / 2 v_c) is ln(v / v_c), to (v_c / v)^2."""
    bench = named("velocity_strengthening").on(slider(), "contact", VALUES)
    exact = 0.3 * (1 + 0.05 * np.log(speed / 0.3)) * 40.0
    assert respond(bench, steady(speed=speed))["t"][0] == pytest.approx(exact, rel=2e-4)


@pytest.mark.exact
def test_below_the_cutoff_speed_friction_is_that_of_rest():
    bench = named("velocity_strengthening").on(slider(), "contact", VALUES)
    exact = 0.3 * (1 + 0.05 * (np.arcsinh(5e-8 / 2e-4) - np.arcsinh(0.3 / 2e-4))) * 40.0
    assert respond(bench, steady(speed=5e-8))["t"][0] == pytest.approx(exact, rel=2e-4)
