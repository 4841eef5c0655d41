"""Plateau dynamics."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import anchored, slider, steady

VALUES = {"strength": 0.6, "heat": 8e4, "time": 0.05}


@pytest.mark.exact
@pytest.mark.parametrize("load, speed", [(40.0, 2.0), (40.0, 1.0), (80.0, 3.0)])
def test_steady_friction(load, speed):
    found = respond(named("plateau_dynamics").on(slider(), "contact", VALUES), steady(load, speed=speed))
    exact = 0.3 * 1.6 / (1 + 0.6 * load * speed / 1e-3 / 8e4) * load
    np.testing.assert_allclose(found["t"], exact, rtol=1e-6)


@pytest.mark.exact
def test_friction_follows_a_change_of_speed():
    """From 2 to 1 m/s: x goes to its new value as exp(-r t), r = (1 + k p v / q) / tau."""
    run = steady(duration=0.2)
    run = replace(run, drive=np.where(run.time < 0.01, 2.0, 1.0))
    found = respond(named("plateau_dynamics").on(anchored(constant(0.3)), "contact", VALUES), run)
    after = (run.time > 0.012) & (run.time < 0.1)
    left = (found["t"] / found["n"] / 0.3 - 1.6 / 1.3)[after]
    assert np.polyfit(run.time[after], np.log(-left), 1)[0] == pytest.approx(-1.3 / 0.05, rel=1e-3)


@pytest.mark.exact
def test_growth_rates():
    """(s^2 + c s + k)(s + r) - N mu x r_v s = 0 with r_v = k N / (A q tau)."""
    bench = named("plateau_dynamics").on(slider(), "contact", VALUES)
    rate, slope, x = 1.6 / 0.05, 0.6 * 40 / 1e-3 / 8e4 / 0.05, 1.0
    exact = np.roots(np.polyadd(np.polymul([1.0, 2.0, 400.0], [1.0, rate]), [0.0, 0.0, -40 * 0.3 * x * slope, 0.0]))
    found = roots(bench, steady())
    assert max(abs(found - root).min() for root in exact) < 1e-8 * abs(exact).max()
