"""Duffing's joint."""

import numpy as np
import pytest
from scipy.special import ellipk

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, period, sprung


@pytest.mark.exact
@pytest.mark.parametrize("amplitude", [0.005, 0.02])
def test_period_is_the_elliptic_integral(amplitude):
    bench = named("cubic_stiffness").on(sprung(damping=0.0), "joint_0", {"coefficient": 5e5})
    hard = 400 + 5e5 * amplitude**2
    exact = 4 * ellipk(5e5 * amplitude**2 / (2 * hard)) / np.sqrt(hard)
    assert period(respond(bench, let_go(amplitude, duration=2.0))["x"]) == pytest.approx(exact, rel=2e-5)
