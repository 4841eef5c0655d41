"""Modes of sparse systems followed from what they are like, beside all modes of the same matrices."""

import numpy as np
import pytest
import scipy

from pipeline.physics.modal.followed_roots import followed_roots
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes, quadratic_pairs
from pipeline.physics.numerics.sparse_solver import factorise

SIZE = 80


def chain(friction=0.3, loss=0.01):
    """(M, C, K) of masses in a chain with an unsymmetric coupling and losses."""
    ones, rng = np.ones(SIZE - 1), np.random.default_rng(3)
    springs = scipy.sparse.diags([2.02 * np.ones(SIZE), -ones, -ones], [0, 1, -1], format="csr")
    turned = scipy.sparse.diags([ones[1:] * friction], [2], shape=(SIZE, SIZE), format="csr") * 0.05
    mass = scipy.sparse.diags(1 + 0.2 * rng.random(SIZE), format="csr")
    return mass, 0.01 * springs + 0.001 * mass, ((1 + 1j * loss) * springs + turned).tocsr()


def followed(matrices, sought, shapes, rows, tolerance=1e-9):
    target = 1j * np.mean(sought.imag) * 1.001
    mass, damping, stiffness = matrices
    factor = factorise(target**2 * mass + target * damping + stiffness, "superlu", symmetric=False, single=True)
    motion = rows @ shapes
    return followed_roots(matrices, lambda b: factor.solve(b).astype(complex), sought, rows.T @ motion, rows, motion,
                          tolerance)


def all_modes(matrices):
    """Roots by rising frequency and their vectors, of all that oscillate."""
    value, right = quadratic_pairs(*(matrix.toarray() for matrix in matrices))
    order = np.argsort(value.imag)[-SIZE:]
    return value[order], right[:, order]


@pytest.mark.exact
def test_neighbouring_modes_of_a_changed_system_are_found_from_those_before():
    rows = scipy.sparse.identity(SIZE, format="csr")[::2]
    root, shape = all_modes(chain(friction=0.0))
    chosen = np.arange(20, 24)
    changed = chain(friction=0.3)
    exact = all_modes(changed)[0]
    made = followed(changed, root[chosen], shape[:, chosen], rows)
    np.testing.assert_allclose(made.root, exact[chosen], rtol=1e-8)
    assert (made.residual <= 1e-9).all() and (made.likeness > 0.9).all()
    mass, damping, stiffness = changed
    for s, x in zip(made.root, made.vector.T, strict=True):
        assert np.linalg.norm((s**2 * mass + s * damping + stiffness) @ x) < 1e-8 * np.linalg.norm(stiffness @ x)


def test_a_mode_that_is_no_more_is_gone_and_leaves_the_others():
    matrices, rows = chain(), scipy.sparse.identity(SIZE, format="csr")
    root, shape = all_modes(matrices)
    nothing = np.zeros((SIZE, 1))
    nothing[::9] = 1.0
    made = followed(matrices, root[[30, 31]], np.hstack((shape[:, [30]], nothing)), rows)
    assert made.root[0] == pytest.approx(root[30], rel=1e-8) and np.isnan(made.root[1])


@pytest.mark.exact
def test_all_pairs_of_real_matrices_are_those_of_quadratic_modes():
    real = [matrix.toarray().real[:12, :12] for matrix in chain(loss=0.0)]
    here, there = np.sort_complex(quadratic_pairs(*real)[0]), np.sort_complex(quadratic_modes(*real).value)
    np.testing.assert_allclose(here[here.imag > 0], there[there.imag > 0], rtol=1e-9)
