"""Friction that varies around the disc."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import anchored, slider, steady


@pytest.mark.exact
def test_friction_follows_the_angle_of_the_drive():
    bench = anchored(constant(0.3))
    contacts = replace(bench.model.contacts, position=np.array([[0.0, 0.1, 0.0]]))     # at 90 degrees
    bench = replace(bench, model=replace(bench.model, contacts=contacts))
    run = steady(duration=1.0)
    found = respond(named("friction_scatter").on(bench, "contact", {"amplitude": 0.2, "order": 3.0, "phase": 0.4}), run)
    exact = 0.3 * (1 + 0.2 * np.cos(3 * (2.0 * run.time - np.pi / 2) - 0.4))
    np.testing.assert_allclose(found["t"][2:] / found["n"][2:], exact[2:], rtol=1e-6)


def test_roots_take_its_mean():
    bench = named("friction_scatter").on(slider(), "contact", {"amplitude": 0.2, "order": 3.0, "phase": 0.4})
    np.testing.assert_array_equal(roots(bench, steady()), roots(slider(), steady()))
