"""An arm in series with a joint."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, period, sprung


@pytest.mark.exact
def test_frequency():
    bench = named("compliant_arm").on(sprung(damping=0.0), "joint_0", {"compliance": 1e-3})
    found = respond(bench, let_go(0.01, duration=3.0))["x"]
    assert 2 * np.pi / period(found) == pytest.approx(np.sqrt(400 / 1.4), rel=1e-6)
