"""A stop that is hit and gives back part of the speed."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.effects.structure.impact import loss_angle
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
@pytest.mark.parametrize("restitution", [0.4, 0.7, 1.0])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_free_mass_leaves_with_the_restitution_of_its_speed(restitution, side):
    bench = named("impact").on(sprung(stiffness=0.0, damping=0.0, step=1e-3), "sensor_0",
                               {"inverse_gap": side * 100.0, "restitution": restitution, "stiffness": 1e5})
    assert bench.step < 1e-3
    motion = respond(bench, let_go(0.0, speed=side * 0.2))
    np.testing.assert_allclose(motion["v"][-1], -side * 0.2 * restitution, rtol=0.02)
    assert 0.01 < (side * motion["x"]).max() < 0.011


@pytest.mark.exact
def test_the_restitution_of_a_spring_and_damper_that_do_not_pull():
    for restitution in (0.2, 0.5, 0.9):
        alpha = loss_angle(restitution)
        assert np.exp(-(np.pi - 2 * alpha) * np.tan(alpha)) == pytest.approx(restitution, rel=1e-9)
