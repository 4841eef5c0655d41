"""Structural damping: half the loss factor as damping ratio, at every frequency, and the hysteretic eigenvalues."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.sliding.structural_damping import equivalent_damping, equivalent_motion
from tests.stages.small_brake import small_brake

pytestmark = pytest.mark.exact


def chain(count=6):
    """Stiffness and mass of equal masses between springs of which the last is held, and each spring's part."""
    parts = []
    for k in range(count):
        row = np.zeros(count)
        row[k] = 1.0
        if k:
            row[k - 1] = -1.0
        parts.append(1e6 * 2.0**-k * np.outer(row, row))
    return np.array(parts), np.diag(np.linspace(1.0, 3.0, count))


def upper(roots):
    return np.sort_complex(roots[roots.imag > 0] * -1j)


def test_one_loss_factor_damps_every_mode_by_half_of_it():
    parts, mass = chain()
    stiffness = parts.sum(axis=0)
    roots = quadratic_roots(mass, equivalent_damping(0.04 * stiffness, stiffness, mass), stiffness)
    assert -roots.real / abs(roots) == pytest.approx(0.02, rel=1e-9)


def test_roots_are_those_of_the_complex_stiffness_to_second_order():
    """Loss factors of 0.5 to 8 %: s = i sqrt(eigenvalue of K + iH), which no viscous law has but to first order."""
    parts, mass = chain()
    stiffness, loss = parts.sum(axis=0), np.einsum("k,kij->ij", np.linspace(0.005, 0.08, len(parts)), parts)
    misses = []
    for scale in (1.0, 0.5):
        exact = upper(1j * np.sqrt(scipy.linalg.eigvals(stiffness + 1j * scale * loss, mass)))
        roots = upper(quadratic_roots(mass, equivalent_damping(scale * loss, stiffness, mass), stiffness))
        misses.append(abs(roots / exact - 1).max())
    assert misses[0] < 2e-3 and misses[1] == pytest.approx(misses[0] / 4, rel=0.2)


def test_losses_only_take_energy_and_leave_rigid_motions_alone():
    parts, mass = chain()
    loss = 0.1 * parts[3]
    free = parts[1:].sum(axis=0)        # nothing holds the first mass
    damping = equivalent_damping(loss, free, mass)
    assert np.linalg.eigvalsh(damping).min() > -1e-9 * abs(damping).max()
    assert damping @ np.ones(len(mass)) == pytest.approx(0, abs=1e-9 * abs(damping).max())
    assert not equivalent_damping(0 * loss, free, mass).any()


def test_joints_of_a_product_lose_by_their_factors():
    model = small_brake()
    joint = list(model.joint_name).index(model.joint_name[0])
    factor = np.zeros(len(model.joint_name))
    factor[joint] = 0.1
    lossy = replace(model, joint_loss_factor=factor, joint_damping=0 * model.joint_damping)
    bare = replace(lossy, joint_loss_factor=0 * factor)
    damped, undamped = (sliding_model(m, 1, 10.0) for m in (lossy, bare))
    row = model.joint_rows[joint]
    expected = equivalent_damping(0.1 * model.joint_stiffness[joint] * np.outer(row, row),
                                  undamped.frictionless(False, False)[2], undamped.mass)
    np.testing.assert_allclose(damped.damping - undamped.damping, expected, rtol=1e-9, atol=1e-9 * abs(expected).max())


def test_each_part_of_the_loss_has_its_part_of_the_equivalent_damping():
    parts, mass = chain()
    stiffness = parts.sum(axis=0)
    x = np.random.default_rng(1).standard_normal(6) + 1j
    z = equivalent_motion(x, stiffness, mass)
    for part in parts:
        damping = equivalent_damping(0.1 * part, stiffness, mass)
        assert np.vdot(z, 0.1 * part @ z) == pytest.approx(np.vdot(x, damping @ x))
