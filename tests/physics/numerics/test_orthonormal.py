"""What vectors add to an orthonormal basis, and nothing twice."""

import numpy as np
import pytest

from pipeline.physics.numerics.orthonormal import orthonormal_beside, within

RNG = np.random.default_rng(4)
BASIS = np.linalg.qr(RNG.normal(size=(30, 4)) + 1j * RNG.normal(size=(30, 4)))[0]
VECTORS = RNG.normal(size=(30, 3)) + 1j * RNG.normal(size=(30, 3))


def test_the_products_are_those_of_numpy():
    np.testing.assert_allclose(within(BASIS, VECTORS), BASIS.conj().T @ VECTORS, atol=1e-14)


@pytest.mark.exact
def test_what_is_there_adds_nothing_and_what_stands_twice_adds_once():
    given = np.hstack((VECTORS, VECTORS[:, :1] * 1j, BASIS @ RNG.normal(size=(4, 2))))
    new = orthonormal_beside(BASIS, given, 1e-10)
    assert new.shape == (30, 3)
    whole = np.hstack((BASIS, new))
    np.testing.assert_allclose(within(whole, whole), np.eye(7), atol=1e-13)
    np.testing.assert_allclose(whole @ within(whole, given), given, atol=1e-12)


def test_nothing_new_is_no_vector():
    assert orthonormal_beside(BASIS, BASIS[:, :2], 1e-10).shape == (30, 0)
