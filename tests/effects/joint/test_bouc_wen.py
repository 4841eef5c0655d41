"""Hysteresis of Bouc and Wen in a joint."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung
from tests.effects.sliding import pulled

VALUES = {"share": 0.6, "yield_displacement": 2e-3, "shape": 0.8}


@pytest.mark.exact
def test_slow_pull_follows_the_exponential():
    """f = (1 - s) k e + s k d (1 - exp(-e / d)) on a spring of 400 N/m."""
    e, force = pulled("bouc_wen", VALUES)
    inside = e > 2e-4
    exact = 400 * (0.4 * e + 0.6 * 2e-3 * (1 - np.exp(-e / 2e-3)))
    np.testing.assert_allclose(force[inside], exact[inside], rtol=2e-3)
    assert e[-1] > 4e-3


@pytest.mark.exact
def test_decay_is_that_of_scipy_at_order_two():
    def slope(t, state):
        x, v, z = state
        bent = v - abs(z) * (0.8 * v + 0.2 * abs(v) * np.sign(z))
        return v, -160 * x - 240 * 2e-3 * z - 0.4 * v, bent / 2e-3

    run = let_go(5e-3)
    exact = solve_ivp(slope, (0, run.duration), (5e-3, 0, 0), t_eval=run.time, rtol=1e-10, atol=1e-13, max_step=1e-3)
    errors = [abs(respond(named("bouc_wen").on(sprung(step=step), "joint_0", VALUES), run)["x"] - exact.y[0]).max()
              for step in (5e-4, 2.5e-4)]
    assert errors[1] < 1e-5 and errors[0] / errors[1] == pytest.approx(4, rel=0.3)
