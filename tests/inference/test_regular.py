"""Hessians that the prior keeps regular: exact where products resolve it, columns of 1e10 and exactly parallel ones."""

import numpy as np
import pytest

from pipeline.inference.fitting.fit_state import Fit
from pipeline.inference.fitting.steps import newton_step
from pipeline.inference.problem import Hypothesis
from pipeline.inference.regular import inverse, log_determinant, solved


def hessian(jacobian):
    return np.eye(jacobian.shape[1]) + jacobian.T @ jacobian


def parallel(size):
    """Jacobian (50, 3): two exactly parallel columns of this size and one of 1."""
    column, other = np.random.default_rng(0).standard_normal((2, 50))
    other -= column * (column @ other) / (column @ column)
    return np.column_stack((size * column, size * column, other))


@pytest.mark.exact
@pytest.mark.parametrize("size", [1.0, 1e4, 1e6, 1e8, 1e10, 1e12])      # a sum of 5e13 keeps 1 to a part in 1000
def test_of_parallel_columns_the_difference_is_as_uncertain_as_the_prior(size):
    jacobian = parallel(size)
    large, small = (jacobian[:, k] @ jacobian[:, k] for k in (0, 2))
    known = 1 / (1 + 2 * large)
    expected = np.array([[0.5 + known / 2, -0.5 + known / 2, 0], [-0.5 + known / 2, 0.5 + known / 2, 0],
                         [0, 0, 1 / (1 + small)]])
    np.testing.assert_allclose(inverse(hessian(jacobian)), expected, atol=2e-3)
    np.testing.assert_allclose(solved(hessian(jacobian), np.eye(3)), expected, atol=2e-3)
    assert log_determinant(hessian(jacobian)) == pytest.approx(np.log1p(2 * large) + np.log1p(small), rel=1e-4)


@pytest.mark.exact
def test_columns_of_unlike_size_keep_what_each_is_known_to():
    jacobian = np.random.default_rng(1).standard_normal((50, 4))
    scale = np.array([1e-3, 1.0, 1e5, 1e10])
    exact = inverse(hessian(jacobian)[1:, 1:]) * np.outer(1 / scale[1:], 1 / scale[1:])
    many = inverse(np.stack([hessian(jacobian * scale), hessian(jacobian)]))
    np.testing.assert_allclose(np.sqrt(many[0, 3, 3] / exact[2, 2]), 1.0, rtol=0.05)
    assert many[0, 0, 0] == pytest.approx(1.0, abs=1e-3)
    np.testing.assert_allclose(many[1], np.linalg.inv(hessian(jacobian)), rtol=1e-8)


@pytest.mark.parametrize("turned", [-1e-15, 1e-16, 3e-16])
def test_what_rounding_leaves_of_a_right_hand_side_moves_no_value(monkeypatch, turned):
    """Kernels differ in the last digits of a basis; a gradient of 1e19 makes steps of them."""
    basis = np.array([[-1, 1], [1, 1]]) / np.sqrt(2)
    monkeypatch.setattr(np.linalg, "eigh", lambda _: (np.array([0.0, 2.0]), basis * [[1 + turned, 1], [1, 1]]))
    np.testing.assert_allclose(solved(np.full((2, 2), 4e20), np.full(2, 4e19)), [0.05, 0.05])


def test_a_fit_and_its_step_stand_where_two_values_move_the_runs_alike():
    """A Hessian of elements that are exactly alike, as 1e19 + 1 is: its elimination ends at a zero."""
    jacobian, zero = np.full((4, 2), 1e10), np.zeros(2)
    fit = Fit(Hypothesis("h"), (), (), zero, (np.full(4, 1e9),), (jacobian,), False, 1)
    gradient, matrix = fit.slopes
    with pytest.raises(np.linalg.LinAlgError):
        np.linalg.solve(matrix, gradient)
    assert fit.promised == pytest.approx(4e18) and np.isfinite(fit.covariance()).all()
    np.testing.assert_allclose(newton_step(gradient, matrix), [0.05, 0.05])
