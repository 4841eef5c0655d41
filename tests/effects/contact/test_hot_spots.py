"""A surface whose waves grow."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import slider, steady

VALUES = {"amplitude": 1e-4, "order": 6.0, "phase": 0.4, "time": 0.5}


@pytest.mark.exact
def test_a_pressed_mass_follows_waves_that_come_up():
    """m y'' + c (y + u)' + k (y + u) = -N with u = a (1 - exp(-t / tau)) cos(n W t - phase), two exponentials."""
    bench, run, w = named("hot_spots").on(slider(Penalty(2e4, 60.0)), "contact", VALUES), steady(40.0, 2.0, 0.5), 3.0
    exact = -40 / 2e4
    for factor, rate in ((1.0, 1j * w), (-1.0, 1j * w - 1 / 0.5)):
        gain = (2e4 + 60 * rate) / (2e4 + 60 * rate + rate**2)
        exact = exact - 1e-4 * np.real(factor * gain * np.exp(rate * run.time - 0.4j))
    late = run.time > 0.4
    np.testing.assert_allclose(respond(bench, run)["y"][late], exact[late], atol=1e-8)


def test_a_run_starts_cold():
    base, run = slider(Penalty(2e4, 60.0)), steady(40.0)
    bench = named("hot_spots").on(base, "contact", VALUES)
    assert respond(bench, run)["y"][0] == respond(base, run)["y"][0]
    np.testing.assert_array_equal(roots(bench, run), roots(base, run))
