"""Modes of the small motion: all roots of the linearised system, and roots that are moved."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding_motion.sliding_modes import sliding_modes
from tests.physics.sliding.test_equilibrium import random_model
from tests.physics.sliding_motion.small_motion import sliding, steady_friction


@pytest.fixture(scope="module")
def moving():
    return sliding(random_model())


@pytest.mark.exact
def test_small_motion_has_the_roots_of_the_linearised_system(moving):
    """Eigenvalues of the numerical Jacobian of the nonlinear motion, all of them."""
    about, system = moving
    half, small = len(system.modes.root), 1e-3 * system.reach
    jacobian = np.zeros((2 * half, 2 * half))
    for k in range(2 * half):
        start = np.zeros(half, complex)
        start[k % half] = small[k % half] * (1.0 if k < half else 1j)
        change = (system.rate(start) - system.rate(-start)) / (2 * small[k % half])
        jacobian[:, k] = np.concatenate((change.real, change.imag))
    pairs = system.modes.oscillating
    seen = np.linalg.eigvals(jacobian)
    direct = quadratic_roots(*about.linearised(steady_friction(about)))
    assert pairs.sum() * 2 + (~pairs).sum() == len(direct)
    for root in direct:
        assert abs(seen - root).min() < 2e-4 * abs(root)


@pytest.mark.exact
def test_roots_may_be_replaced_and_high_modes_damped(moving):
    modes = moving[1].modes
    pairs = np.flatnonzero(modes.oscillating)
    shifted = modes.root[pairs[:3]] * (1 + 1e-4j)
    replaced = modes.with_roots(shifted)
    np.testing.assert_array_equal(replaced.root[pairs[:3]], shifted)
    np.testing.assert_array_equal(np.delete(replaced.root, pairs[:3]), np.delete(modes.root, pairs[:3]))
    with pytest.raises(ConvergenceError, match="no|none"):
        modes.with_roots(np.array([1.5 * abs(modes.root).max() * 1j]))
    limit = abs(modes.root[pairs[3]]) / (2 * np.pi)
    damped = modes.damped_above(limit, 0.3).root
    high = modes.oscillating & (abs(modes.root) > 2 * np.pi * limit)
    assert (-damped[high].real >= 0.3 * abs(damped[high]) * (1 - 1e-12)).all()
    np.testing.assert_array_equal(damped[~high], modes.root[~high])


@pytest.mark.exact
def test_a_mode_that_the_basis_does_not_reach_joins_it_with_its_left_vector(moving):
    """On two real modes alone, asked for a root of the whole model that is off by a tenth of a per cent."""
    about, friction = moving[0], steady_friction(moving[0])
    mass, damping, stiffness = about.linearised(friction)
    below = moving[1].modes
    pairs = below.own[below.oscillating]
    limit = abs(pairs[2:4]).mean() / (2 * np.pi)
    poor = sliding_modes(about, friction, limit, np.inf)
    wanted = pairs[np.argmax([abs(poor.own - root).min() / abs(root) for root in pairs[:3]])]
    assert abs(poor.own - wanted).min() > 1e-3 * abs(wanted)
    rich = sliding_modes(about, friction, limit, np.inf, wanted * np.array([1.001]))
    nearest = np.argmin(abs(rich.own - wanted))
    assert rich.own[nearest] == pytest.approx(wanted, rel=1e-9)
    assert rich.basis.shape[1] == poor.basis.shape[1] + 4
    np.testing.assert_allclose(rich.basis.T @ mass @ rich.basis, np.eye(rich.basis.shape[1]), atol=1e-9)
    root = rich.own[nearest]
    left, right = rich.basis @ rich.left[:, nearest], rich.basis @ rich.right[:, nearest]
    operator = root**2 * mass + root * damping + stiffness
    assert np.linalg.norm(left @ operator) < 1e-6 * np.linalg.norm(operator) * np.linalg.norm(left)
    assert np.linalg.norm(operator @ right) < 1e-6 * np.linalg.norm(operator) * np.linalg.norm(right)


@pytest.mark.exact
def test_a_root_of_the_full_matrices_takes_the_place_of_its_own_in_the_reduced_model(moving):
    modes = moving[1].modes
    pairs = np.flatnonzero(modes.oscillating)
    full = modes.root[pairs[:2]] * 1.02
    replaced = modes.with_roots(full, modes.root[pairs[:2]] * (1 + 1e-4))
    np.testing.assert_array_equal(replaced.root[pairs[:2]], full)
    with pytest.raises(ConvergenceError, match="limit_cycle.smallest_correction"):
        modes.with_roots(full)
