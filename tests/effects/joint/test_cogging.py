"""A force that repeats along a joint."""

import numpy as np
import pytest
import scipy

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_a_mass_in_a_detent_swings_as_a_pendulum():
    """m x'' = -s sin(2 pi x / p): the pendulum, whose angle is 2 pi x / p."""
    force, period, begin = 3.0, 0.1, 0.03
    run = let_go(begin)
    bench = sprung(stiffness=0.0, damping=0.0)
    mass = float(bench.model.mass[0, 0])
    x = respond(named("cogging").on(bench, "joint_0", {"sine": force, "cosine": 0.0, "period": period}), run)["x"]
    turn = 2 * np.pi / period
    k = np.sin(turn * begin / 2)                # let go at rest: sin(angle / 2) = k cd(w t)
    _, cosine, delta, _ = scipy.special.ellipj(np.sqrt(force * turn / mass) * run.time, k**2)
    np.testing.assert_allclose(x, 2 / turn * np.arcsin(k * cosine / delta), atol=2e-4 * begin)


def test_a_diagnosis_looks_for_it_only_where_it_is_asked_to():
    assert not named("cogging").weighed
    assert named("backlash").weighed
