"""What a brake comes to: growth of its modes, slopes that its sensitivities give, growth at each operating point."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.design_search.objective import (
    LARGEST,
    SUM,
    at_operating_points,
    evaluation,
    growth_of,
    growth_rates,
)
from tests.case_models.design_search.planted import listed, ranged, space

#: two modes, the stronger one at two operating points
MODES = SimpleNamespace(unstable_first=np.array([0, 1, 0]),
                        unstable_reduced=np.array([30 + 9e3j, 20 + 5e3j, 10 + 9e3j]),
                        unstable_operating=np.array([1, 0, 0]), operating_speed=np.array([8.0, 12.0]))
STABLE = SimpleNamespace(unstable_first=np.array([], int), unstable_reduced=np.array([], complex),
                         unstable_operating=np.array([], int), operating_speed=np.array([8.0, 12.0]))
#: derivatives per N/m of two values
DERIVED = SimpleNamespace(
    mode=np.array([0, 1]), parameter=["friction", "joints.spring", "joints.mesh"],
    method=["analytic", "analytic", "differences"], known=np.ones((2, 3), int), value=np.full((2, 3), 2.0),
    derivative=np.array([[9.0, 4.0 + 1j, 5.0], [8.0, -1.0 + 2j, 6.0]], complex))
BOX = space(ranged(1.0, 1.0, 3.0), ranged(1.0, 1.0, 10.0, log=True, name="joints.mesh"), listed("ab"), worth=[8, 0, 0])


def test_modes_of_one_frequency_count_once():
    members, rates = growth_rates(MODES)
    assert list(members) == [0, 1] and list(rates) == [30, 20]
    assert growth_of(MODES, LARGEST) == 30 and growth_of(MODES, SUM) == 50 and growth_of(STABLE, LARGEST) == 0


@pytest.mark.parametrize("which, growth, slope", [(LARGEST, 30, 4.0 * 2), (SUM, 50, 3.0 * 2)])
def test_slopes_are_derivatives_over_the_range(which, growth, slope):
    """Of values that are derived by vectors; others are left to differences."""
    value = evaluation(BOX, (2.0, 3.0, 0), MODES, DERIVED, which)
    assert value.growth == growth and value.slopes == {0: slope}
    assert value.cost == 4.0 and value.objective == growth + 4.0


def test_joints_that_share_a_stiffness_are_derived_by_their_mean():
    """Four joints of 0.5 N/m each for a setting of 2 N/m: per 1 N/m of the setting each changes by a quarter of it."""
    quarter = SimpleNamespace(**{**vars(DERIVED), "value": np.full((2, 3), 0.5)})
    assert evaluation(BOX, (2.0, 3.0, 0), MODES, quarter, LARGEST).slopes == {0: 4.0 * 2 / 4}


def test_a_value_of_nothing_is_the_setting():
    none = SimpleNamespace(**{**vars(DERIVED), "value": np.zeros((2, 3))})
    assert evaluation(BOX, (2.0, 3.0, 0), MODES, none, LARGEST).slopes == {0: 4.0 * 2}


def test_without_sensitivities_of_a_mode_no_slope_is_known():
    fewer = SimpleNamespace(**{**vars(DERIVED), "mode": np.array([0, 7])})
    assert evaluation(BOX, BOX.own, MODES, fewer, SUM).slopes == {}
    assert evaluation(BOX, (2.0, 1.0, 0), MODES, fewer, LARGEST).slopes == {0: 8.0}
    assert evaluation(BOX, BOX.own, MODES, None, LARGEST).slopes == {}


def test_a_stable_brake_has_no_growth():
    value = evaluation(BOX, (2.0, 3.0, 0), STABLE, DERIVED, SUM)
    assert value.growth == 0 and value.objective == 4.0


def test_growth_at_each_operating_point():
    growth, number = at_operating_points(MODES)
    assert list(growth) == [20, 30] and list(number) == [2, 1]
    assert list(at_operating_points(STABLE)[0]) == [0, 0]
