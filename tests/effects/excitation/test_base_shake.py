"""A base that is shaken."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import Run, respond
from tests.effects.benches import RATE, sprung


@pytest.mark.exact
def test_transfer_of_the_shaking():
    bench = named("base_shake").on(sprung(damping=4.0), "joint_0", {"amplitude": 1e-3, "frequency": 4.0, "phase": 0.5})
    run, w = Run("shaken", 6.0, RATE), 8 * np.pi
    gain = (400 + 4j * w) / (400 - w**2 + 4j * w)
    late = run.time > 5
    exact = 1e-3 * np.real(gain * np.exp(1j * (w * run.time[late] - 0.5)))
    np.testing.assert_allclose(respond(bench, run)["x"][late], exact, atol=2e-3 * abs(exact).max())
