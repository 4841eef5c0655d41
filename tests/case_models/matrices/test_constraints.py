"""Degrees of freedom that penalties hold: found whatever the penalty, no others."""

import numpy as np
import pytest
import scipy

from pipeline.case_models.matrices.constraints import empty, held

CHAIN = 1e7 * (2 * np.eye(6) - np.eye(6, k=1) - np.eye(6, k=-1))
MASS = np.full(6, 1e-3)


def found(stiffness, mass=MASS):
    return held(abs(scipy.sparse.csr_matrix(stiffness)), mass).tolist()


@pytest.mark.parametrize("penalty", [1e20, 1e30, 1e36])
@pytest.mark.parametrize("at", [[5], [0, 3], [0, 1, 2, 4, 5]])
@pytest.mark.parametrize("coupled", [True, False])
def test_every_penalty_is_found(penalty, at, coupled):
    """Added to the stiffness or in its place, with mass or without."""
    stiffness = CHAIN.copy()
    if not coupled:
        stiffness[at], stiffness[:, at] = 0, 0
    stiffness[at, at] += penalty
    mass = MASS.copy()
    assert found(stiffness, mass) == at
    mass[at] = 0
    assert found(stiffness, mass) == at


def test_penalties_of_two_sizes():
    assert found(CHAIN + np.diag([0, 1e30, 0, 0, 1e36, 0])) == [1, 4]


@pytest.mark.parametrize("stiffness, mass", [
    (CHAIN, MASS), (np.diag([1.0, 1e9, 1e10, 1e12, 1.0, 1.0]), np.ones(6)),                     # apart, of one's own
    (CHAIN + 1e15 * np.outer(np.eye(6)[0] - np.eye(6)[1], np.eye(6)[0] - np.eye(6)[1]), MASS),  # a stiff link
    (np.full((6, 6), 1e36) * np.eye(6), MASS), (0 * CHAIN, MASS)])
def test_what_moves_is_kept(stiffness, mass):
    assert found(stiffness, mass) == []


@pytest.mark.exact
def test_taking_them_out_leaves_the_roots():
    """Beside the exact condensation of the smallest penalty: relative change of the frequencies below 1e-8."""
    penalty = np.diag([0, 0, 0, 0, 0, 2e15])
    whole = scipy.linalg.eigh(CHAIN + penalty, np.diag(MASS), eigvals_only=True)
    kept = np.setdiff1d(np.arange(6), found(CHAIN + penalty))
    assert len(kept) == 5
    np.testing.assert_allclose(scipy.linalg.eigh(CHAIN[np.ix_(kept, kept)], np.diag(MASS[kept]), eigvals_only=True),
                               whole[:5], rtol=2e-8)


def test_rows_without_entries_are_found():
    coupling = scipy.sparse.csr_matrix(([1.0, 0.0], ([3, 2], [0, 2])), (4, 4))
    mass = scipy.sparse.csr_matrix(np.diag([1.0, 1.0, 0, 0]))
    assert empty([mass, coupling], []).tolist() == [2]
    assert empty([mass, coupling], np.array([0])).tolist() == [2, 3]
