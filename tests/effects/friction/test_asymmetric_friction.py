"""Friction in one direction only."""

import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
@pytest.mark.parametrize("force", [0.5, -0.5])
def test_only_one_half_of_the_swing_loses(force):
    """Let go from A > 0 the mass moves backwards first: to -A where only forward motion rubs, then to A - 2 F / k."""
    bench = named("asymmetric_friction").on(sprung(damping=0.0), "joint_0", {"force": force})
    x = respond(bench, let_go(0.03, duration=0.4))["x"]
    back = -0.03 if force > 0 else -0.03 + 2 * abs(force) / 400
    assert x[:320].min() == pytest.approx(back, abs=1e-5)
    assert x[400:].max() == pytest.approx(0.03 - 2 * abs(force) / 400, abs=1e-5)
