"""Newmark's rule in numba: closed forms, order two, agreement with DOP853, refusal."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.pads.newmark import integrate
from pipeline.physics.pads.pad_system import force
from pipeline.physics.pads.sliding_pads import static_start
from tests.physics.small_pads import block_on_belt, random_assembly


def damped_block(time, mass=2.0, spring=1e5, damping=30.0, push=20.0):
    """Motion of a damped oscillator that a constant push acts on from rest."""
    decay = damping / (2 * mass)
    pace = np.sqrt(spring / mass - decay**2)
    return push / spring * (1 - np.exp(-decay * time) * (np.cos(pace * time) + decay / pace * np.sin(pace * time)))


def errors_of(steps):
    system = block_on_belt(damping=30.0, friction=0.4, load=50.0)
    start = static_start(system)
    errors = []
    for step in steps:
        time, moved, _ = integrate(system, start, step, round(0.05 / step))
        errors.append(np.abs(moved[:, 0] - damped_block(time)).max())
    return np.array(errors)


@pytest.mark.exact
def test_a_block_under_friction_moves_as_the_closed_form_with_order_two():
    errors = errors_of([2e-4, 1e-4, 5e-5])
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2, atol=0.05)
    assert errors[-1] < 5e-4 * 20.0 / 1e5


@pytest.mark.exact
def test_without_damping_the_energy_stays():
    system = block_on_belt(load=50.0, friction=0.0, spring=1e5)
    start = static_start(system) + [1e-4, 0.0]
    _, moved, velocity = integrate(system, start, 1e-4, 2000)
    energy = 0.5 * 2.0 * velocity[:, 0] ** 2 + 0.5 * 1e5 * moved[:, 0] ** 2
    np.testing.assert_allclose(energy, energy[0], rtol=1e-8)


@pytest.mark.exact
def test_a_friction_free_start_stays_at_rest():
    system = random_assembly(friction=0.0)
    start = static_start(system)
    _, moved, _ = integrate(system, start, 1e-5, 200)
    assert np.abs(moved - start).max() < 1e-10 * np.abs(system.contact.law.gap).max()


@pytest.mark.exact
def test_the_curved_contact_agrees_with_dop853():
    system, end = random_assembly(), 2e-3
    start = static_start(system)
    size = start.size

    def rate(time, state):
        q, v = state[:size], state[size:]
        return np.concatenate((v, np.linalg.solve(system.mass, force(system, time, q, v))))

    reference = solve_ivp(rate, (0, end), np.concatenate((start, np.zeros(size))), "DOP853", rtol=1e-10, atol=1e-16,
                          max_step=5e-6).y[:size, -1]
    errors = [np.abs(integrate(system, start, step, round(end / step))[1][-1] - reference).max()
              for step in (4e-6, 2e-6, 1e-6)]
    travel = np.abs(reference - start).max()
    assert errors[-1] < 1e-4 * travel
    np.testing.assert_allclose(np.log2(errors[0] / errors[2]), 4, atol=0.4)


def test_every_so_many_steps_are_kept():
    system = random_assembly()
    start = static_start(system)
    time, moved, velocity = integrate(system, start, 1e-5, 12)
    few = integrate(system, start, 1e-5, 12, record_every=4)
    np.testing.assert_array_equal(few[0], time[::4])
    np.testing.assert_array_equal(few[1], moved[::4])
    np.testing.assert_array_equal(few[2], velocity[::4])


def test_a_step_that_does_not_converge_is_refused_with_its_time():
    system = random_assembly()
    with pytest.raises(ConvergenceError, match=r"newmark at t = \de-05 s.*residual"):
        integrate(system, static_start(system), 1e-5, 10, scale=1e-30)
