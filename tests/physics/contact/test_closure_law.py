"""Normal force over closure and closing speed: values by hand, slopes by differences, nothing that pulls."""

import numpy as np
import pytest

from pipeline.physics.contact.closure_law import (
    damping_at_rest,
    force_at_rest,
    penalty_forces,
    pressure_at,
    table_forces,
)

pytestmark = pytest.mark.exact
CLOSURE, PRESSURE = np.array([0.0, 1e-6, 3e-6]), np.array([0.0, 2e5, 1e6])
AREA, SPEED = 2e-4, 0.5


def table(closure, rate=0.0):
    closure, rate = (np.atleast_1d(np.asarray(a, float)) for a in np.broadcast_arrays(closure, rate))
    return table_forces(closure, rate, np.full(len(closure), AREA), CLOSURE, PRESSURE, SPEED)


def test_pressure_is_the_table_zero_when_open_and_straight_beyond():
    closure, pressure = np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 10.0])
    read = [pressure_at(c, closure, pressure) for c in (-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 5.0)]
    assert read == [(0, 0), (0, 0), (1, 2), (2, 4), (6, 4), (10, 4), (18, 4)]
    assert pressure_at(0.5, closure, np.concatenate((pressure, 3 * pressure)), 3) == (3, 6)


@pytest.mark.parametrize("laws", [table, lambda c, r=0.0: penalty_forces(*np.broadcast_arrays(
    np.atleast_1d(c).astype(float), np.atleast_1d(r).astype(float)), 3e7, 20.0)])
def test_slopes_are_those_of_the_force(laws):
    closure, rate = np.array([4e-7, 1.7e-6, 6e-6]), np.array([0.1, -0.01, 0.3])
    force, stiffness, damping = laws(closure, rate)
    assert (force > 0).all()
    np.testing.assert_allclose((laws(closure + 1e-11, rate)[0] - force) / 1e-11, stiffness, rtol=1e-4)
    np.testing.assert_allclose((laws(closure, rate + 1e-5)[0] - force) / 1e-5, damping, rtol=1e-6)


def test_no_contact_pulls():
    assert not table([-1e-9, 0.0, 1e-6], [1.0, 1.0, -0.6]).any()
    assert not penalty_forces(np.array([-1e-9, 1e-6]), np.array([1.0, -2.0]), 1e6, 1.0).any()


def test_damping_vanishes_with_the_pressure_and_doubles_it_at_its_speed():
    np.testing.assert_allclose(table(2e-6, SPEED)[0], 2 * table(2e-6)[0])
    assert table(1e-15, 0.4)[0] == pytest.approx(AREA * 2e11 * 1e-15 * 1.8)


def test_damping_at_rest_is_the_slope_over_the_closing_speed():
    force, _, damping = table([5e-7, 2e-6, 9e-6], [0.0, 0.0, 0.0])
    np.testing.assert_allclose(damping_at_rest(force, SPEED), damping, rtol=1e-15)


def test_an_impact_loses_what_the_damping_takes():
    """Below the damping speed the rebound of a mass is 1 - 2 v / (3 v0): Hunt & Crossley 1975, to first order."""
    mass, speed, step, stiffness = 1e-3, 2e-3, 1e-7, np.array([0.0, 1.0])
    closure, rate = 0.0, speed
    while closure >= 0:
        middle, between = closure + 0.5 * step * rate, rate - 0.5 * step * force_of(closure, rate, stiffness) / mass
        closure, rate = closure + step * between, rate - step * force_of(middle, between, stiffness) / mass
    assert -rate / speed == pytest.approx(1 - 2 * speed / (3 * SPEED), abs=2e-5)


def force_of(closure, rate, axis):
    return table_forces(np.array([closure]), np.array([rate]), np.array([1.0]), axis, 1e5 * axis, SPEED)[0, 0]


def test_forces_at_rest_are_those_without_a_closing_speed():
    closure, area = np.array([-1e-6, 5e-7, 9e-6]), np.array([1e-4, 2e-4, 3e-4])
    force, slope = force_at_rest(closure, area, list(CLOSURE), list(PRESSURE))
    np.testing.assert_allclose(force, area * [0, 1e5, 1e6 + 4e11 * 6e-6])
    np.testing.assert_allclose(slope, area * [0, 2e11, 4e11])
