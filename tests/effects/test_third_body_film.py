"""The film of the third body."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.bench import respond
from pipeline.physics.dry_friction import constant
from tests.effects.benches import anchored, steady


@pytest.mark.exact
@pytest.mark.parametrize("load", [20.0, 60.0])
def test_the_film_grows_over_the_way_and_with_the_pressure(load):
    values = {"gain": 0.3, "distance": 0.4, "pressure": 4e4}
    run = steady(load, duration=1.0)
    found = respond(named("third_body_film").on(anchored(constant(0.3)), "contact", values), run)
    exact = 0.3 * (1 + 0.3 * load / 40.0 * (1 - np.exp(-2.0 * run.time / 0.4)))
    np.testing.assert_allclose(found["t"][2:] / found["n"][2:], exact[2:], rtol=1e-6)
