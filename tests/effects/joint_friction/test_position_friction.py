"""Friction that depends on the position along a joint."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_a_free_mass_slows_down_as_on_a_spring_that_it_cannot_leave():
    """m x'' = -F (1 + g x): x + 1 / g swings at sqrt(F g / m) until the mass stops, and there it stays."""
    bench = named("position_friction").on(sprung(stiffness=0.0, damping=0.0), "joint_0",
                                          {"force": 2.0, "gradient": 8.0})
    run = let_go(0.0, speed=0.4)
    x = respond(bench, run)["x"]
    stop = np.arctan(0.4 * 8 / 4) / 4
    time = np.minimum(run.time, stop)
    np.testing.assert_allclose(x, (np.cos(4 * time) - 1) / 8 + 0.1 * np.sin(4 * time), atol=2e-6)
    assert run.time[-1] > 2 * stop
