"""Derivatives of roots against closed forms and differences of the roots themselves."""

import numpy as np
import pytest

from pipeline.physics.modal.quadratic_eigenproblem import polished, quadratic_modes
from pipeline.physics.modal.root_derivatives import with_vectors


@pytest.mark.exact
def test_one_mass_on_a_damped_spring():
    """s = -c/2m + i sqrt(k/m - (c/2m)^2): its derivatives to m, c and k."""
    m, c, k = 2.0, 3.0, 800.0
    decay, square = c / (2 * m), k / m - (c / (2 * m)) ** 2
    root = -decay + 1j * np.sqrt(square)
    found = with_vectors([np.array([[v]]) for v in (m, c, k)], root, np.ones(1, complex))
    one, none = np.ones((1, 1)), np.zeros((1, 1))
    assert found.change((none, none, one)) == pytest.approx(1j / (2 * m * np.sqrt(square)), rel=1e-9)
    by_damping = -1 / (2 * m) - 1j * c / (4 * m**2 * np.sqrt(square))
    assert found.change((none, one, none)) == pytest.approx(by_damping, rel=1e-9)
    assert found.change((one, none, none)) == pytest.approx(root * -root / (2 * root * m + c), rel=1e-9)


def test_unsymmetric_matrices_against_differences():
    """Every entry of M, C and K, of a system with circulatory and gyroscopic terms and complex stiffness."""
    rng, n = np.random.default_rng(2), 4
    mass = np.eye(n) + 0.1 * rng.standard_normal((n, n))
    damping = 0.5 * rng.standard_normal((n, n))
    stiffness = np.diag([50.0, 60, 90, 200]) + 5 * rng.standard_normal((n, n)) * (1 + 0.02j)
    modes = quadratic_modes(mass, damping, stiffness.real)
    chosen = int(np.argmax(modes.value.real))
    root, right = polished(mass, damping, stiffness, modes.value[chosen], modes.right[:, chosen])
    found = with_vectors((mass, damping, stiffness), root, right)
    for which in range(3):
        for entry in np.ndindex(n, n):
            step = np.zeros((3, n, n))
            step[(which, *entry)] = 1e-5
            ends = [polished(*(a + side * b for a, b in zip((mass, damping, stiffness), step, strict=True)), root,
                             right)[0] for side in (-1, 1)]
            assert found.change(step) == pytest.approx((ends[1] - ends[0]) / 2, rel=1e-4, abs=1e-10)
