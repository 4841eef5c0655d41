"""Coulomb friction takes the same off every cycle."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_amplitude_falls_by_four_forces_over_stiffness_a_cycle():
    bench = named("coulomb").on(sprung(damping=0.0), "joint_0", {"force": 0.5})
    x = respond(bench, let_go(0.0305, duration=1.5))["x"]
    peaks = x[1:-1][(x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:])]
    np.testing.assert_allclose(peaks[:4], 0.0305 - 4 * 0.5 / 400 * np.arange(1, 5), atol=2e-5)
