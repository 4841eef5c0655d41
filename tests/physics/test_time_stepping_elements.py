"""What elements and moving surfaces add to a time step."""

import numpy as np
import pytest

from pipeline.physics.time_stepping_elements import middle_angle, settle_element_books, shift_work, surface_shift


@pytest.mark.exact
def test_waves_under_one_contact_add_up():
    shift = np.ones((2, 3))
    waves = np.array([[1, 0.2, 1.0, 0.0, 0.0], [1, 0.1, 2.0, 0.0, 0.5], [0, 0.3, 0.0, 4.0, 0.0]])
    surface_shift(waves, (0.05, 0.7, 3.0), shift)
    assert shift[0] == pytest.approx([0.3 * np.cos(0.4 * np.pi), 0.2 * np.cos(0.7) + 0.1 * np.cos(0.9), 0.0])
    assert shift[1, 1] == pytest.approx(-0.6 * np.sin(0.7) - 0.6 * np.sin(0.9))


@pytest.mark.exact
def test_books_of_a_step():
    assert settle_element_books(np.array([1.0, 2.0]), np.array([1.5, 1.0]), np.array([2.0, 4.0]),
                                np.array([4.0, 6.0])) == pytest.approx(-0.5 * 3 + 5.0)
    held, force = np.array([[2.0], [0.0]]), np.array([[6.0], [0.0]])
    assert shift_work(np.zeros(1), np.array([0.1]), held, force, True) == pytest.approx(0.6)
    assert shift_work(np.zeros(1), np.array([0.1]), held, force, False) == pytest.approx(0.4)
    assert middle_angle(1.0, 2.0, 4.0, 0.5) == pytest.approx(2.5)
