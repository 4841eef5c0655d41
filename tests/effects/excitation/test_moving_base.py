"""A base that moves as well."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_the_two_frequencies_of_a_mass_on_a_moving_base():
    """m = 1, k = 400 on m_b = 0.5, k_b = 800: w^4 - w^2 (k / m + (k + k_b) / m_b) + k k_b / (m m_b) = 0."""
    own = np.sqrt(800 / 0.5) / (2 * np.pi)
    bench = named("moving_base").on(sprung(), "joint_0", {"compliance": 1 / 800, "frequency": own})
    mass, _, stiffness = bench.model.supported()
    found = np.linalg.eigvals(np.linalg.solve(mass, stiffness))
    np.testing.assert_allclose(sorted(found), sorted(np.roots([1, -(400 + 1200 / 0.5), 400 * 800 / 0.5])), rtol=1e-9)
    assert bench.model.body_name[-1] == "base of joint_0"


@pytest.mark.exact
def test_a_stiff_base_hardly_moves():
    base = sprung()
    bench = named("moving_base").on(base, "joint_0", {"compliance": 1e-7, "frequency": 500.0})
    still, moving = (respond(b, pushed())["x"] for b in (base, bench))
    np.testing.assert_allclose(moving, still, atol=1e-3 * abs(still).max())


def pushed():
    """Pushed from rest: runs that state a start belong to one number of coordinates."""
    return replace(let_go(0.0), start=None, inputs={"input_0": 2.0})


def test_it_is_weighed_beside_what_else_adds_a_mode():
    """From one coordinate of a free decay two masses in series, a rider and a second mode are one and the same."""
    assert all(named(effect).elaborate for effect in ("moving_base", "tuned_absorber", "second_mode"))
