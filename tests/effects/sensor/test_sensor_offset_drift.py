"""A zero that is off and wanders."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import RATE, let_go, sprung


@pytest.mark.exact
def test_a_straight_line_is_added():
    base = respond(sprung(), let_go(0.01))
    found = respond(named("sensor_offset_drift").on(sprung(), "v", {"offset": 0.3, "drift": -0.2}), let_go(0.01))
    np.testing.assert_array_equal(found["x"], base["x"])
    np.testing.assert_allclose(found["v"] - base["v"], 0.3 - 0.2 * np.arange(1001) / RATE, atol=1e-12)
