"""One exponential step: exact for forces that are linear over it."""

import numpy as np
import pytest
import scipy

from pipeline.physics.sliding_motion.exponential_step import multiply, spread, step_kernel

ROOT, STEP = np.array([-3.0 + 400j, 20 - 2500j, -8e3 + 0j, -50 + 9e4j]), 2e-5


@pytest.mark.exact
def test_a_step_is_exact_under_a_force_that_is_linear_over_it():
    begin, slope = np.array([1.0, -2.0, 0.5, 3.0]), np.array([4e4, 1e4, -2e4, 5e4])
    kernel = step_kernel(ROOT, np.zeros((4, 8)), np.zeros((3, 8)), STEP)
    decay, first, last = (part[0] + 1j * part[1] for part in (kernel.decay, kernel.begin, kernel.end))
    stepped = decay * (0.3 + 0.1j) + first * begin + last * (begin + slope * STEP)
    for k, root in enumerate(ROOT):
        system = np.array([[root, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
        grown = scipy.linalg.expm(STEP * system) @ np.array([0.3 + 0.1j, begin[k], slope[k]])
        assert stepped[k] == pytest.approx(grown[0], rel=1e-9)


@pytest.mark.exact
def test_the_response_is_the_motion_by_forces_at_the_end_alone():
    rng = np.random.default_rng(2)
    motion, force = rng.standard_normal((8, 8)), rng.standard_normal((6, 8))
    kernel, given = step_kernel(ROOT, motion, force, STEP), rng.standard_normal(6)
    modal = given @ force
    state = (kernel.end[0] + 1j * kernel.end[1]) * (modal[:4] + 1j * modal[4:])
    np.testing.assert_allclose(kernel.response @ given, motion @ np.concatenate((state.real, state.imag)), rtol=1e-10)
    np.testing.assert_array_equal(kernel.own[1], kernel.response.reshape(4, 2, 3, 2)[:, 1, :, 1])


def test_products_with_rows_add_and_fill():
    matrix, values = np.arange(6.0).reshape(2, 3), np.array([1.0, 2.0, 3.0])
    added, filled = np.ones(2), np.full(3, 7.0)
    multiply(matrix, values, added)
    spread(matrix, np.array([1.0, -1.0]), filled)
    np.testing.assert_array_equal(added, 1 + matrix @ values)
    np.testing.assert_array_equal(filled, [-3.0, -3.0, -3.0])
