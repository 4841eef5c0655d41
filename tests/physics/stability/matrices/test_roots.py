"""Roots by shifts that overlap: none missed beside a dense solver, residuals, left vectors."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.stability.matrices import roots as solver_of_roots
from pipeline.physics.stability.matrices.roots import STRIP, strip_modes, with_left

TWO_PI = 2.0 * np.pi


def system(random, size):
    """A chain of masses with follower forces and gyroscopic coupling: some of its modes grow."""
    mass = scipy.sparse.diags_array(random.uniform(0.5, 2.0, size))
    joints = scipy.sparse.diags_array([np.full(size, 2.0), np.full(size - 1, -1.0), np.full(size - 1, -1.0)],
                                      offsets=[0, 1, -1])
    follower = scipy.sparse.diags_array([random.uniform(-1, 1, size - 2), random.uniform(-1, 1, size - 2)],
                                        offsets=[2, -2])
    gyro = scipy.sparse.diags_array([np.full(size - 1, 2.0), np.full(size - 1, -2.0)], offsets=[1, -1])
    return tuple(m.tocsr() for m in (mass, 0.5 * joints + gyro, 1e6 * joints + 4e5 * follower))


@pytest.mark.exact
@pytest.mark.parametrize("nearest", [8, 40])
def test_no_root_of_the_strip_is_missed(monkeypatch, nearest):
    """Whether one disc covers the band or many do: the same roots as those of a dense solver."""
    monkeypatch.setattr(solver_of_roots, "_NEAREST", nearest)
    matrices, highest = system(np.random.default_rng(3), 60), 250.0
    found = strip_modes(matrices, highest, "superlu")
    dense = quadratic_roots(*(m.toarray() for m in matrices))
    inside = dense[(dense.imag > 0) & (dense.imag <= TWO_PI * highest)
                   & (abs(dense.real) <= STRIP * TWO_PI * highest)]
    roots = np.array([mode.root for mode in found.modes])
    assert len(roots) == len(inside) > 20 and (roots.real > 1).any()
    np.testing.assert_allclose(np.sort_complex(1j * roots), np.sort_complex(1j * inside), rtol=0, atol=1e-6)
    assert len(found.discs) > 1 or nearest == 40
    assert max(mode.residual for mode in found.modes) < 1e-8


def test_left_vectors_annul_the_equation_from_the_left():
    mass, damping, stiffness = matrices = system(np.random.default_rng(4), 30)
    grows = max(strip_modes(matrices, 200.0, "superlu").modes, key=lambda m: m.root.real)
    mode = with_left(grows, matrices, "superlu")
    operator = mode.root**2 * mass + mode.root * damping + stiffness
    assert abs(mode.left.conj() @ operator).max() < 1e-6 * abs(stiffness).max()
    assert mode.root == pytest.approx(grows.root, rel=1e-9)


def test_what_is_no_mode_is_refused():
    matrices = system(np.random.default_rng(5), 30)
    mode = strip_modes(matrices, 100.0, "superlu").modes[0]
    with pytest.raises(ConvergenceError, match="residuals below"):
        with_left(solver_of_roots.Mode(mode.root * 1.01, mode.right, None, 0.0),
                  (matrices[0], matrices[1], matrices[2] * 0.9), "superlu")


@pytest.mark.exact
def test_loss_factors_are_an_imaginary_stiffness():
    """s = i sqrt(k (1 + i eta) / m) for each of the masses, whose left vectors are their right ones."""
    loss, stiffness = np.array([0.01, 0.02, 0.05, 0.03]), np.array([1e6, 2e6, 3e6, 4e6])
    matrices = (scipy.sparse.eye_array(4, format="csr"), scipy.sparse.csr_array((4, 4)),
                scipy.sparse.csr_array(np.diag(stiffness * (1 + 1j * loss))))
    found = strip_modes(matrices, 400.0, "superlu").modes
    np.testing.assert_allclose([mode.root for mode in found], 1j * np.sqrt(stiffness * (1 + 1j * loss)), rtol=1e-10)
    mode = with_left(found[2], matrices, "superlu")
    assert mode.root == pytest.approx(found[2].root, rel=1e-10)
    assert abs(np.vdot(mode.left, mode.right)) == pytest.approx(1.0)


@pytest.mark.exact
@pytest.mark.parametrize("tied", [False, True])
def test_few_roots_are_found_at_once(tied):
    """One mass alone, or two that a multiplier without mass holds together."""
    mass, damping, stiffness = 2.0, 3.0, 8e6
    matrices = [np.array([[value]]) for value in (mass, damping, stiffness)]
    if tied:
        matrices = [np.pad(np.diag([value / 4, value * 3 / 4]), (0, 1)) for value in (mass, damping, stiffness)]
        matrices[2][2, :2] = matrices[2][:2, 2] = 1e6, -1e6
    found = strip_modes(tuple(map(scipy.sparse.csr_matrix, matrices)), 400.0, "superlu")
    np.testing.assert_allclose(found.roots, [(-damping + 1j * np.sqrt(4 * mass * stiffness - damping**2)) / (2 * mass)],
                               rtol=1e-10)
    assert np.isinf(found.discs[:, 1]).all()
