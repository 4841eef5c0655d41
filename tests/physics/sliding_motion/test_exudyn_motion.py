"""The sliding motion of exudyn beside that of the exponential steps."""

import numpy as np
import pytest

from pipeline.physics.sliding_motion.exudyn_motion import integrate
from tests.physics.sliding.test_equilibrium import random_model
from tests.physics.sliding_motion.small_motion import sliding


@pytest.fixture(scope="module")
def moving():
    return sliding(random_model())


@pytest.mark.golden
def test_exudyn_moves_alike(moving):
    """Runge-Kutta steps of exudyn on the same right-hand side: within 0.1 %."""
    _, system = moving
    start = 2.0 * system.reach.astype(complex)
    run = system.run(start, 5e-7, 2e-3, every=20)
    time, states = integrate(system, start, 5e-7, 2e-3, every=20)
    np.testing.assert_allclose(time, run.time, rtol=1e-9)
    velocity = [(system.velocity_rows(np.eye(12)) @ each.T).real for each in (run.state, states)]
    assert abs(velocity[0] - velocity[1]).max() < 1e-3 * abs(velocity[0]).max()
