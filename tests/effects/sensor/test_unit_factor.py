"""A channel in another unit."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.effects.sensor.unit_factor import FACTORS
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_the_channel_shows_a_multiple():
    base = respond(sprung(), let_go(0.01))
    shown = respond(named("unit_factor").on(sprung(), "v", {"factor": 1000.0}), let_go(0.01))
    np.testing.assert_array_equal(shown["x"], base["x"])
    np.testing.assert_allclose(shown["v"], 1000 * base["v"], rtol=1e-15)


def test_every_factor_has_its_inverse_and_lies_apart_from_the_next():
    np.testing.assert_allclose(np.multiply(FACTORS, FACTORS[::-1]), 1.0)
    assert np.diff(np.log(FACTORS)).min() > 6 * 0.003
