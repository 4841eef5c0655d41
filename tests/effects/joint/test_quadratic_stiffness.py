"""A joint stiffer one way than the other."""

import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung


@pytest.mark.exact
def test_turning_points_have_the_same_potential():
    """k x^2 / 2 + k2 x^3 / 3 is equal where the mass turns round."""
    bench = named("quadratic_stiffness").on(sprung(damping=0.0), "joint_0", {"coefficient": 6e3})
    x = respond(bench, let_go(0.02))["x"]
    other = x.min()
    assert 200 * other**2 + 2e3 * other**3 == pytest.approx(200 * 0.02**2 + 2e3 * 0.02**3, rel=1e-4)
    assert other < -0.022
