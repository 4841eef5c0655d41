"""Free play in a joint."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_free_flight_within_the_gap():
    bench = named("backlash").on(sprung(damping=0.0), "joint_0", {"gap": 4e-3})
    found = respond(bench, let_go(0.0, 0.05, 0.3))
    inside = abs(found["x"]) < 4e-3
    np.testing.assert_allclose(abs(found["v"][inside]), 0.05, rtol=1e-4)
    assert found["x"].max() == pytest.approx(4e-3 + 0.05 / 20, rel=1e-4)
