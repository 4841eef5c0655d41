"""A joint whose damping grows with speed."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_half_a_swing_in_closed_form():
    """(1 + a A) exp(-a A) is equal at both ends of half a swing, a = 2 c / m, the other end counted below 0."""
    bench = named("quadratic_damping").on(sprung(damping=0.0), "joint_0", {"coefficient": 5.0})
    other, a = -respond(bench, let_go(0.03, duration=0.25))["x"].min(), 10.0
    assert (1 - a * other) * np.exp(a * other) == pytest.approx((1 + a * 0.03) * np.exp(-a * 0.03), rel=1e-5)
    assert other < 0.026
