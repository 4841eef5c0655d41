"""Compiled products beside those of numpy."""

import numpy as np
import pytest

from pipeline.physics.sliding_motion.compiled_products import add_rows, multiply, spread, times

MATRIX = np.random.default_rng(2).normal(size=(11, 7)).astype(np.float32)


@pytest.mark.exact
def test_products_with_columns_and_rows():
    along, across, result = np.arange(7.0), np.arange(11.0), np.ones(11)
    multiply(MATRIX, along, result)
    np.testing.assert_allclose(result, 1 + MATRIX.astype(float) @ along, rtol=1e-12)
    result = np.ones(7)
    spread(MATRIX, across, result)
    np.testing.assert_allclose(result, across @ MATRIX.astype(float), rtol=1e-12)
    add_rows(MATRIX, across, np.array([1, 4, 10]), result)
    expected = across @ MATRIX.astype(float) + across[[1, 4, 10]] @ MATRIX[[1, 4, 10]].astype(float)
    np.testing.assert_allclose(result, expected, rtol=1e-12)


@pytest.mark.exact
def test_products_of_complex_numbers_in_halves():
    factor, values, result = np.array([[2.0, 3.0], [-1.0, 0.5]]), np.array([1.0, 2.0, 3.0, 4.0]), np.zeros(4)
    times(factor, values, result)
    expected = (factor[0] + 1j * factor[1]) * (values[:2] + 1j * values[2:])
    np.testing.assert_allclose(result, np.concatenate((expected.real, expected.imag)))
