"""A joint that softens as it warms up."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, period, sprung


@pytest.mark.exact
def test_frequency_before_and_after():
    bench = named("thermal_softening").on(sprung(damping=0.0), "joint_0", {"drop": 0.19, "time": 1.0})
    x = respond(bench, let_go(0.01, duration=12.0))["x"]
    assert 2 * np.pi / period(x[-4000:]) == pytest.approx(18.0, rel=1e-4)
    assert period(x[:1000]) == pytest.approx(2 * np.pi / 20, rel=0.03)
