"""A force that follows the angle of the drive."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.bench import respond
from pipeline.physics.time_stepping import Penalty
from tests.effects.benches import slider, steady


@pytest.mark.exact
def test_slow_variation_is_carried_by_the_contact():
    """Far below resonance the normal force is N + F cos(n theta - phase), all of it on the contact."""
    values = {"force": 5.0, "order": 3.0, "phase": 0.4}
    bench = named("thickness_variation").on(slider(Penalty(2e4, 60.0)), "contact", values)
    run = steady(40.0, 3.0, 1.0)
    late = run.time > 1.0
    exact = 40.0 + 5.0 * np.cos(3.0 * run.time - 0.4)
    np.testing.assert_allclose(respond(bench, run)["n"][late], exact[late], atol=0.02)
