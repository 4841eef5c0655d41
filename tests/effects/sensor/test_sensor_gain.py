"""A gain that is off."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_the_channel_shows_more():
    base = respond(sprung(), let_go(0.01))
    found = respond(named("sensor_gain").on(sprung(), "v", {"error": 0.25}), let_go(0.01))
    np.testing.assert_array_equal(found["x"], base["x"])
    np.testing.assert_allclose(found["v"], 1.25 * base["v"], rtol=1e-12)
