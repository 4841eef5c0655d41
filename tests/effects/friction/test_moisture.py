"""Moisture."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.friction.dry_friction import tabulated
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import slider, steady


@pytest.mark.exact
@pytest.mark.parametrize("humidity, factor", [(0.5, 1.0), (0.9, 1.2), (0.0, 0.75)])
def test_friction_at_each_humidity(humidity, factor):
    bench = named("moisture").on(slider(), "contact", {"slope": 0.5})
    run = replace(steady(), conditions={"humidity": humidity})
    np.testing.assert_allclose(respond(bench, run)["t"], factor * 0.3 * 40.0, rtol=1e-9)


@pytest.mark.exact
def test_friction_is_never_below_none():
    bench = named("moisture").on(slider(), "contact", {"slope": 3.0})
    found = respond(bench, replace(steady(), conditions={"humidity": 0.0}))
    np.testing.assert_array_equal(found["t"], 0.0)


@pytest.mark.exact
def test_roots_know_the_humidity():
    """Falling friction at twice the humidity slope: s^2 + (c + 1.2 N mu') s + k = 0."""
    bench = named("moisture").on(slider(friction=tabulated([0.0, 4.0], [0.5, 0.1])), "contact", {"slope": 0.5})
    found = roots(bench, replace(steady(), conditions={"humidity": 0.9}))
    exact = np.roots([1.0, 2.0 - 1.2 * 40 * 0.1, 400.0])
    assert abs(found[:, None] - exact).min(axis=0).max() < 1e-9


def test_runs_without_humidity_cannot_ask_for_it():
    damp = replace(steady(), conditions={"humidity": 0.4})
    assert named("moisture").conditions_known((damp,)) and not named("moisture").conditions_known((damp, steady()))


@pytest.mark.parametrize("conditions", [{}, {"humidity": np.array([0.1, 0.2])}])
def test_runs_without_one_humidity_are_refused(conditions):
    bench = named("moisture").on(slider(), "contact", {"slope": 0.5})
    for ask in (respond, roots):
        with pytest.raises(ConfigError, match="condition humidity"):
            ask(bench, replace(steady(), conditions=conditions))
