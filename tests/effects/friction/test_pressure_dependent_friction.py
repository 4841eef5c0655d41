"""Friction that depends on pressure."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import slider, steady


@pytest.mark.exact
@pytest.mark.parametrize("load", [8.0, 40.0, 90.0])
def test_steady_friction_is_a_power_of_the_load(load):
    bench = named("pressure_dependent_friction").on(slider(), "contact", {"exponent": 1 / 3, "pressure": 4e4})
    exact = 0.3 * (load / 40.0) ** (-1 / 3) * load
    np.testing.assert_allclose(respond(bench, steady(load))["t"][1:], exact, rtol=1e-4)
