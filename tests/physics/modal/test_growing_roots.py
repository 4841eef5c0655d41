"""Growing roots by way of real modes, against all roots of the first-order system."""

import numpy as np
import pytest
import scipy

from pipeline.physics.modal import growing_roots as growing
from pipeline.physics.modal.growing_roots import growing_roots, spectrum_roots
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes
from pipeline.physics.stability.linearisation import Settling

#: all rad/s: frequencies of the modes lie between these, roots are sought below the limit
LOWEST, HIGHEST, LIMIT = 1e3, 2e5, 5e4
#: growth, as a share of the frequency, that no simplification hides
SURE = 4e-4


def system(seed, damped, size=140):
    """(C, K_0, dK): modes up to HIGHEST under one-sided friction and losses; ``damped``: share of the critical damping
    by which twenty contacts damp the modes, those above the limit the more."""
    rng = np.random.default_rng(seed)
    frequency = np.sort(rng.uniform(LOWEST, HIGHEST, size))
    turn = np.linalg.qr(rng.standard_normal((size, size)))[0]
    contacts = rng.standard_normal((20, size)) * np.sqrt(frequency / size)
    along = rng.standard_normal((20, size)) * np.sqrt(frequency / size)
    friction = 0.15 * (along.T * frequency.mean()) @ contacts
    damping = damped * contacts.T @ contacts + np.diag(1e-3 * frequency)
    lossy = np.diag(2e-3 * frequency**2)
    return tuple(turn @ part @ turn.T for part in (damping, np.diag(frequency**2), friction + 1j * lossy))


def every_root(damping, stiffness, change):
    """All roots below the limit in the upper half plane, by falling growth rate."""
    size, pace = len(damping), np.sqrt(np.linalg.norm(stiffness))
    companion = np.block([[np.zeros((size, size)), pace * np.eye(size)], [-(stiffness + change) / pace, -damping]])
    roots = scipy.linalg.eigvals(companion)
    roots = roots[(roots.imag > abs(roots.real)) & (abs(roots) < LIMIT)]
    return roots[np.argsort(-roots.real)]


@pytest.mark.exact
@pytest.mark.parametrize(("damped", "grow"), [(0.0, 35), (0.02, 30), (0.3, 4), (1.0, 1)])
def test_growing_roots_and_the_least_stable_one_are_those_of_all_roots(damped, grow):
    grown = 0
    for seed in range(12):
        matrices = system(seed, damped)
        exact, modes = every_root(*matrices), growing_roots(*matrices, LIMIT)
        roots = modes.value
        sought = exact[exact.real > SURE * abs(exact)] if (exact.real > 0).any() else exact[:1]
        for root in sought:
            assert abs(roots - root).min() < 1e-7 * abs(root)
        assert all(abs(exact - root).min() < 1e-7 * abs(root) for root in roots)
        assert (np.diff(roots.real) <= 0).all()
        for root, shape, residual in zip(roots, modes.shape.T, modes.residual, strict=True):
            force = root * (root * shape + matrices[0] @ shape) + (matrices[1] + matrices[2]) @ shape
            assert np.linalg.norm(force) < 1e-6 * abs(root) ** 2 and residual < 1e-6 * abs(root)
            slope = 2 * root * shape + matrices[0] @ shape
            assert residual == pytest.approx(np.linalg.norm(force) / np.linalg.norm(slope), rel=1e-3, abs=1e-9)
        grown += np.sum(exact.real > 0)
    assert grown >= grow


def test_all_roots_say_what_the_bands_say():
    seeds, banded = range(4), 0
    for seed in seeds:
        matrices = system(seed, 0.02)
        some, every = growing_roots(*matrices, LIMIT), spectrum_roots(*matrices, LIMIT)
        grow = every.value[every.value.real > 0]
        np.testing.assert_allclose(some.value[some.value.real > 0], grow, rtol=1e-7)
        assert every.whole and len(grow)
        banded += not some.whole
    assert banded


@pytest.mark.exact
def test_where_the_bands_do_not_serve_all_roots_are_computed(monkeypatch):
    """Bands whose roots all lie too far down are seen, and no root lost."""
    honest = growing.__dict__["_Band"].roots
    monkeypatch.setattr(growing.__dict__["_Band"], "roots", lambda self: honest(self) - 100.0)
    matrices = system(0, 0.02)
    modes, exact = growing_roots(*matrices, LIMIT), every_root(*matrices)
    assert modes.whole and (exact.real > 0).any()
    for root in exact[exact.real > 0]:
        assert abs(modes.value - root).min() < 1e-7 * abs(root)


def test_no_mode_below_the_limit_is_no_root():
    modes = growing_roots(np.zeros((2, 2)), np.diag([1e8, 2e8]), np.zeros((2, 2), complex), 1e3)
    assert modes.value.shape == modes.residual.shape == (0,) and modes.shape.shape == (2, 0)


@pytest.mark.exact
@pytest.mark.parametrize("pace, size", [(0.02, 50), (1.0, 50), (30.0, 50), (1.0, 140)])
def test_growing_roots_with_memory_are_those_of_the_system_with_its_states(pace, size):
    """Memory slower than all modes, amid them, and quicker than they; the states join the first-order system."""
    for seed in range(2):
        rng = np.random.default_rng(seed + 50)
        damping, stiffness, change = system(seed, 0.02, size)
        strong = 0.1 * np.sqrt(np.linalg.norm(stiffness, 2))
        beside = Settling(strong * rng.standard_normal((size, 6)) / np.sqrt(size),
                            strong * rng.standard_normal((6, size)) / np.sqrt(size),
                            rng.standard_normal((6, size)) / np.sqrt(size), pace * np.geomspace(LOWEST, LIMIT, 6))
        exact = quadratic_modes(np.eye(size), damping, stiffness + change.real, beside=beside).value
        exact = exact[(exact.imag > abs(exact.real)) & (abs(exact) < LIMIT)]
        for found in (growing_roots(damping, stiffness, change.real + 0j, LIMIT, beside),
                      spectrum_roots(damping, stiffness, change.real + 0j, LIMIT, beside)):
            for root in exact[exact.real > SURE * abs(exact)]:
                assert abs(found.value - root).min() < 1e-7 * abs(root)
            assert all(abs(exact - root).min() < 1e-7 * abs(root) for root in found.value)
            assert found.residual.max() < 1e-3
