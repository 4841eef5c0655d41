"""A surface that runs out."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import rubbing, slider, steady


@pytest.mark.exact
def test_a_pressed_mass_follows_as_its_contact_lets_it():
    """m y'' + k (y + u) = -N about -N / k, u = a cos(n theta - phase); the start's ringing is damped by the contact."""
    values = {"amplitude": 1e-4, "order": 2.0, "phase": 0.4}
    bench = named("runout").on(slider(Penalty(2e4, 60.0)), "contact", values)
    run, w = steady(40.0, 1.0, 10.0), 20.0
    gain = (2e4 + 60j * w) / (2e4 - w**2 + 60j * w)
    exact = -40 / 2e4 - 1e-4 * np.real(gain * np.exp(1j * (w * run.time - 0.4)))
    late = run.time > 0.5
    np.testing.assert_allclose(respond(bench, run)["y"][late], exact[late], atol=2e-6)


@pytest.mark.exact
def test_contacts_meet_the_wave_one_after_the_other():
    """The second contact of the bench sits a quarter of a turn on: an order of 2 reaches it half a wave later."""
    changed = named("runout").on(rubbing(), "contact", {"amplitude": 1e-4, "order": 2.0, "phase": 0.1})
    first, second = changed.model.contacts.waviness
    assert (first.phase, second.phase) == pytest.approx((0.1, 0.1 + np.pi))
