"""What a draw changes of a sliding model, and of friction."""

import numpy as np
import pytest

from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.stability.draws.scatter import NOMINAL, Factors, Pivot, changed_friction
from tests.physics.stability.draws.scattered_block import family, friction

PRESSURE, SPEED = np.array([2e5, 1e6, 3e6]), np.array([1.0, 2.0, 3.0])


def test_the_nominal_draw_changes_nothing():
    case = family()
    same = case.varied(NOMINAL)
    np.testing.assert_array_equal(same.model.stiffness, case.model.stiffness)
    np.testing.assert_array_equal(same.imaginary_stiffness(), case.imaginary_stiffness())
    np.testing.assert_array_equal(same.law_closure, case.law_closure)
    assert changed_friction(friction, case.pivot, NOMINAL, PRESSURE, SPEED).coefficient.tolist() \
        == friction(PRESSURE, SPEED).coefficient.tolist()


def test_factors_reach_what_they_are_named_for():
    case, joints = family(), np.arange(1.0, 10.0)
    drawn = case.varied(Factors(joints, 2.0, 3.0, 1.5, 4.0, 0.5))
    np.testing.assert_allclose(drawn.model.joints.stiffness, joints * case.model.joints.stiffness)
    np.testing.assert_allclose(drawn.joint_loss_factor, 2 * case.joint_loss_factor)
    np.testing.assert_allclose(drawn.model.stiffness, case.model.stiffness + 0.5 * case.lining)
    np.testing.assert_allclose(drawn.loss, 3 * (case.loss + 0.5 * 0.01 * case.lining), atol=1e-3)
    np.testing.assert_allclose(np.gradient(case.law_pressure, drawn.law_closure),
                               4 * np.gradient(case.law_pressure, case.law_closure))
    assert drawn.damping_speed == 0.5 * case.damping_speed


@pytest.mark.exact
def test_slopes_of_changed_friction_are_its_derivatives():
    factors, pivot, step = Factors(friction=0.02, pressure_slope=0.05, speed_slope=-0.03), Pivot(1e6, 2.0), 1e-5
    state = changed_friction(friction, pivot, factors, PRESSURE, SPEED)
    up, down = (changed_friction(friction, pivot, factors, k * PRESSURE, SPEED).coefficient
                for k in (1 + step, 1 - step))
    np.testing.assert_allclose(state.pressure_slope, (up - down) / (2 * step * PRESSURE), rtol=1e-6)
    up, down = (changed_friction(friction, pivot, factors, PRESSURE, k * SPEED).coefficient
                for k in (1 + step, 1 - step))
    np.testing.assert_allclose(state.speed_slope, (up - down) / (2 * step * SPEED), rtol=1e-6)
    assert state.coefficient[1] == pytest.approx(friction(PRESSURE, SPEED).coefficient[1] + 0.02)     # at the pivot


def test_friction_stays_constant_beyond_the_map_and_never_falls_below_zero():
    factors, pivot = Factors(pressure_slope=0.05), Pivot(1e6, 2.0, (5e5, 2e6), (0.1, 10.0))
    level = FrictionState(np.full(3, 0.4), np.zeros(3), np.zeros(3))
    state = changed_friction(lambda p, v: level, pivot, factors, PRESSURE, SPEED)
    np.testing.assert_allclose(state.coefficient, 0.4 + 0.05 * np.log([0.5, 1.0, 2.0]))
    assert state.pressure_slope.tolist() == [0.0, 0.05 / 1e6, 0.0]
    gone = changed_friction(lambda p, v: level, pivot, Factors(friction=-0.5), PRESSURE, SPEED)
    assert not gone.coefficient.any() and not gone.pressure_slope.any()
