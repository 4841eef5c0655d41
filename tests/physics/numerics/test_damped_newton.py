"""Newton's method with halved steps: order two, a start from which full steps diverge, refusal."""

import numpy as np
import pytest

from pipeline.physics.numerics.damped_newton import damped_newton


def largest(step, *more):
    return abs(step).max()


@pytest.mark.exact
def test_the_error_falls_with_order_two():
    """x^2 = 2 in steps of Newton's method, each of which squares the error over 2 x."""
    steps = []

    def equation(x):
        steps.append(float(x[0]))
        return x**2 - 2, np.diag(2 * x)

    balance = damped_newton(equation, np.array([2.0]), largest, 1e-12, 20, 5)
    np.testing.assert_allclose(balance.unknown + 0 * balance.step, np.sqrt(2), rtol=1e-12)
    error = np.array(steps[:4]) - np.sqrt(2)
    np.testing.assert_allclose(error[1:] / error[:-1] ** 2, 1 / (2 * np.array(steps[:3])), rtol=1e-3)


@pytest.mark.exact
def test_halved_steps_converge_where_full_steps_diverge():
    """atan(x) = 0 from 3: full steps run away."""
    def equation(x):
        return np.arctan(x), np.diag(1 / (1 + x**2))

    assert damped_newton(equation, np.array([3.0]), largest, 1e-12, 50, 30).unknown == pytest.approx(0, abs=1e-12)
    assert not damped_newton(equation, np.array([3.0]), largest, 1e-12, 4, 1).error < 1


def test_a_singular_derivative_never_counts_as_converged():
    balance = damped_newton(lambda x: (np.ones(2), np.zeros((2, 2))), np.zeros(2), largest, 1.0, 5, 5)
    assert balance.error == np.inf


def test_what_the_equation_adds_reaches_the_size_of_a_step():
    balance = damped_newton(lambda x: (x, np.eye(1), 1e-9), np.ones(1), lambda step, scale: scale * abs(step[0]), 1e-8,
                            5, 5)
    assert balance.unknown == 1 and balance.error == 1e-9     # small enough before the first step
