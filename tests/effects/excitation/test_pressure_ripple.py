"""An input that ripples."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import slider, steady

VALUES = {"force": 5.0, "frequency": 3.0, "phase": 0.4}


@pytest.mark.exact
@pytest.mark.parametrize("speed", [1.0, 4.0])
def test_a_pressed_mass_follows_the_ripple_whatever_the_drive_does(speed):
    """m y'' + c y' + k y = -N + F cos(2 pi f t - phase) along an input that points away from the contact."""
    bench, run = named("pressure_ripple").on(slider(Penalty(2e4, 60.0)), "input_1", VALUES), steady(40.0, 1.0, speed)
    w = 6 * np.pi
    exact = -40 / 2e4 + 5 * np.real(np.exp(1j * (w * run.time - 0.4)) / (2e4 - w**2 + 60j * w))
    late = run.time > 0.5
    np.testing.assert_allclose(respond(bench, run)["y"][late], exact[late], atol=1e-6 * 5)


def test_no_root_changes():
    base, run = slider(Penalty(2e4, 60.0)), steady(40.0)
    bench = named("pressure_ripple").on(base, "input_1", VALUES)
    np.testing.assert_array_equal(roots(bench, run), roots(base, run))
