"""Friction over the sliding distance."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import anchored, steady


@pytest.mark.exact
@pytest.mark.parametrize("rise", [-0.5, 0.4])
def test_friction_over_the_way_slid(rise):
    bench = named("friction_over_distance").on(anchored(constant(0.3)), "contact", {"rise": rise, "distance": 0.4})
    run = steady(duration=1.0)
    found = respond(bench, run)
    exact = 0.3 * (1 + rise * np.exp(-2.0 * run.time / 0.4))
    np.testing.assert_allclose(found["t"][2:] / found["n"][2:], exact[2:], rtol=3e-4)
