"""Motion from small to large, held against SciPy and the balance of energy."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.friction.dry_friction import Friction, constant, tabulated
from tests.physics.sliding.test_equilibrium import LOAD, random_model, rising_friction
from tests.physics.sliding_motion.small_motion import KICK, LAW, STICK, contact_force, sliding, steady_friction


@pytest.fixture(scope="module")
def moving():
    return sliding(random_model())


@pytest.mark.exact
@pytest.mark.parametrize("speed", [1.3, -1.3])
def test_motion_is_that_of_scipy_on_the_laws_as_written(speed):
    """A strong kick that opens contacts; second order: halving the step takes the error to a quarter."""
    about, system = sliding(random_model(speed))
    model, friction = random_model(speed), Friction(rising_friction(), distance=0.5)
    load = LOAD * model.input_rows[0]
    pressed = about.contacts.preload
    steady = model.contacts.normal.T @ pressed + model.contacts.tangent.T @ (
        np.sign(speed) * steady_friction(about).coefficient * pressed)
    rest = np.linalg.solve(model.stiffness, load + steady)
    kick = KICK * np.random.default_rng(3).standard_normal(12)

    def rate(time, state):
        place, velocity = np.split(state, 2)
        force = load + contact_force(model, LAW, friction, place, velocity)
        return np.concatenate((velocity, force - model.damping @ velocity - model.stiffness @ place))

    duration, errors = 4e-3, []
    exact = scipy.integrate.solve_ivp(rate, (0, duration), np.concatenate((rest, kick)), "DOP853", rtol=1e-10,
                                      atol=1e-13).y[12:, -1]
    start = system.modes.left.T @ (system.modes.basis.T @ kick)
    for step in (4e-6, 2e-6, 1e-6):
        run = system.run(start, step, duration)
        errors.append(abs((system.velocity_rows(np.eye(12)) @ run.state[-1]).real - exact).max() / abs(exact).max())
    assert run.open.max() > 0 and errors[2] < 2e-3
    assert errors[0] > 3 * errors[1] > 9 * errors[2]


@pytest.mark.exact
@pytest.mark.parametrize("damped", [0.0, 0.2])
def test_energy_balances_with_contacts_that_open_and_roots_that_were_moved(damped):
    _, system = sliding(random_model(), damped=damped)
    run = system.run(3.0 * system.reach.astype(complex), 1e-6, 5e-3, book=True)
    assert run.open.max() > 0 and run.loss[-1] > 0 and run.imbalance < 2e-3
    assert (run.added[-1] > 0.1 * run.loss[-1]) == bool(damped)


@pytest.mark.exact
def test_stick_slip_of_a_mass_on_a_belt():
    """Falling friction lets the motion grow until the mass sticks: its speed is then that of the belt."""
    normal, tangent, lateral = np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]), np.zeros((1, 2))
    belt = replace(random_model(0.2), body_name=("mass",), coordinate_body=np.zeros(2, int), mass=np.eye(2),
                   damping=np.zeros((2, 2)), gyroscopic=np.zeros((2, 2)), stiffness=np.diag([0.0, 1e6]),
                   centrifugal=np.zeros((2, 2)), input_rows=-normal, sensor_rows=np.empty((0, 2)))
    belt = replace(belt, joints=replace(belt.joints, rows=np.zeros((1, 2))), contacts=replace(
        belt.contacts, normal=normal, tangent=tangent, lateral=lateral, position=np.zeros((1, 3)),
        area=np.array([1e-4]), lever=np.ones(1), preload=np.array([LOAD]), stiffness=np.array([1e8]),
        damping=np.zeros(1)))
    falling = tabulated(np.linspace(0, 2, 41), 0.5 - 0.1 * np.linspace(0, 2, 41))
    _, system = sliding(belt, friction=falling)
    growing = system.modes.growing(1.0)
    assert len(growing) == 1 and system.modes.root[growing[0]].real == pytest.approx(0.5 * LOAD * 0.1, rel=1e-6)
    start = np.zeros(len(system.modes.root), complex)
    start[growing] = 0.15 / abs(system.velocity_rows(np.eye(2))[1, growing])
    run = system.run(start, 1e-5, 0.3)
    velocity = (system.velocity_rows(np.eye(2))[1] @ run.state.T).real[-3000:]
    assert run.stick[-3000:].mean() > 0.02
    assert 0.2 - STICK < velocity.max() < 0.2


def test_what_cannot_be_stepped_is_refused(moving):
    _, system = moving
    start = system.reach.astype(complex)
    with pytest.raises(ConfigError, match="step"):
        system.run(start, 0.0, 1e-3)
    with pytest.raises(ConvergenceError, match="t ="):
        system.run(1e6 * start, 1e-3, 1e-1)


def test_a_constant_coefficient_needs_no_table():
    _, system = sliding(random_model(), friction=constant(0.3))
    assert np.isfinite(system.rate(system.reach.astype(complex))).all()
