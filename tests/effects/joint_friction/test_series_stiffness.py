"""A joint with dry friction behind a contact stiffness."""

import numpy as np
import pytest

from pipeline.effects import named
from tests.effects.benches import sprung
from tests.effects.sliding import pulled


@pytest.mark.exact
def test_slow_pull_meets_the_contact_first_then_joint_and_friction_behind_it():
    """Sticking: k_c e up to the force F; then (k e + F) / (1 + k s), k s = .2."""
    e, force = pulled("series_stiffness", {"compliance": 5e-4, "friction": 1.5})
    inside = e > 2e-4
    expected = np.where(2000 * e < 1.5, 2000 * e, (400 * e + 1.5) / 1.2)
    np.testing.assert_allclose(force[inside], expected[inside], rtol=3e-3)
    assert 2000 * e[-1] > 3


@pytest.mark.exact
def test_without_friction_springs_are_in_series():
    e, force = pulled("series_stiffness", {"compliance": 5e-4, "friction": 0.0})
    np.testing.assert_allclose(force[2000:], 400 / 1.2 * e[2000:], rtol=3e-3)


def test_a_rigid_contact_is_as_stiff_as_the_step_resolves():
    element, = named("series_stiffness").on(sprung(step=1e-3), "joint_0",
                                            {"compliance": 0.0, "friction": 1.0}).model.elements
    np.testing.assert_allclose(element.law.stiffness, 0.6e6)
