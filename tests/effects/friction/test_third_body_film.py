"""The film of the third body."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.effects.typical import ASPERITIES
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import anchored, steady
from tests.effects.rough_pair import CYCLES, rubbed, rubbing


@pytest.mark.exact
@pytest.mark.parametrize("load", [20.0, 60.0])
def test_the_film_grows_over_the_way_and_with_the_pressure(load):
    values = {"gain": 0.3, "distance": 0.4, "pressure": 4e4}
    run = steady(load, duration=1.0)
    found = respond(named("third_body_film").on(anchored(constant(0.3)), "contact", values), run)
    exact = 0.3 * (1 + 0.3 * load / 40.0 * (1 - np.exp(-2.0 * run.time / 0.4)))
    np.testing.assert_allclose(found["t"][2:] / found["n"][2:], exact[2:], rtol=1e-6)


@pytest.mark.exact
def test_at_asperities_it_is_a_factor_on_their_shear_limit():
    """None before sliding; after the way s friction is 1 + g P / P_0 (1 - exp(-s / d)) times what it was."""
    plain = rubbing(softening=0.0)
    film = named("third_body_film").on(plain, ASPERITIES, {"gain": 0.3, "distance": 4e-3, "pressure": 1e6})
    found, before = rubbed(film), rubbed(plain)
    np.testing.assert_array_equal(found.friction[:, 0], before.friction[:, 0])
    factor = 1 + 0.3 * 2.0 * (1 - np.exp(-CYCLES * 2e-3 / 4e-3))
    np.testing.assert_allclose(found.friction[:, -1], factor * before.friction[:, -1], rtol=1e-6)
