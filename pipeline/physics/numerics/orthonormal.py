"""Orthonormal vectors that a search space of complex motions grows by."""

import numpy as np


def within(vectors, others):
    """V^H W (m, g): the few ``others`` W (n, g) are made conjugate, not the ``vectors`` V (n, m)."""
    return (others.conj().T @ vectors).conj().T


def orthonormal_beside(basis, vectors, least):
    """Orthonormal (n, h) for what ``vectors`` (n, g), none of them zero, add to the orthonormal ``basis`` (n, m).

    What is left of a vector, as a share of its length, counts as nothing up to ``least``; so do lengths up to it.
    """
    for _ in range(2):
        size = np.linalg.norm(vectors, axis=0)
        vectors = vectors[:, size > least] / size[size > least]
        vectors = vectors - basis @ within(basis, vectors)
    direction, size, _ = np.linalg.svd(vectors, full_matrices=False)
    return direction[:, size > least]
