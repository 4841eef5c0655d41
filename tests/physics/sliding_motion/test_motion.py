"""Motion from small to large, held against SciPy, exudyn, complex modes and the balance of energy."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.friction.dry_friction import Friction, constant, tabulated
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.equilibrium import closure_response, from_map, model_about, steady_sliding
from pipeline.physics.sliding_motion.exudyn_motion import integrate
from pipeline.physics.sliding_motion.motion import sliding_motion
from pipeline.physics.sliding_motion.sliding_modes import sliding_modes
from pipeline.physics.time_stepping.simulate import Table
from tests.physics.sliding.test_equilibrium import LOAD, random_model, rising_friction

#: closure and pressure, so finely sampled that no row shows
LAW = np.linspace(0, 6e-6, 20001), 2e11 * np.linspace(0, 6e-6, 20001) + 1e17 * np.linspace(0, 6e-6, 20001) ** 2
#: above all modes, and the closing speed that doubles the contact force
BELOW, SETTLING = 1e6, 0.5
STICK, KICK = 0.02, 0.008


def sliding(model, law=LAW, friction=None, load=LOAD, patch=1, damped=0.0):
    """(model about its steady sliding, SlidingMotion with all its modes), the upper half of them ``damped``."""
    friction = Friction(rising_friction(), distance=0.5) if friction is None else friction
    state = steady_sliding(model, closure_response(model), np.array([load]), *law,
                           partial(from_map, friction.law, friction.distance))
    about = model_about(model, state.contact, SETTLING)
    modes = sliding_modes(about, state.friction, BELOW, 1e-12)
    modes = modes.damped_above(np.median(abs(modes.root)) / (2 * np.pi), damped) if damped else modes
    return about, sliding_motion(about, state.contact.closure, friction, Table(*law, SETTLING), modes,
                                 np.zeros(len(model.contacts.area), int), patch, STICK)


def contact_force(model, law, friction, place, velocity):
    """Generalised force (n,) of all contacts: the laws as they are written down, contact by contact."""
    contacts, total = model.contacts, np.zeros(model.size)
    for i, area in enumerate(contacts.area):
        n, t, lateral = contacts.normal[i], contacts.tangent[i], contacts.lateral[i]
        pressure = max(np.interp(-n @ place, *law) * (1 - n @ velocity / SETTLING), 0.0)
        slip = np.array([model.sliding_speed[i] - t @ velocity, -lateral @ velocity])
        size = np.hypot(*slip)
        mu = friction.law.evaluate(pressure, size, friction.distance)[0]
        part = min(size / STICK, 1.0)
        drawn = area * pressure * mu * part * (3 - part**2) / 2 * slip / size
        total += area * pressure * n + drawn[0] * t + drawn[1] * lateral
    return total


@pytest.fixture(scope="module")
def moving():
    return sliding(random_model())


@pytest.mark.exact
def test_small_motion_has_the_roots_of_the_linearised_system(moving):
    """Eigenvalues of the numerical Jacobian of the nonlinear motion, all of them."""
    about, system = moving
    half, small = len(system.modes.root), 1e-3 * system.reach
    jacobian = np.zeros((2 * half, 2 * half))
    for k in range(2 * half):
        start = np.zeros(half, complex)
        start[k % half] = small[k % half] * (1.0 if k < half else 1j)
        change = (system.rate(start) - system.rate(-start)) / (2 * small[k % half])
        jacobian[:, k] = np.concatenate((change.real, change.imag))
    pairs = system.modes.oscillating
    seen = np.linalg.eigvals(jacobian)
    direct = quadratic_roots(*about.linearised(_steady_friction(about)))
    assert pairs.sum() * 2 + (~pairs).sum() == len(direct)
    for root in direct:
        assert abs(seen - root).min() < 2e-4 * abs(root)


def _steady_friction(about):
    return from_map(rising_friction(), 0.5, about.contacts.pressure, abs(about.sliding_speed))


@pytest.mark.exact
@pytest.mark.parametrize("speed", [1.3, -1.3])
def test_motion_is_that_of_scipy_on_the_laws_as_written(speed):
    """A strong kick that opens contacts; second order: halving the step takes the error to a quarter."""
    about, system = sliding(random_model(speed))
    model, friction = random_model(speed), Friction(rising_friction(), distance=0.5)
    load = LOAD * model.input_rows[0]
    pressed = about.contacts.preload
    steady = model.contacts.normal.T @ pressed + model.contacts.tangent.T @ (
        np.sign(speed) * _steady_friction(about).coefficient * pressed)
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


@pytest.mark.golden
def test_exudyn_moves_alike(moving):
    """Runge-Kutta steps of exudyn on the same right-hand side: within 0.1 %."""
    _, system = moving
    start = 2.0 * system.reach.astype(complex)
    run = system.run(start, 5e-7, 2e-3, every=20)
    time, states = integrate(system, start, 5e-7, 2e-3, every=20)
    np.testing.assert_allclose(time, run.time, rtol=1e-9)
    velocity = [(system.velocity_rows(np.eye(12)) @ each.T).real for each in (run.state, states)]
    assert abs(velocity[0] - velocity[1]).max() < 1e-3 * abs(velocity[0]).max()


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


@pytest.mark.exact
def test_roots_may_be_replaced_and_high_modes_damped(moving):
    modes = moving[1].modes
    pairs = np.flatnonzero(modes.oscillating)
    shifted = modes.root[pairs[:3]] * (1 + 1e-4j)
    replaced = modes.with_roots(shifted)
    np.testing.assert_array_equal(replaced.root[pairs[:3]], shifted)
    np.testing.assert_array_equal(np.delete(replaced.root, pairs[:3]), np.delete(modes.root, pairs[:3]))
    with pytest.raises(ConvergenceError, match="no|none"):
        modes.with_roots(np.array([1.5 * abs(modes.root).max() * 1j]))
    limit = abs(modes.root[pairs[3]]) / (2 * np.pi)
    damped = modes.damped_above(limit, 0.3).root
    high = modes.oscillating & (abs(modes.root) > 2 * np.pi * limit)
    assert (-damped[high].real >= 0.3 * abs(damped[high]) * (1 - 1e-12)).all()
    np.testing.assert_array_equal(damped[~high], modes.root[~high])


def test_a_constant_coefficient_needs_no_table():
    _, system = sliding(random_model(), friction=constant(0.3))
    assert np.isfinite(system.rate(system.reach.astype(complex))).all()
