"""The linear step against the matrix exponential of the whole system, and Newmark's period error."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from pipeline.contract.errors import ConfigError
from pipeline.physics.time_stepping.modal_integrator import modal_system, newmark_matrices, step_matrices
from tests.physics.lumps import lumps


def chain(damper=0.0):
    """A free pair of masses, a supported one, and a fourth that a damper may couple to all."""
    return lumps([1.0, 2.0, 0.5, 0.7], [[1, -1, 0, 0], [0, 0, 1, 0], [0, 0, -1, 1], [1, 0, -1, 0.5]],
                 [3e4, 5e4, 1e4, 0.0], [0.0, 0.0, 0.0, damper])


def whole(model, step):
    """Exponential of (q, q', f, f next - f) of the whole model, f a force on coordinate 0."""
    mass, damping, stiffness = model.supported()
    n = model.size
    matrix = np.zeros((2 * n + 2, 2 * n + 2))
    matrix[:n, n:2 * n] = np.eye(n)
    matrix[n:2 * n, :n], matrix[n:2 * n, n:2 * n] = -np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)
    matrix[n:2 * n, 2 * n] = np.linalg.solve(mass, np.eye(n)[0])
    matrix[-2, -1] = 1 / step
    return expm(matrix * step)[:2 * n]


@pytest.mark.exact
@pytest.mark.parametrize("damper", [0.0, 3.0, 800.0])
@pytest.mark.parametrize("step", [1e-6, 1e-3, 0.3])
def test_step_is_exact_at_any_length(damper, step):
    """Free, supported and coupled, weakly damped and over-damped, from a fraction of a period to many."""
    model, force = chain(damper), np.array([5.0, -2.0])
    system = modal_system(model)
    assert system.coupled == (damper > 0)
    q, v = np.array([1e-3, 0, 2e-3, -1e-3]), np.array([0.1, -0.2, 0.3, 0.0])
    step_matrix, first, last = step_matrices(system, step)
    forced = system.driven(np.eye(4)[:1])[0]
    pairs = np.einsum("bxy,yb->xb", step_matrix, system.to_pairs(q, v))
    pairs += sum(f * np.einsum("bxy,yb->xb", m, forced) for f, m in zip(force, (first, last), strict=True))
    exact = whole(model, step) @ np.r_[q, v, force[0], force[1] - force[0]]
    np.testing.assert_allclose(np.concatenate(system.from_pairs(pairs)), exact, rtol=1e-8,
                               atol=1e-9 * abs(exact).max())


@pytest.mark.exact
def test_rows_see_and_drive_the_whole_model():
    model = chain(40.0)
    system, rows = modal_system(model), np.array([[1.0, 2.0, 0.0, -1.0]])
    q, v = np.arange(4) + 1.0, np.array([3.0, -1.0, 0.5, 2.0])
    pairs = system.to_pairs(q, v)
    np.testing.assert_allclose(np.einsum("dryb,yb->dr", system.observed(rows), pairs).ravel(), (rows @ np.c_[q, v])[0])
    rate = system.from_pairs(system.driven(rows)[0])
    np.testing.assert_allclose(rate[0], 0, atol=1e-10)
    np.testing.assert_allclose(rate[1], np.linalg.solve(model.mass, rows[0]), atol=1e-10)


@pytest.mark.exact
def test_trapezoidal_rule_lowers_a_mode_by_its_formula():
    """tan(w' h / 2) = w h / 2: at 4e-5 s the mode of 2250 Hz shows 2193 Hz."""
    step, angular = 4e-5, 2 * np.pi * 2250
    system = modal_system(lumps([1.0], [[1.0]], [angular**2]))
    turned = np.angle(np.linalg.eigvals(newmark_matrices(system, step, 0.5)[0][0])).max() / step
    assert turned == pytest.approx(2 / step * np.arctan(angular * step / 2), rel=1e-12)
    assert turned / (2 * np.pi) == pytest.approx(2193, abs=1)
    exact = np.angle(np.linalg.eigvals(step_matrices(system, step)[0][0])).max() / step
    assert exact == pytest.approx(angular, rel=1e-12)


@pytest.mark.exact
def test_newmark_rule_is_of_second_order():
    system = modal_system(lumps([1.0], [[1.0]], [100.0], [0.5]))
    errors = []
    for steps in (100, 200, 400):
        matrix = np.linalg.matrix_power(newmark_matrices(system, 1.0 / steps, 0.5)[0][0], steps)
        errors.append(abs(matrix - step_matrices(system, 1.0)[0][0]).max())
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.02)


def test_modes_above_a_limit_are_left_out():
    model = lumps([1.0, 1.0], np.eye(2), [100.0, 1e6])
    assert modal_system(model, highest=10.0).squared == pytest.approx([100.0])


def test_what_cannot_be_split_is_refused():
    with pytest.raises(ConfigError, match="mass"):
        modal_system(replace(chain(), mass=np.diag([1.0, 1.0, 0.0, 1.0])))
    with pytest.raises(ConfigError, match="diagonal"):
        newmark_matrices(modal_system(chain(3.0)), 1e-3, 0.5)
    assert not modal_system(chain(3.0), damping="diagonal").coupled
