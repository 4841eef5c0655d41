"""Steady sliding against statics, and as a start from which nothing moves."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.friction.dry_friction import constant, falling
from pipeline.physics.time_stepping.initial_state import random_kick, steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import Forward, Hard, Lagrange, Penalty, Table, simulate
from tests.physics.lumps import belt, lumps, random_structure

LAWS = [Hard(), Lagrange(0.6), Forward(), Penalty(2e5, 20.0),
        Table(np.array([0, 1e-4, 2e-4]), np.array([0, 10.0, 30.0]), 0.5)]


def legs(height=0.05):
    """A block of 2 kg on two legs 0.2 m apart, held along the belt below its centre."""
    return lumps([2.0, 2.0, 0.01], [[1.0, 0, 0]], [1e4], [50.0], [[0, 1, 0.1], [0, 1, -0.1]], [[1, 0, height]] * 2, 0.5)


@pytest.mark.exact
@pytest.mark.parametrize("law", LAWS)
def test_block_on_two_legs_stays_where_statics_puts_it(law):
    start = steady_start(legs(), law, constant(0.3), [0.0, -20.0, 0.0])
    moment = 0.3 * 20.0 * 0.05 / 0.2
    np.testing.assert_allclose(start.normal, [10 - moment, 10 + moment], rtol=1e-9)
    np.testing.assert_allclose(start.friction, 0.3 * start.normal)
    assert start.displacement[0] == pytest.approx(0.3 * 20 / 1e4)
    motion = simulate(legs(), law, constant(0.3), step=1e-5, duration=0.05, inputs=[0.0, -20.0, 0.0], start=start)
    np.testing.assert_allclose(motion.displacement, start.displacement[:, None] * np.ones(5001), atol=1e-11)


@pytest.mark.exact
def test_friction_is_read_at_the_speed_of_sliding():
    start = steady_start(belt(speed=-0.02), Hard(), falling(0.5, 0.2, 0.02), [0.0, -10.0])
    assert start.displacement[0] == pytest.approx(-10 * (0.2 + 0.3 * np.exp(-1)) / 100, rel=1e-4)
    assert steady_start(belt(speed=0.0), Hard(), constant(0.5), [0.0, -10.0]).displacement[0] == 0


def test_a_leg_that_lifts_carries_nothing():
    """Held high enough, friction turns the block until one leg leaves: a spring on the rotation holds it then."""
    model = lumps([2.0, 2.0, 0.01], [[1.0, 0, 0], [0, 0, 1.0]], [1e4, 500.0], None, [[0, 1, 0.1], [0, 1, -0.1]],
                  [[1, 0, 0.5]] * 2, 0.5)
    start = steady_start(model, Hard(), constant(0.3), [0.0, -20.0, 0.0])
    assert start.normal[0] == 0 and start.normal[1] == pytest.approx(20.0)
    assert model.contacts.normal[0] @ start.displacement > 0


def test_a_contact_out_of_reach_is_left_open():
    start = steady_start(lumps([1.0], [[1.0]], [100.0], normal=[[1.0]], tangent=[[0.0]]), Hard(gap=0.2),
                         constant(0.3), [-1.0])
    assert start.normal[0] == 0 and start.displacement[0] == pytest.approx(-0.01)


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(), Penalty(2e5), Table(np.array([0, 1e-4, 2e-4]), np.array([0, 10.0, 30.0]))])
def test_a_body_on_soft_joints_is_not_free_however_stiff_its_modes(law):
    """A pad on boots of 100 N/m whose vibration mode has 1e15 N/m: one weight for all makes it look free."""
    model = lumps([0.3, 0.3, 1e-6], np.eye(3), [100.0, 100.0, 1e15], None, [[0, 1, 0.5]], [[1, 0, 0.3]], 0.5)
    start = steady_start(model, law, constant(0.4), [0.0, -8.0, 0.0])
    sink = 8.0 - start.normal[0]
    pressed = start.normal[0]
    closed = {Hard: 0.0, Penalty: pressed / 2e5, Table: np.interp(pressed, [0, 10, 30], [0, 1e-4, 2e-4])}
    assert start.displacement[1] == pytest.approx(-sink / 100) and sink > -1e-9
    assert -start.displacement[1] == pytest.approx(closed[type(law)], abs=1e-12)
    assert start.displacement[0] == pytest.approx(0.4 * start.normal[0] / 100)
    assert start.displacement[2] == pytest.approx((0.5 + 0.4 * 0.3) * start.normal[0] / 1e15)


def test_what_has_no_equilibrium_is_refused():
    with pytest.raises(ConfigError, match="free"):
        steady_start(belt(), Hard(), constant(0.3), [0.0, 10.0])
    # a strut leaning into the belt: N (1 - mu tan) < 0 locks
    strut = lumps([1.0], [[1.0]], [1e4], normal=[[1.0]], tangent=[[-2.0]], speed=1.0)
    assert steady_start(strut, Penalty(1e5), constant(0.4), [-10.0]).normal[0] > 10
    with pytest.raises(ConvergenceError, match="locks"):
        steady_start(strut, Hard(), constant(0.6), [-10.0])


@pytest.mark.exact
def test_a_kick_has_the_wanted_effective_value_and_its_seed():
    model = random_structure(6, 2e3)
    system, rows = modal_system(model), model.sensor_rows
    kick = random_kick(system, rows, 1e-3, 7)
    assert np.sqrt(np.mean((rows @ kick) ** 2)) == pytest.approx(1e-3, rel=1e-12)
    np.testing.assert_array_equal(kick, random_kick(system, rows, 1e-3, 7))
    assert np.linalg.norm(kick - random_kick(system, rows, 1e-3, 8)) > 0.1 * np.linalg.norm(kick)
    assert not random_kick(system, rows[:0], 1e-3, 7).any()
