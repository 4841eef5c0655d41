"""A channel with the wrong sign."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_the_channel_shows_the_opposite():
    base = respond(sprung(), let_go(0.01))
    shown = respond(named("reversed_channel").on(sprung(), "v", {"factor": -1.0}), let_go(0.01))
    np.testing.assert_array_equal(shown["x"], base["x"])
    np.testing.assert_array_equal(shown["v"], -base["v"])
