"""Contacts that close later."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import rubbing, slider, steady


@pytest.mark.exact
@pytest.mark.parametrize("gap", [2e-3, -1e-3])
def test_a_pressed_mass_sinks_by_the_gap(gap):
    bench = named("clearance").on(slider(), "contact", {"gap": gap})
    np.testing.assert_allclose(respond(bench, steady())["y"], -gap - 40.0 / 2e4, rtol=1e-9)


def test_only_the_group_named_opens():
    changed = named("clearance").on(rubbing(), "right", {"gap": 2e-3})
    np.testing.assert_array_equal(changed.law.gap, [0.0, 2e-3])
