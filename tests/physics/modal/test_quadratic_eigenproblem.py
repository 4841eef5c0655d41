"""Dense complex modes: oscillator, rotor, left and right vectors, paths of roots."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.closed_form.two_mode_flutter import onset_friction, roots_over_friction
from pipeline.physics.modal.quadratic_eigenproblem import (
    by_frequency,
    follow_roots,
    polished,
    quadratic_modes,
    quadratic_roots,
    upper_half,
    vectors_of,
)
from pipeline.physics.stability.linearisation import Settling


def random_system(n, seed=0):
    random = np.random.default_rng(seed)
    root = random.standard_normal((n, n))
    return root @ root.T + n * np.eye(n), random.standard_normal((n, n)), n * random.standard_normal((n, n))


def by_height(roots):
    """Sorted by imaginary part, then real part; the digits that rounding may change do not count."""
    return roots[np.lexsort((roots.real, roots.imag.round(6)))]


def vectors_match(matrices, roots, vectors, beside=None):
    mass, damping, stiffness = matrices
    assert len(roots) == vectors.shape[1]
    for s, x in zip(roots, vectors.T, strict=True):
        forces = s**2 * mass @ x + s * damping @ x + stiffness @ x
        if beside is not None:
            forces -= beside.push @ ((beside.by_place + s * beside.by_speed) @ x / (s + beside.decay))
        assert np.linalg.norm(forces) < 1e-9 * np.linalg.norm(stiffness @ x)
        assert (x.conj() @ mass @ x).real == pytest.approx(1.0)


@pytest.mark.exact
@pytest.mark.parametrize("settles", [False, True])
def test_vectors_of_known_roots(settles):
    random, matrices = np.random.default_rng(5), random_system(30)
    beside = Settling(*(random.standard_normal(shape) for shape in ((30, 2), (2, 30), (2, 30))), np.array([1.0, 3.0]))
    beside = beside if settles else None
    every = quadratic_roots(*matrices, beside)
    chosen = every[[40, 55, 58]]
    vectors_match(matrices, chosen, vectors_of(*matrices, chosen, every, beside), beside)


@pytest.mark.exact
def test_vectors_of_roots_that_are_equal_differ():
    """A doublet, of which inverse iteration finds the same vector twice."""
    matrices = np.eye(40), 0.1 * np.eye(40), np.diag(np.repeat(np.arange(1.0, 21.0), 2))
    every = quadratic_roots(*matrices)
    chosen = every[-2:]
    vectors = vectors_of(*matrices, chosen, every)
    vectors_match(matrices, chosen, vectors)
    assert np.linalg.svd(vectors, compute_uv=False)[-1] > 0.1


@pytest.mark.exact
@pytest.mark.parametrize("damping", [0.0, 3.0, 20.0, 40.0])
def test_damped_oscillator(damping):
    mass, stiffness = 2.0, 50.0
    roots = quadratic_roots(*(np.array([[a]]) for a in (mass, damping, stiffness)))
    expected = np.roots([mass, damping, stiffness])
    np.testing.assert_allclose(np.sort_complex(roots), np.sort_complex(expected), rtol=1e-7 if damping == 20 else 1e-12)


@pytest.mark.exact
def test_gyroscopic_rotor_splits_into_forward_and_backward_whirl():
    """m (x'' , y'') + 2 g W (y', -x') + k (x, y) = 0: w = sqrt(W0^2 + h^2) +- h with h = g W / m."""
    mass, stiffness, gyroscopic = 1.5, 600.0, 4.0
    modes = quadratic_modes(mass * np.eye(2), gyroscopic * np.array([[0, 1], [-1, 0]]), stiffness * np.eye(2))
    half, centre = gyroscopic / (2 * mass), np.sqrt(stiffness / mass + (gyroscopic / (2 * mass)) ** 2)
    np.testing.assert_allclose(modes.value[2:].imag, [centre - half, centre + half], rtol=1e-12)
    np.testing.assert_allclose(modes.value.real, 0.0, atol=1e-11)
    turn = modes.right[1, 2:] / modes.right[0, 2:]
    np.testing.assert_allclose(turn, turn[0] * np.array([1, -1]), atol=1e-9)
    np.testing.assert_allclose(abs(turn), 1.0)


@pytest.mark.exact
def test_left_and_right_vectors_solve_the_quadratic_problem():
    mass, damping, stiffness = random_system(7)
    modes = quadratic_modes(mass, damping, stiffness, left=True)
    for s, x, y in zip(modes.value, modes.right.T, modes.left.T, strict=True):
        dynamic = s**2 * mass + s * damping + stiffness
        assert np.linalg.norm(dynamic @ x) < 1e-11 * np.linalg.norm(stiffness)
        assert np.linalg.norm(y.conj() @ dynamic) < 1e-11 * np.linalg.norm(stiffness)
        assert np.vdot(x, mass @ x).real == pytest.approx(1.0)
    np.testing.assert_allclose(quadratic_roots(mass, damping, stiffness), modes.value, rtol=1e-9)


@pytest.mark.exact
def test_polished_roots_are_those_of_the_problem():
    mass, damping, stiffness = random_system(7)
    exact = quadratic_modes(mass, damping, stiffness)
    rng = np.random.default_rng(3)
    beside = Settling(*map(rng.standard_normal, ((7, 2), (2, 7), (2, 7))), np.array([30.0, 400.0]))
    coupled = quadratic_modes(mass, damping, stiffness, beside=beside)
    for modes, settling in ((exact, None), (coupled, beside)):
        for k in np.flatnonzero(modes.value.imag > 0):
            vector = modes.right[:, k] * (1 + 1e-3 * rng.standard_normal(7))
            root, shape = polished(mass, damping, stiffness, modes.value[k] * (1 + 1e-4), vector, settling)
            assert root == pytest.approx(modes.value[k], rel=1e-8)
            assert abs(np.vdot(shape, modes.right[:, k])) == pytest.approx(np.linalg.norm(modes.right[:, k]), rel=1e-6)


def test_polishing_without_a_root_nearby_is_refused():
    with pytest.raises(ConvergenceError, match="complex modes"):
        polished(np.eye(1), np.zeros((1, 1)), np.eye(1), 0.0, np.ones(1))     # between two roots


@pytest.mark.exact
def test_badly_scaled_coordinates_do_not_matter():
    mass, damping, stiffness = random_system(6, seed=1)
    scale = np.diag(10.0 ** np.arange(-9, 9, 3))
    scaled = quadratic_roots(*(scale @ a @ scale for a in (mass, damping, stiffness)))
    np.testing.assert_allclose(scaled, quadratic_roots(mass, damping, stiffness), rtol=1e-10)


@pytest.mark.exact
def test_upper_half_takes_one_root_of_every_pair():
    mass = np.eye(3)
    roots = quadratic_roots(mass, np.diag([0.1, 5.0, 0.2]), np.diag([4.0, 1.0, 9.0]))
    half = roots[upper_half(roots)]
    over = -2.5 + np.sqrt(2.5**2 - 1)
    np.testing.assert_allclose(half, [over, -0.05 + 1j * np.sqrt(4 - 0.05**2), -0.1 + 1j * np.sqrt(9 - 0.01)],
                               atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("noise", [0.0, 1e-12, -1e-12])
def test_no_last_bit_decides_the_order_of_roots_of_one_frequency(noise):
    """A growing and a decaying root of one frequency, whichever of them is higher by rounding."""
    roots = np.array([135 + 3165j, -135 + (3165 + noise) * 1j, -3 + 100j, 20 + 4000j])
    np.testing.assert_array_equal(by_frequency(roots), [2, 1, 0, 3])
    assert by_frequency(np.array([])).size == 0


def test_flutter_threshold_of_two_modes():
    k11, k22, k12, k_friction = 1.3e6, 1.0e6, 2.0e5, 1.0e6
    onset = onset_friction(k11, k22, k12, k_friction)
    for friction in (0.999 * onset, 1.001 * onset):
        stiffness = np.array([[k11, k12 - friction * k_friction], [k12, k22]])
        roots = quadratic_roots(np.eye(2), np.zeros((2, 2)), stiffness)
        expected = by_height(roots_over_friction(k11, k22, k12, k_friction, friction))
        np.testing.assert_allclose(by_height(roots), expected, rtol=1e-9)
        assert (roots.real.max() > 1e-6 * abs(roots).max()) == (friction > onset)


@pytest.mark.exact
def test_followed_roots_cross_without_swapping():
    sweep = np.linspace(0.0, 1.0, 21)
    paths = np.stack([1j * (1 + 2 * sweep), 1j * (2 + 0 * sweep), -0.1 + 1j * (3 - 2.5 * sweep)], axis=1)
    shuffled = np.array([np.random.default_rng(k).permutation(row) for k, row in enumerate(paths)])
    shuffled[0] = paths[0]
    np.testing.assert_array_equal(follow_roots(shuffled), paths)


def test_massless_coordinate_is_refused():
    with pytest.raises(ConfigError, match="positive definite"):
        quadratic_roots(np.diag([1.0, 0.0]), np.zeros((2, 2)), np.eye(2))


@pytest.mark.exact
def test_what_settles_beside_the_motion_adds_its_roots():
    """A mass on a spring and a Maxwell branch: (m s^2 + k) (s + 1 / tau) + g s = 0, with its vector."""
    m, k, g, tau = 2.0, 800.0, 300.0, 0.03
    one = np.ones((1, 1))
    branch = Settling(-one, 0 * one, g * one, np.array([1 / tau]))
    exact = np.roots([m, m / tau, k + g, k / tau])
    found = quadratic_modes(m * one, 0 * one, k * one, beside=branch)
    for roots in (found.value, quadratic_roots(m * one, 0 * one, k * one, branch)):
        assert abs(roots[:, None] - exact).min(axis=1).max() < 1e-9 * abs(exact).max()
    assert len(found.value) == 3 and list(upper_half(found.value, 1)) == [np.argmax(found.value.imag)]
    np.testing.assert_allclose(abs(found.right), 1 / np.sqrt(m))
