"""Products and factors for single vectors against those of numpy."""

import numpy as np
import pytest
import scipy

from pipeline.physics.numerics.dense_factor import DenseFactor, product

RNG = np.random.default_rng(3)
REAL = RNG.normal(size=(40, 40))
VECTOR = RNG.normal(size=40) + 1j * RNG.normal(size=40)


@pytest.mark.parametrize("matrix", [REAL, REAL + 1j * REAL.T, scipy.sparse.csr_matrix(REAL * (REAL > 1))])
@pytest.mark.parametrize("vector", [VECTOR, VECTOR.real])
def test_product_is_that_of_numpy(matrix, vector):
    np.testing.assert_allclose(product(matrix, vector), matrix @ vector, rtol=0, atol=1e-13)


@pytest.mark.parametrize("adjoint", [False, True])
def test_factor_solves_with_row_exchanges(adjoint):
    matrix = REAL + 1j * REAL.T
    acting = matrix.conj().T if adjoint else matrix
    x = DenseFactor(matrix).solve(VECTOR, adjoint)
    np.testing.assert_allclose(acting @ x, VECTOR, rtol=0, atol=1e-11)
