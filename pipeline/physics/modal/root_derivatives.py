"""Derivatives of a root of (s^2 M + s C + K) x = 0 to what its matrices depend on, by left and right eigenvectors.

With y^H (s^2 M + s C + K) = 0 and matrices that change by dM, dC, dK,

    ds = - y^H (s^2 dM + s dC + dK) x / y^H (2 s M + C) x.

P. Lancaster, Numer. Math. 6 (1964) 377.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.modal.quadratic_eigenproblem import operator

#: inverse iterations for the left vector, and how far the matrix is evaluated beside the root, where it is regular
_INVERSE, _BESIDE = 3, 1 + 1e-9


@dataclass(frozen=True)
class RootWithVectors:
    """A ``root`` 1/s with its ``right`` and ``left`` (n,), scaled so that y^H (2 s M + C) x = 1."""

    root: complex
    right: np.ndarray
    left: np.ndarray

    def change_of(self, order, difference):
        """ds (complex, 1/s) for a ``difference`` (n, n), dense or sparse, of the matrix that stands with s^order."""
        return -complex(self.root**order * (self.left.conj() @ (difference @ self.right)))

    def change(self, difference):
        """ds (complex, 1/s) for the ``difference`` (dM, dC, dK) of the matrices, each (n, n)."""
        return sum(self.change_of(order, each) for order, each in zip((2, 1, 0), difference, strict=True))


def scaled(matrices, root, right, left):
    """RootWithVectors of the ``matrices`` (M, C, K), dense or sparse, for vectors (n,) of any length."""
    mass, damping, _ = matrices
    slope = 2 * root * (mass @ right) + damping @ right
    return RootWithVectors(root, right, left / (left.conj() @ slope).conj())


def with_vectors(matrices, root, right, beside=None):
    """RootWithVectors of the ``matrices`` (M, C, K), with a Settling ``beside`` them or None, for a root and its right
    vector (n,); y^H T'(s) x is scaled to 1."""
    factor = scipy.linalg.lu_factor(operator(*matrices, root * _BESIDE, beside)[0], check_finite=False)
    slope = operator(*matrices, root, beside, right)[1]
    left = slope.conj()
    for _ in range(_INVERSE):
        left = scipy.linalg.lu_solve(factor, left, trans=2, check_finite=False)
        left = left / np.linalg.norm(left)
    return RootWithVectors(root, right, left / (left.conj() @ slope).conj())
