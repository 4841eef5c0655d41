"""What elements and moving surfaces add to a time step."""

import numpy as np
import pytest

from pipeline.physics.time_stepping.coupled_solver import (
    advance_wear,
    angle_after,
    element_work,
    no_memory,
    recede,
    shift_work,
    surface_shift,
)
from pipeline.physics.time_stepping.elements import Element, Maxwell, Polynomial, alone


@pytest.mark.exact
def test_waves_under_one_contact_add_up():
    shift = np.ones((2, 3))
    waves = np.array([[1, 0.2, 1.0, 0.0, 0.0, 0], [1, 0.1, 2.0, 0.0, 0.5, 0], [0, 0.3, 0.0, 4.0, 0.0, 0]])
    surface_shift(waves, (0.05, 0.7, 3.0), shift)
    assert shift[0] == pytest.approx([0.3 * np.cos(0.4 * np.pi), 0.2 * np.cos(0.7) + 0.1 * np.cos(0.9), 0.0])
    assert shift[1, 1] == pytest.approx(-0.6 * np.sin(0.7) - 0.6 * np.sin(0.9))


@pytest.mark.exact
def test_waves_come_up_with_time():
    shift, growing = np.zeros((2, 1)), np.array([[0, 0.2, 1.0, 0.0, 0.0, 0.5]])
    surface_shift(growing, (0.3, 0.7, 3.0), shift)
    assert shift[0] == pytest.approx(0.2 * (1 - np.exp(-0.6)) * np.cos(0.7))
    earlier, later, h = np.zeros((2, 1)), np.zeros((2, 1)), 1e-4
    surface_shift(growing, (0.3 - h, 0.7 - 3 * h, 3.0), earlier)
    surface_shift(growing, (0.3 + h, 0.7 + 3 * h, 3.0), later)
    assert shift[1] == pytest.approx((later[0] - earlier[0]) / (2 * h), rel=1e-5)


@pytest.mark.exact
def test_wear_over_a_step_is_the_mean_of_its_ends():
    worn, pace, shift = np.array([1e-3, 0.0]), np.array([2e-2, 0.0]), np.zeros((2, 2))
    recede(worn, pace, 0.1, shift)
    np.testing.assert_allclose(shift, [[3e-3, 0.0], [2e-2, 0.0]])
    advance_wear(np.array([1e-3, 5e-3]), np.array([20.0, 10.0]), np.full(2, -1.0), np.array([1.0, -1.0]), 0.1, worn,
                 pace)
    np.testing.assert_allclose(pace, [4e-2, 0.0])
    np.testing.assert_allclose(worn, [1e-3 + 3e-3, 0.0])


def test_branches_remember_when_they_were_relaxed():
    branches = Element("pad", np.ones(1), Maxwell(np.ones(2), np.ones(2)))
    kernel = alone((branches, Element("spring", np.ones(1), Polynomial()), branches))
    np.testing.assert_array_equal(no_memory(kernel, 3.0), [0, 0, 3.0, 0, 0, 3.0])


@pytest.mark.exact
def test_books_of_a_step():
    work = element_work(np.array([1.0, 2.0]), np.array([1.5, 1.0]), np.array([2.0, 4.0]), np.array([4.0, 6.0]))
    assert work == pytest.approx(-0.5 * 3 + 5.0)
    held, force = np.array([[2.0], [0.0]]), np.array([[6.0], [0.0]])
    assert shift_work(np.zeros(1), np.array([0.1]), held, force, True) == pytest.approx(0.6)
    assert shift_work(np.zeros(1), np.array([0.1]), held, force, False) == pytest.approx(0.4)
    assert angle_after(1.0, 2.0, 4.0, 0.5) == pytest.approx(2.5)
