"""Motion between events against closed forms: sliding that ends, sticking at exact zero, bounces, energy."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching.event_motion import HELD, STOPS, Crossing, Law, Mechanism, moved, stopped
from pipeline.blind_trial.generators.switching.joint_laws import Spot, dry, play
from pipeline.contract.errors import ConvergenceError

ROW = np.array([1.0])
#: kg, N/m, and the angular frequency, rad/s
MASS, STIFFNESS, ANGULAR = 2.0, 800.0, 20.0


def mechanism(*laws, stiffness=STIFFNESS):
    return Mechanism(np.array([[MASS]]), np.zeros((1, 1)), np.array([[stiffness]]), laws, 0.01, 0.2)


def none(t):
    return np.zeros(1)


@pytest.mark.exact
def test_dry_friction_takes_two_equal_shares_a_half_period_and_then_holds_at_exact_zero():
    """x_k = (-1)^k (x_0 - 2 k F / K) at the k-th reversal, until it is within F / K."""
    force, start = 1.0, 0.0073
    time = np.arange(3) * np.pi / ANGULAR
    motion = moved(mechanism(dry(ROW, force, force)), none, time, np.array([start, 0.0]))
    np.testing.assert_allclose(motion.displacement[0, :3], [start, -(start - 0.0025), start - 0.005], rtol=1e-7)
    resting = moved(mechanism(dry(ROW, force, force)), none, np.linspace(0.5, 2.0, 7) + 3 * np.pi / ANGULAR,
                    np.array([0.0009, 0.0]))
    assert not resting.velocity.any() and not resting.acceleration.any() and (resting.displacement == 0.0009).all()


@pytest.mark.exact
def test_friction_holds_until_a_rising_force_exceeds_it():
    """Under a push of 4 N/s a block on a friction of 1 N lets go at 0.25 s: x = 4 (t - 0.25)^3 / (6 M)."""
    free = Mechanism(np.array([[MASS]]), np.zeros((1, 1)), np.array([[1e-9]]), (dry(ROW, 1.0, 1.0),), 0.01, 0.2)
    time = np.array([0.1, 0.2499, 0.4, 0.75])
    motion = moved(free, lambda t: np.array([4.0 * t]), np.concatenate(([0.0], time)))
    expected = 4 * np.maximum(time - 0.25, 0.0) ** 3 / (6 * MASS)
    np.testing.assert_allclose(motion.displacement[0, 1:], expected, rtol=1e-6, atol=1e-12)
    assert (motion.velocity[0, :3] == 0).all() and motion.events == 1


@pytest.mark.exact
@pytest.mark.parametrize("restitution", [0.4, 0.8])
def test_a_bouncing_body_meets_the_floor_at_the_instants_of_a_geometric_series_and_rests(restitution):
    gravity, height = 10.0, 0.2
    first = np.sqrt(2 * height / gravity)
    floor = Law(np.array([-1.0]), lambda t, e, v, z, mode: 0.0, first=-1, limits=lambda t, e, z: (0.0, np.inf),
                crossings=lambda mode: (Crossing(lambda t, e, v, z: e, lambda v: STOPS if v < 1e-3 else -1,
                                                 lambda m, law, v, z: (stopped(m, law, v, restitution), z)),))
    ball = Mechanism(np.array([[MASS]]), np.zeros((1, 1)), np.array([[1e-9]]), (floor,), 0.01, 0.2)
    tops = first + 2 * first * np.concatenate(([0.0], np.cumsum(restitution ** np.arange(1, 3))))[:2]
    tops = tops + first * restitution ** np.arange(1, 3)
    end = first * (1 + restitution) / (1 - restitution)
    motion = moved(ball, lambda t: np.array([-MASS * gravity]), np.array([0.0, *tops, end + 0.1]),
                   np.array([height, 0.0]))
    np.testing.assert_allclose(motion.displacement[0, 1:3], height * restitution ** (2 * np.arange(1, 3)), rtol=1e-6)
    assert motion.velocity[0, -1] == 0 and abs(motion.displacement[0, -1]) < 1e-9


@pytest.mark.exact
def test_a_spring_with_play_keeps_its_energy():
    spot = Spot(ROW, 0.005, 0.1, STIFFNESS, (0.5,) * 3)
    motion = moved(mechanism(*play(spot, 0.3)), none, np.linspace(0, 3, 301), np.array([0.01, 0.0]))
    stretch = np.maximum(abs(motion.displacement[0]) - 0.0015, 0.0)
    energy = MASS * motion.velocity[0] ** 2 / 2 + STIFFNESS * stretch**2 / 2
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)
    period = 2 * np.pi / ANGULAR + 4 * 0.0015 / (ANGULAR * 0.0085)
    again = moved(mechanism(*play(spot, 0.3)), none, np.array([0.0, period]), np.array([0.01, 0.0]))
    assert again.displacement[0, 1] == pytest.approx(0.01, rel=1e-7) and again.events == 4


@pytest.mark.exact
def test_a_push_that_jumps_is_met_at_its_instant():
    """Held force: x = F / K (1 - cos w (t - t_0)), nothing before."""
    time = np.linspace(0, 1, 21)
    motion = moved(mechanism(), lambda t: np.array([4.0 * (t >= 0.333)]), time, breaks=(0.333,))
    expected = 0.005 * (1 - np.cos(ANGULAR * np.maximum(time - 0.333, 0.0)))
    np.testing.assert_allclose(motion.displacement[0], expected, atol=1e-9)


def test_a_held_law_keeps_a_row_of_several_bodies_together():
    row = np.array([1.0, -1.0])
    two = Mechanism(np.diag([1.0, 3.0]), np.zeros((2, 2)), np.diag([400.0, 0.0]), (dry(row, 50.0, 50.0),), 0.01, 0.2)
    motion = moved(two, lambda t: np.zeros(2), np.linspace(0, 2 * np.pi / 10, 9), np.array([0.01, 0.02, 0.0, 0.0]))
    np.testing.assert_allclose(motion.displacement[0], 0.01 * np.cos(10 * np.linspace(0, 2 * np.pi / 10, 9)), atol=1e-9)
    assert abs(row @ motion.velocity).max() < 1e-12 and motion.events == 0


@pytest.mark.exact
def test_a_slip_far_shorter_than_a_step_is_found():
    """A push of F + a - b t^2 / 2 for a moment: slips of a millisecond under steps of thirty."""
    force, peak = 1.0, 1e-3
    heavy = Mechanism(np.array([[MASS]]), np.zeros((1, 1)), np.array([[1e-9]]), (dry(ROW, force, force),), 0.01, 0.2)

    def push(t):
        return np.array([(force + peak) * np.cos(40 * (t - 0.5))])

    motion = moved(heavy, push, np.linspace(0.45, 0.55, 11))
    assert motion.events >= 2 and (motion.velocity[0, [0, -1]] == 0).all()
    begin, since = np.arccos(force / (force + peak)) / 40, np.linspace(0, 1, 200_001)
    time = -begin + 6 * begin * since
    speed = np.cumsum((force + peak) * np.cos(40 * time) - force) * (time[1] - time[0]) / MASS
    way = np.sum(speed[:np.argmax(speed[10:] < 0) + 10]) * (time[1] - time[0])
    assert motion.displacement[0, -1] == pytest.approx(way, rel=1e-3)


def test_a_motion_that_cannot_be_integrated_is_refused():
    wild = Law(ROW, lambda t, e, v, z, mode: np.nan if t > 0.1 else 0.0)
    with pytest.raises(ConvergenceError, match="motion of a switching rig"), np.errstate(invalid="ignore"):
        moved(mechanism(wild), none, np.array([0.0, 1.0]), np.array([0.01, 0.0]))
    assert HELD == 0
