"""One exponential step: exact for forces that are linear over it."""

import numpy as np
import pytest
import scipy

from pipeline.physics.sliding_motion.exponential_step import (
    DEPTH,
    EnergyKernel,
    Record,
    _extrapolate,
    _keep_book,
    _nearest,
    _newton,
    add_rows,
    multiply,
    spread,
    step_kernel,
)

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
    error = given @ kernel.response - motion @ np.concatenate((state.real, state.imag))
    rounded = 0.51 * np.finfo(np.float32).eps       # once
    assert (abs(error) <= rounded * (abs(given) @ abs(kernel.response))).all()
    np.testing.assert_array_equal(kernel.own[..., 1].astype(np.float32),
                                  kernel.response.reshape(3, 2, 4, 2)[:, 1, :, 1].T)


@pytest.mark.parametrize("rows", [2, 4, 11])
def test_products_with_rows_add_and_fill(rows):
    """Small integers, so that no order of the sums shows."""
    matrix, values, weights = np.arange(3.0 * rows).reshape(rows, 3), np.array([1.0, 2.0, 3.0]), np.arange(rows) - 1.0
    matrix = matrix.astype(np.float32)
    added, filled, some, which = np.ones(rows), np.full(3, 7.0), np.ones(3), np.arange(rows)[::2].copy()
    multiply(matrix, values, added)
    spread(matrix, weights, filled)
    add_rows(matrix, weights, which, some)
    np.testing.assert_array_equal(added, 1 + matrix @ values)
    np.testing.assert_array_equal(filled, weights @ matrix)
    np.testing.assert_array_equal(some, 1 + weights[which] @ matrix[which])


@pytest.mark.parametrize("row", [0, 1, 2])
def test_forces_are_extrapolated_along_a_line_a_parabola_or_a_cubic(row):
    """Exactly so, newest first; of rows that fit as well the simplest is taken."""
    values, result = (5.0 - np.arange(DEPTH)[:, None]) ** (row + 1) * np.array([1.0, -3.0]), np.empty(2)
    _extrapolate(row, values, result)
    np.testing.assert_allclose(result, 6.0 ** (row + 1) * np.array([1.0, -3.0]), rtol=1e-14)
    assert _nearest(values, result) == row


def test_a_step_of_newtons_method_on_stiff_patches_solves_linear_forces():
    """Two patches with forces linear in the motion, both stiff: one step leaves no error."""
    rng, p = np.random.default_rng(4), 2
    response, slope, trial = rng.standard_normal((3 * p, 4 * p)), rng.standard_normal((3, 4, p)), rng.standard_normal(6)
    own = np.ascontiguousarray(response.reshape(3, p, 4, p)[:, np.arange(p), :, np.arange(p)].transpose(2, 1, 0))

    def error(forces):
        return np.einsum("foi,oi->fi", slope, (forces @ response).reshape(4, p)).ravel() + 1.0 - forces

    change, moved = np.empty(6), np.empty(8)
    _newton(response, own, slope, error(trial), 1e-9, change, moved)
    np.testing.assert_allclose(error(trial + change), 0.0, atol=1e-10)
    np.testing.assert_allclose(moved, change @ response, rtol=1e-12)


def test_patches_that_are_not_stiff_follow_their_error_and_their_own_motion_to_first_order():
    rng, p = np.random.default_rng(4), 2
    response, slope, error = 1e-3 * rng.standard_normal((6, 8)), rng.standard_normal((3, 4, p)), rng.standard_normal(6)
    own = np.ascontiguousarray(response.reshape(3, p, 4, p)[:, np.arange(p), :, np.arange(p)].transpose(2, 1, 0))
    error[1], change, moved = 1e-6, np.empty(6), np.empty(8)
    _newton(response, own, slope, error, 1e-1, change, moved)
    near = np.einsum("foi,ogi,gi->fi", slope, own, error.reshape(3, p)).ravel()
    kept = np.arange(6) != 1
    np.testing.assert_allclose(change[kept], (error + near)[kept], rtol=1e-12)
    assert change[1] == 0.0     # negligible
    np.testing.assert_allclose(moved, change @ response, rtol=1e-12, atol=1e-15)


def test_energies_of_many_states_at_once_are_those_of_one_after_the_other():
    rng, every, last, step = np.random.default_rng(6), 3, 9, 0.5
    seen, work, forms = rng.standard_normal((6, 8)), rng.standard_normal(6), rng.standard_normal((4, 8, 8))
    energy, spent = EnergyKernel(*(form + form.T for form in forms)), np.array([1.0, 2.0, 3.0])
    record = Record(np.empty((3, 8)), np.empty((3, 2)), np.zeros((3, 4)))
    power = np.array([[state @ form @ state for state in seen] for form in (energy.contact, energy.loss, energy.added)])
    power[0] += work
    total = spent[:, None] + np.cumsum(0.5 * step * (power[:, 1:] + power[:, :-1]), axis=1)
    _keep_book(energy, step, last, every, seen, work, record, spent)      # steps 5 to 9
    np.testing.assert_allclose(spent, total[:, -1], rtol=1e-12)
    np.testing.assert_allclose(record.energy[1:, :3], total[:, [1, 4]].T, rtol=1e-12)
    np.testing.assert_allclose(record.energy[1:, 3], [seen[k] @ energy.stored @ seen[k] for k in (2, 5)], rtol=1e-12)
    np.testing.assert_array_equal(record.energy[0], 0.0)
