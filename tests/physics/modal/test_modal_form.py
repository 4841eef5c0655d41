"""A linear system in its complex modes against closed forms and against its matrix exponential."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.modal_form import modal_form


@pytest.mark.exact
def test_a_damped_oscillator_under_a_held_force():
    """q = u/k (1 - exp(-d t) (cos w t + d/w sin w t)), its velocity, its acceleration; any length of the steps."""
    mass, damping, stiffness, force = 2.0, 3.0, 800.0, np.array([5.0])
    form = modal_form((np.array([[mass]]), np.array([[damping]]), np.array([[stiffness]])), np.ones((1, 1)),
                      np.ones((1, 1)))
    decay = damping / mass / 2
    omega = np.sqrt(stiffness / mass - decay**2)
    state, time = np.zeros(1, complex), 0.0
    assert form.motion(state, force)[2] == pytest.approx(force / mass)
    for length in (0.01, 0.2, 0.001, 1.3):
        state, time = form.step(state, force, length), time + length
        faded = np.exp(-decay * time)
        place, velocity, acceleration = form.motion(state, force)
        expected = force / stiffness * (1 - faded * (np.cos(omega * time) + decay / omega * np.sin(omega * time)))
        rate = force / mass * faded * np.sin(omega * time) / omega
        assert place == pytest.approx(expected, rel=1e-12) and velocity == pytest.approx(rate, rel=1e-11)
        assert acceleration == pytest.approx((force - damping * rate - stiffness * expected) / mass, rel=1e-11)


@pytest.mark.exact
def test_unsymmetric_systems_with_real_roots_follow_their_matrix_exponential():
    random = np.random.default_rng(5)
    square = [random.standard_normal((6, 6)) for _ in range(3)]
    mass, damping = square[0] @ square[0].T + 6 * np.eye(6), 4 * square[1] @ square[1].T
    stiffness = 50 * square[2]
    inputs, outputs = random.standard_normal((2, 6)), random.standard_normal((3, 6))
    form = modal_form((mass, damping, stiffness), inputs, outputs)
    assert (form.root.imag == 0).any() and (form.root.real > 0).any() and len(form.root) < 12
    whole = np.zeros((14, 14))
    whole[:6, 6:12] = np.eye(6)
    whole[6:12, :6], whole[6:12, 6:12] = -np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)
    whole[6:12, 12:] = np.linalg.solve(mass, inputs.T)
    state, expected = np.zeros(len(form.root), complex), np.zeros(14)
    for force, length in (([1.0, 0.0], 0.3), ([-2.0, 4.0], 0.7)):
        expected[12:] = force
        state, expected = form.step(state, np.array(force), length), scipy.linalg.expm(length * whole) @ expected
        place, velocity, acceleration = form.motion(state, np.array(force))
        np.testing.assert_allclose(place, outputs @ expected[:6], rtol=1e-9)
        np.testing.assert_allclose(velocity, outputs @ expected[6:12], rtol=1e-9)
        np.testing.assert_allclose(acceleration, outputs @ (whole @ expected)[6:12], rtol=1e-9)


def test_a_mass_that_nothing_holds_has_no_modal_form():
    """s = 0 twice with one vector: a Jordan block."""
    with pytest.raises(ConvergenceError, match="complex modes that span the motion"):
        modal_form((np.eye(1), np.zeros((1, 1)), np.zeros((1, 1))), np.ones((1, 1)), np.ones((1, 1)))


@pytest.mark.exact
def test_a_mass_on_a_damper_alone():
    """s = 0 and s = -c/m: q = u t / c - u m / c^2 (1 - exp(-c t / m))."""
    form = modal_form((np.eye(1), 2 * np.eye(1), np.zeros((1, 1))), np.ones((1, 1)), np.ones((1, 1)))
    place = form.motion(form.step(np.zeros(len(form.root), complex), np.ones(1), 1.5), np.ones(1))[0]
    assert place == pytest.approx(1.5 / 2 - (1 - np.exp(-3.0)) / 4, rel=1e-12)
