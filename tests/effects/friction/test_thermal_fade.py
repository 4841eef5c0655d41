"""Thermal fade."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import anchored, steady


@pytest.mark.exact
def test_hot_friction_is_the_root_of_its_balance():
    """(1 + d x) x = mu N v / (A q) when the time constant has passed long ago; cold friction is mu."""
    bench = named("thermal_fade").on(anchored(constant(0.3)), "contact", {"drop": 0.5, "heat": 2e4, "time": 0.05})
    found = respond(bench, steady(duration=1.0))
    power = 0.3 * 40.0 * 2.0 / 1e-3 / 2e4
    hot = 1 + (-1 + np.sqrt(1 + 4 * 0.5 * power)) / 2
    assert found["t"][0] / found["n"][0] == pytest.approx(0.3, rel=1e-9)
    assert found["t"][-1] / found["n"][-1] == pytest.approx(0.3 / hot, rel=1e-6)


@pytest.mark.exact
def test_the_heating_starts_with_the_friction_power():
    """x' = mu N v / (A q tau) at the begin."""
    bench = named("thermal_fade").on(anchored(constant(0.3)), "contact", {"drop": 0.5, "heat": 2e4, "time": 100.0})
    run = steady(duration=0.1)
    found = respond(bench, run)
    heat = (0.3 * found["n"] / found["t"] - 1) / 0.5
    assert np.polyfit(run.time[2:], heat[2:], 1)[0] == pytest.approx(1.2 / 100, rel=2e-3)
