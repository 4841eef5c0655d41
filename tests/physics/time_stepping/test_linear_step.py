"""Histories, forces on pairs of states and their energies, against plain NumPy."""

import numpy as np
import pytest

from pipeline.physics.time_stepping.linear_step import (
    HistoryKernel,
    add_forces,
    advance,
    interpolate,
    loss_rate,
    project_rows,
    stored_energy,
)


@pytest.mark.exact
def test_histories_are_linear_between_samples_and_constant_beyond():
    history = HistoryKernel(np.array([[0.0, 1.0], [2.0, 1.0], [-2.0, 4.0]]), 0.5, np.zeros(2, bool))
    values = np.zeros(2)
    for time, exact in ((0.0, (0, 1)), (0.25, (1, 1)), (0.75, (0, 2.5)), (1.0, (-2, 4)), (7.0, (-2, 4))):
        interpolate(history, time, values)
        np.testing.assert_allclose(values, exact, atol=1e-15)


@pytest.fixture
def random():
    return np.random.default_rng(5)


@pytest.mark.exact
def test_a_step_and_its_forces_are_sums_over_the_pairs(random):
    step, steady, begin, end = (random.standard_normal(shape) for shape in ((2, 2, 7), (2, 7), (2, 7), (2, 7)))
    advance(step, steady, begin, end)
    np.testing.assert_allclose(end, np.einsum("xyb,yb->xb", step, begin) + steady, rtol=1e-13, atol=1e-13)
    columns, factors = random.standard_normal((3, 2, 7)), np.array([2.0, 0.0, -1.0])
    pushed = end.copy()
    add_forces(columns, factors, pushed)
    np.testing.assert_allclose(pushed, end + np.einsum("k,kxb->xb", factors, columns), rtol=1e-13, atol=1e-13)
    values = np.empty(3)
    project_rows(columns, begin, values)
    np.testing.assert_allclose(values, np.einsum("kxb,xb->k", columns, begin), rtol=1e-13, atol=1e-13)


@pytest.mark.exact
def test_energies_of_modes_and_of_coupled_pairs_agree(random):
    omega_squared, damping, pairs, none = random.uniform(1, 2, 4), random.uniform(0, 1, 4), random.standard_normal(
        (2, 4)), np.empty((0, 0))
    energy = np.diag(np.concatenate((omega_squared, np.ones(4)))) / 2
    power = np.diag(np.concatenate((np.zeros(4), damping)))
    assert stored_energy(energy, omega_squared, pairs) == pytest.approx(stored_energy(none, omega_squared, pairs))
    assert loss_rate(power, damping, pairs) == pytest.approx(loss_rate(none, damping, pairs))
    assert loss_rate(none, damping, pairs) == pytest.approx(damping @ pairs[1] ** 2)
