"""Gaps that open as the disc warms up."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import rubbing, slider, steady

CONING = named("thermal_coning")


@pytest.mark.exact
@pytest.mark.parametrize("shift", [2e-4, -2e-4])
def test_a_pressed_mass_follows_the_cone(shift):
    """y = -N / k - d (1 - exp(-t / tau)), slow against the contact: an error of m d / (k tau^2)."""
    bench, run = CONING.on(slider(Penalty(2e4, 60.0)), "contact", {"shift": shift, "time": 0.3}), steady(40.0, 1.5)
    exact = -40 / 2e4 - shift * (1 - np.exp(-run.time / 0.3))
    late = run.time > 0.4
    np.testing.assert_allclose(respond(bench, run)["y"][late], exact[late], atol=2e-3 * abs(shift))


@pytest.mark.exact
def test_a_cone_opens_with_the_radius():
    base = rubbing()
    contacts = replace(base.model.contacts, lever=np.array([0.1, 0.3]))
    changed = CONING.on(replace(base, model=replace(base.model, contacts=contacts)), "contact",
                        {"shift": 1e-3, "time": 0.3}).model.contacts.waviness
    assert [w.amplitude for w in changed] == pytest.approx([0.5e-3, 1.5e-3])
    assert all((w.order, w.frequency, w.phase, w.growth) == (0.0, 0.0, 0.0, 0.3) for w in changed)
