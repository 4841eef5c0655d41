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


@pytest.mark.exact
def test_a_body_that_touches_nothing_at_first_stays_where_it_is_until_it_does():
    """A mass on a spring of 3 N/m under 6 N meets, after 1.5 m and by a spring of 50 N/m, another one that a spring of
    2 N/m holds from then on: while they are apart nothing does."""
    def equation(x):
        closed = float(x[0] - x[1] > 1.5)
        force, wall = 50 * closed * (x[0] - x[1] - 1.5), 2 * closed
        pair = 50 * closed * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return (np.array([3 * x[0] - 6 + force, wall * x[1] - force]),
                pair + np.diag([3.0, wall]))

    balance = damped_newton(equation, np.zeros(2), largest, 1e-12, 20, 10)
    first = np.linalg.solve([[53.0, -50.0], [-50.0, 52.0]], [81.0, -75.0])
    assert balance.error <= 1e-12
    np.testing.assert_allclose(balance.unknown, first, rtol=1e-9)
