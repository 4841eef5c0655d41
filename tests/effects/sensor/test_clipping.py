"""A channel that clips."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_nothing_beyond_the_limit():
    base = respond(sprung(), let_go(0.01))
    found = respond(named("clipping").on(sprung(), "v", {"inverse_limit": 10.0}), let_go(0.01))
    np.testing.assert_array_equal(found["x"], base["x"])
    np.testing.assert_array_equal(found["v"], np.clip(base["v"], -0.1, 0.1))
    assert abs(base["v"]).max() > 0.1
