"""Friction laws times a factor along one axis."""

import numpy as np
import pytest

from pipeline.effects.friction.friction_table import times
from pipeline.physics.friction.dry_friction import constant, tabulated


@pytest.mark.exact
def test_a_table_and_a_factor_multiply_where_they_are_sampled():
    base = tabulated([0.0, 1.0, 3.0], [0.5, 0.3, 0.2])
    both = times(times(base, "speed", [0.5, 2.0], lambda v: 1 + v), "pressure", [1.0, 2.0], lambda p: 2 - p / 4)
    for pressure in (1.0, 2.0):
        for speed in (0.0, 0.5, 1.0, 2.0, 3.0):
            exact = base.at_speed(speed) * (1 + speed) * (2 - pressure / 4)
            assert both.at_speed(speed, pressure) == pytest.approx(exact, rel=1e-12)


def test_a_factor_of_one_leaves_the_law_alone():
    base = constant(0.3)
    assert times(base, "speed", [1.0, 2.0], np.ones_like) is base
