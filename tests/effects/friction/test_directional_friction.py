"""Friction of each direction."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.friction.dry_friction import tabulated
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import slider, steady


@pytest.mark.exact
@pytest.mark.parametrize("speed, factor", [(2.0, 1.2), (-2.0, 0.8)])
def test_friction_forwards_and_backwards(speed, factor):
    bench = named("directional_friction").on(slider(), "contact", {"asymmetry": 0.2})
    found = respond(bench, steady(speed=speed))
    np.testing.assert_allclose(found["t"], np.sign(speed) * factor * 0.3 * 40.0, rtol=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("speed, factor", [(2.0, 1.2), (-2.0, 0.8)])
def test_roots_in_each_direction(speed, factor):
    bench = slider(friction=tabulated([0.0, 4.0], [0.5, 0.1]), speed=speed)
    bench = named("directional_friction").on(bench, "contact", {"asymmetry": 0.2})
    exact = np.roots([1.0, 2.0 - factor * 40 * 0.1, 400.0])
    assert abs(roots(bench, steady())[:, None] - exact).min(axis=0).max() < 1e-9


def test_two_of_them_compose():
    effect = named("directional_friction")
    both = effect.on(effect.on(slider(), "contact", {"asymmetry": 0.2}), "contact", {"asymmetry": -0.1})
    for speed, factor in ((2.0, 1.2 * 0.9), (-2.0, 0.8 * 1.1)):
        assert abs(respond(both, steady(speed=speed))["t"][-1]) == pytest.approx(factor * 12.0, rel=1e-9)
