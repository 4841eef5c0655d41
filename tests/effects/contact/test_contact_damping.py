"""Damping of contacts along their normals."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Table
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import slider, steady


@pytest.mark.exact
def test_a_pressed_mass_rings_down():
    """A penalty contact gets the damper k length s: amplitude exp(-c t / (2 m)) about the new rest."""
    bench = named("contact_damping").on(slider(), "contact", {"loss": 0.2, "length": 2e-3})
    run = steady(40.0, 0.5)
    y = respond(bench, replace(run, inputs={"input_1": np.where(run.time < 0.01, -40.0, -42.0)}))["y"]
    drag = 2e4 * 2e-3 * 0.2
    swing, turn = y + 42 / 2e4, 2 * np.pi / np.sqrt(2e4 - drag**2 / 4)
    later = np.interp(run.time + 3 * turn, run.time, swing)
    early = (run.time > 0.05) & (run.time < 0.15)
    np.testing.assert_allclose(later[early], swing[early] * np.exp(-1.5 * drag * turn), atol=2e-6)


@pytest.mark.parametrize("speed, loss, exact", [(np.inf, 0.5, 2.0), (0.5, 2.0, 0.25), (0.5, 0.0, 0.5)])
def test_a_table_takes_it_into_its_damping_speed(speed, loss, exact):
    bench = slider(Table(np.array([0.0, 1.0]), np.array([0.0, 2e7]), speed))
    changed = named("contact_damping").on(bench, "contact", {"loss": loss, "length": 1.0})
    assert changed.law.damping_speed == pytest.approx(exact)
