"""A mass at a point."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, period, sprung


@pytest.mark.exact
def test_frequency():
    bench = named("attached_mass").on(sprung(damping=0.0), "sensor_0", {"mass": 0.21})
    found = respond(bench, let_go(0.01, duration=3.0))["x"]
    assert 2 * np.pi / period(found) == pytest.approx(np.sqrt(400 / 1.21), rel=1e-6)
