"""Micro-slip in a joint."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import Run, respond
from tests.effects.benches import RATE, sprung


@pytest.mark.exact
def test_slow_pull_follows_the_backbone():
    """f = k e - s k e^(x + 2) / ((x + 2) phi^(x + 1)), phi = (x + 2) / (x + 1) F / (s k)."""
    share, slip, x = 0.6, 2.0, -0.3
    bench = named("hysteretic_joint").on(sprung(damping=40.0), "joint_0",
                                         {"share": share, "slip_force": slip, "exponent": x, "sliders": 40.0})
    run = Run("pull", 20.0, RATE)
    pull = 3.0 * run.time / 20.0
    e = respond(bench, replace(run, inputs={"input_0": pull}))["x"]
    largest = (x + 2) / (x + 1) * slip / (share * 400)
    inside = (e > 0.2 * largest) & (e < largest)
    backbone = 400 * e - share * 400 * e ** (x + 2) / ((x + 2) * largest ** (x + 1))
    drag = 40 * np.gradient(e, run.time)
    np.testing.assert_allclose((pull - drag)[inside], backbone[inside], rtol=3e-3)
    assert inside.sum() > 1000


@pytest.mark.exact
def test_two_sliders_slip_one_after_the_other():
    """Uniform slip ways up to 2 F / (s k): each slider slips at the middle of its half."""
    bench = named("hysteretic_joint").on(sprung(damping=40.0), "joint_0",
                                         {"share": 0.6, "slip_force": 1.2, "exponent": 0.0, "sliders": 2.0})
    run = Run("pull", 20.0, RATE)
    pull = 3.0 * run.time / 20.0
    e = respond(bench, replace(run, inputs={"input_0": pull}))["x"]
    ways = 2 * 1.2 / 240 * np.array([0.25, 0.75])
    exact = 160 * e + 120 * np.minimum(e, ways[0]) + 120 * np.minimum(e, ways[1])
    inside = e > 0.2 * ways[0]
    np.testing.assert_allclose((pull - 40 * np.gradient(e, run.time))[inside], exact[inside], rtol=3e-3)
    assert e[-1] > 1.1 * ways[1]
