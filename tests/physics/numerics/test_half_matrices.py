"""Products by one half of a matrix are those of all of it."""

import numpy as np
import pytest
import scipy

from pipeline.physics.numerics.half_matrices import Half

SIZE = 23


def matrix(kind, random):
    """(sparse (n, n), sign of its transpose)."""
    half = scipy.sparse.random(SIZE, SIZE, 0.2, random_state=random, format="csr")
    if kind == "skew":
        return half - half.T, -1
    if kind == "complex":
        half = half + 1j * scipy.sparse.random(SIZE, SIZE, 0.2, random_state=random, format="csr")
    return half + half.T, 1


@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("kind", ["real", "complex", "skew"])
def test_images_are_those_of_the_dense_matrix_and_of_its_adjoint(kind, count):
    random = np.random.default_rng(4)
    sparse, sign = matrix(kind, random)
    vectors = random.standard_normal((SIZE, count)) + 1j * random.standard_normal((SIZE, count))
    image, adjoint = Half(sparse, sign).images(vectors)
    dense = sparse.toarray()
    assert np.allclose(image, dense @ vectors, rtol=0, atol=1e-13)
    assert np.allclose(adjoint, dense.conj().T @ vectors, rtol=0, atol=1e-13)


def test_a_matrix_without_entries_takes_all_to_zero():
    image, adjoint = Half(scipy.sparse.csr_matrix((SIZE, SIZE))).images(np.ones((SIZE, 3), complex))
    assert image.shape == (SIZE, 3) and not image.any() and not adjoint.any()
