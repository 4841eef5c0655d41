"""A force that follows the angle of the drive."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import RATE, slider, steady


@pytest.mark.exact
def test_slow_variation_is_carried_by_the_contact():
    """Far below resonance the normal force is N + F cos(n theta - phase), all of it on the contact."""
    values = {"force": 5.0, "order": 3.0, "phase": 0.4}
    bench = named("thickness_variation").on(slider(Penalty(2e4, 60.0)), "contact", values)
    run = steady(40.0, 3.0, 1.0)
    late = run.time > 1.0
    exact = 40.0 + 5.0 * np.cos(3.0 * run.time - 0.4)
    np.testing.assert_allclose(respond(bench, run)["n"][late], exact[late], atol=0.02)


@pytest.mark.exact
def test_a_force_or_a_motion():
    """Slow waves under a mass that is pressed: runout moves it by a and hardly loads it (m w^2 a), whatever the
    contact; thickness variation loads it by F and moves it by F / k."""
    wave = {"order": 3.0, "phase": 0.0}
    run, w = steady(40.0, 6.0, 1.0), 3.0
    last = slice(-int(round(2 * np.pi / w * RATE)), None)
    for stiffness in (2e4, 4e4):
        base = slider(Penalty(stiffness, 120.0))
        moved = respond(named("runout").on(base, "contact", {"amplitude": 1e-4, **wave}), run)
        pressed = respond(named("thickness_variation").on(base, "contact", {"force": 5.0, **wave}), run)
        assert np.ptp(moved["y"][last]) / 2 == pytest.approx(1e-4, rel=2e-3)
        assert np.ptp(moved["n"][last]) / 2 == pytest.approx(w**2 * 1e-4, rel=2e-2)
        assert np.ptp(pressed["n"][last]) / 2 == pytest.approx(5.0, rel=2e-3)
        assert np.ptp(pressed["y"][last]) / 2 == pytest.approx(5.0 / stiffness, rel=2e-3)
