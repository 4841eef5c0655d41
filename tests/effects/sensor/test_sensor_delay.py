"""A channel that is late."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import RATE, let_go, sprung


@pytest.mark.exact
def test_the_channel_is_late_by_whole_and_broken_samples():
    base = respond(sprung(), let_go(0.01))
    found = respond(named("sensor_delay").on(sprung(), "v", {"delay": 3.4e-3}), let_go(0.01))
    np.testing.assert_array_equal(found["x"], base["x"])
    exact = np.interp(np.arange(1001) / RATE - 3.4e-3, np.arange(1001) / RATE, base["v"])
    np.testing.assert_allclose(found["v"], exact, atol=1e-3 * abs(exact).max())
