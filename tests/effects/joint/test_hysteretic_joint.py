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
                                         {"share": share, "slip_force": slip, "exponent": x})
    run = Run("pull", 20.0, RATE)
    pull = 3.0 * run.time / 20.0
    e = respond(bench, replace(run, inputs={"input_0": pull}))["x"]
    largest = (x + 2) / (x + 1) * slip / (share * 400)
    inside = (e > 0.2 * largest) & (e < largest)
    backbone = 400 * e - share * 400 * e ** (x + 2) / ((x + 2) * largest ** (x + 1))
    drag = 40 * np.gradient(e, run.time)
    np.testing.assert_allclose((pull - drag)[inside], backbone[inside], rtol=3e-3)
    assert inside.sum() > 1000
