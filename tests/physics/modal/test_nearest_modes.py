"""The modes nearest to a target are those of the whole problem, with complex stiffness and states that settle."""

import numpy as np
import pytest

from pipeline.physics.modal.nearest_modes import modes_near
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes
from pipeline.physics.stability.linearisation import Settling

pytestmark = pytest.mark.exact


def random_system(n, states=0):
    random = np.random.default_rng(3)
    root = random.standard_normal((n, n))
    mass = root @ root.T / n + np.eye(n)
    stiffness = np.diag(np.linspace(1, 4, n) ** 2) * 1e4 + 300 * random.standard_normal((n, n))
    damping = 0.5 * random.standard_normal((n, n))
    beside = Settling(random.standard_normal((n, states)), 50 * random.standard_normal((states, n)),
                      random.standard_normal((states, n)), np.linspace(20, 90, states)) if states else None
    return mass, damping, stiffness, beside


def residual(mass, damping, stiffness, s, x, beside):
    rest = s**2 * mass @ x + s * damping @ x + stiffness @ x
    if beside is not None:
        rest = rest - beside.push @ ((beside.by_place @ x + s * beside.by_speed @ x) / (s + beside.decay))
    return np.linalg.norm(rest) / np.linalg.norm(stiffness @ x)


@pytest.mark.parametrize("n", [12, 90], ids=["small, solved whole", "large, by shift and invert"])
@pytest.mark.parametrize("states", [0, 5])
def test_roots_are_the_nearest_of_all(n, states):
    *matrices, beside = random_system(n, states)
    target = 1.7e2j + 0.3
    roots, shapes = modes_near(*matrices, target, 6, beside)
    every = quadratic_modes(*matrices, beside=beside).value
    nearest = every[np.argsort(abs(every - target))[:6]]
    np.testing.assert_allclose(roots, nearest, rtol=1e-8)
    np.testing.assert_allclose([(x.conj() @ matrices[0] @ x).real for x in shapes.T], 1.0)
    assert max(residual(*matrices, s, x, beside) for s, x in zip(roots, shapes.T, strict=True)) < 1e-8


@pytest.mark.parametrize("n", [12, 90])
def test_an_imaginary_stiffness_is_part_of_it(n):
    """With one loss factor and no damping s^2 = (1 + i eta) s0^2, the vectors unchanged."""
    mass, _, stiffness, _ = random_system(n)
    stiffness = (stiffness + stiffness.T) / 2
    still = np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)))
    target = 1j * np.sort(still)[n // 2] * (1 + 1e-3)
    roots, _ = modes_near(mass, 0 * mass, stiffness * (1 + 0.04j), target, 4)
    expected = 1j * still * np.sqrt(1 + 0.04j)
    assert all(abs(expected - root).min() < 1e-8 * abs(root) for root in roots)


def test_fewer_roots_than_asked_for():
    roots, shapes = modes_near(np.eye(1), np.zeros((1, 1)), 4 * np.eye(1), 1.9j, 12)
    np.testing.assert_allclose(roots, [2j, -2j], atol=1e-12)
    assert shapes.shape == (1, 2)
