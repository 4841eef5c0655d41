"""Viscous damping of a joint."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_logarithmic_decrement():
    """delta = c T / (2 m): 0.4 N s/m of the joint and 1.6 N s/m more."""
    bench = named("joint_damping").on(sprung(), "joint_0", {"damping": 1.6})
    x = respond(bench, let_go(0.02, duration=1.0))["x"]
    wave = np.exp(-np.arange(2001) / 2000) * np.cos(np.sqrt(400 - 1) * np.arange(2001) / 2000 - np.arctan(1 / 399**0.5))
    np.testing.assert_allclose(x, 0.02 * wave / wave[0], atol=1e-9)
