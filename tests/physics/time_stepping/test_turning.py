"""Gyroscopic and centrifugal terms of a drive whose speed changes, against SciPy and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.elements import Element, Polynomial
from pipeline.physics.time_stepping.simulate import Hard, History, Penalty, Start, simulate
from tests.physics.lumps import lumps

GYRO = np.array([[0.0, 1.5], [-1.5, 0.0]])
CENTRIFUGAL = np.array([[-0.3, 0.1], [0.1, 0.2]])
STIFFNESS, DRAG = np.array([100.0, 160.0]), np.array([0.4, 0.2])
BEGIN = np.array([0.01, 0.0, 0.0, 0.1])
RAMP, LENGTH = (1.0, 9.0), 4.0


def rotor(elements=()):
    """Two tilts of 1 kg on springs and dampers, with terms of a drive."""
    model = lumps([1.0, 1.0], np.eye(2), STIFFNESS, DRAG, speed=RAMP[0])
    return replace(model, gyroscopic=GYRO, centrifugal=CENTRIFUGAL, elements=elements)


def speed(time):
    return RAMP[0] + (RAMP[1] - RAMP[0]) * time / LENGTH


def exact(instants, cubic=0.0):
    """(4, n) by an integrator of order 8."""
    def rate(time, state):
        q, v, turning = state[:2], state[2:], speed(time)
        force = -STIFFNESS * q - DRAG * v - turning * GYRO @ v - turning**2 * CENTRIFUGAL @ q
        return np.concatenate((v, force - np.array([cubic * q[0] ** 3, 0.0])))

    return solve_ivp(rate, (0, instants[-1]), BEGIN, "DOP853", instants, rtol=1e-11, atol=1e-14).y


def moved(step, model, **more):
    return simulate(model, Hard(), step=step, duration=LENGTH, drive=History(np.array(RAMP), LENGTH),
                    start=Start(BEGIN[:2], BEGIN[2:]), **more)


@pytest.mark.exact
@pytest.mark.parametrize("cubic", [0.0, 4e5])
def test_a_ramp_is_followed_with_order_2(cubic):
    elements = (Element("spring", np.array([1.0, 0.0]), Polynomial(cubic=cubic)),) if cubic else ()
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        motion = moved(step, rotor(elements))
        truth = exact(motion.time, cubic)[:2]
        errors.append(abs(motion.displacement - truth).max() / abs(truth).max())
    assert errors[-1] < 2e-4
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.1)


@pytest.mark.exact
def test_the_first_speed_alone_is_wrong_by_the_whole_motion():
    """What the terms of the ramp are worth: the motion at its first speed is another one."""
    motion = simulate(rotor(), Hard(), step=1e-3, duration=LENGTH, start=Start(BEGIN[:2], BEGIN[2:]))
    truth = exact(motion.time)[:2]
    assert abs(motion.displacement - truth).max() > 0.9 * abs(truth).max()


@pytest.mark.exact
def test_a_constant_course_gives_the_constant_speed():
    still = replace(rotor(), speed=3.0)
    one, other = (simulate(still, Hard(), step=1e-3, duration=1.0, drive=drive, start=Start(BEGIN[:2], BEGIN[2:]))
                  for drive in (3.0, History(np.full(11, 3.0), 0.1)))
    np.testing.assert_array_equal(one.displacement, other.displacement)


@pytest.mark.exact
def test_the_work_of_the_drive_closes_the_balance():
    """Gyroscopic forces do no work; the stiffness that changes with the speed does."""
    assert moved(1e-3, rotor()).imbalance < 1e-4
    assert moved(5e-4, rotor()).imbalance < 0.3 * moved(1e-3, rotor()).imbalance


@pytest.mark.exact
def test_contacts_that_yield_belong_to_it():
    """A contact that stays closed is a spring and a damper: with order 2 the motion of a joint in its place."""
    pressed = {"drive": History(np.array(RAMP), LENGTH), "duration": LENGTH}
    free = lumps([1.0, 1.0], np.eye(2), STIFFNESS, DRAG, [[1.0, 0.0]], [[0.0, 0.0]], speed=RAMP[0])
    joined = lumps([1.0, 1.0], [[1, 0], [0, 1], [1, 0]], [*STIFFNESS, 50.0], [*DRAG, 0.3], speed=RAMP[0])
    start = Start(np.array([-0.5, 0.0]), np.array([0.0, 0.1]))
    force = np.array([-100.0, 0.0])
    models = [replace(m, gyroscopic=GYRO, centrifugal=CENTRIFUGAL) for m in (free, joined)]
    errors = []
    for step in (2e-3, 1e-3):
        one = simulate(models[0], Penalty(50.0, 0.3), constant(0.0), step=step, inputs=force, start=start, **pressed)
        other = simulate(models[1], Hard(), step=step, inputs=force, start=start, **pressed)
        assert one.gap.max() < 0
        errors.append(abs(one.displacement - other.displacement).max() / abs(other.displacement).max())
    assert errors[1] < 1e-4 and np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)


def test_a_step_that_is_too_long_for_the_turning_is_refused():
    fast = replace(rotor(), gyroscopic=4e3 * GYRO)
    with pytest.raises(ConvergenceError, match="gyroscopic forces that settle"):
        simulate(fast, Hard(), step=1e-3, duration=1.0, drive=History(np.array([1.0, 1e3]), 1.0),
                 start=Start(BEGIN[:2], BEGIN[2:]))
