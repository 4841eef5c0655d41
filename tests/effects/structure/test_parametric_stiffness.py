"""A joint whose stiffness swings."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.effects import named
from pipeline.effects.typical import Typical
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung

EFFECT = named("parametric_stiffness")


@pytest.mark.exact
def test_a_free_swing_is_that_of_mathieu():
    values = {"share": 0.2, "frequency": 40 / (2 * np.pi), "phase": 0.7}
    run = let_go(0.01, duration=2.0)
    exact = solve_ivp(lambda t, y: [y[1], -0.4 * y[1] - 400 * (1 + 0.2 * np.cos(40 * t - 0.7)) * y[0]], (0, 2.0),
                      [0.01, 0.0], t_eval=run.time, rtol=1e-10, atol=1e-14)
    x = respond(EFFECT.on(sprung(), "joint_0", values), run)["x"]
    np.testing.assert_allclose(x, exact.y[0], atol=1e-5 * abs(exact.y[0]).max())
    assert abs(x[-500:]).max() > 0.01      # twice the natural frequency: it grows against the damper


@pytest.mark.exact
def test_it_follows_the_drive_where_there_is_one():
    values = {"share": 0.2, "frequency": 6.0, "phase": 0.0}
    still, turning = sprung(), sprung()
    turning = replace(turning, model=turning.model.at_speed(3.0))
    run = let_go(0.01)
    x = respond(EFFECT.on(still, "joint_0", {**values, "frequency": 12.0}), run)["x"]
    np.testing.assert_allclose(respond(EFFECT.on(turning, "joint_0", values), replace(run, drive=6.0))["x"], x,
                               atol=1e-12)


def test_what_swings_less_than_once_in_a_run_is_a_drift():
    swings = {drive: next(p for p in EFFECT.parameters(Typical(mass=1.0, stiffness=400.0, time=5.0, drive=drive))
                          if p.name == "frequency") for drive in (0.0, 6.0)}
    assert all(p.within == (0.2, np.inf) for p in swings.values())
    assert swings[0.0].nominal == pytest.approx(20 / np.pi) and swings[6.0].nominal == pytest.approx(3 / np.pi)
