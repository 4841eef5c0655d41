"""Contacts that give way before they slide."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import slider, steady


@pytest.mark.exact
def test_friction_builds_up_over_the_way():
    """T = mu N (1 - exp(-k s / (mu N))) for a belt that starts under a mass held by a stiff joint."""
    bench = slider(speed=0.0)
    joints = replace(bench.model.joints, stiffness=np.array([1e7]), damping=np.array([500.0]))
    bench = replace(bench, model=replace(bench.model, joints=joints))
    bench = named("micro_slip").on(bench, "contact", {"compliance": 1e-5})
    run = steady(40.0, 0.5)
    found = respond(bench, replace(run, drive=2e-3 * run.time))
    way = 1e-3 * run.time**2 - found["x"]
    np.testing.assert_allclose(found["t"][3:], 12.0 * (1 - np.exp(-1e5 * way[3:] / 12.0)), atol=0.02)
    assert found["t"][-1] > 0.8 * 12


def test_compliances_add():
    one = named("micro_slip").on(slider(), "contact", {"compliance": 1e-5})
    assert named("micro_slip").on(one, "contact", {"compliance": 3e-5}).friction.stiffness == pytest.approx(2.5e4)
