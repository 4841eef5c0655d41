"""Derivatives of samples by a quintic spline."""

import numpy as np
import pytest

from pipeline.physics.numerics.spline_derivatives import derivatives

H = 0.01


@pytest.mark.exact
def test_polynomials_up_to_the_fifth_order_are_exact():
    t = H * np.arange(60)
    first, second = derivatives(np.array([t**5 - t**2, 3 * t + 1]), H)
    np.testing.assert_allclose(first, [5 * t**4 - 2 * t, 3 + 0 * t], atol=1e-9)
    np.testing.assert_allclose(second, [20 * t**3 - 2, 0 * t], atol=1e-6)


@pytest.mark.parametrize("samples, error", [(6, 2e-3), (9, 4e-4), (20, 2e-5)])
def test_few_samples_a_period_are_enough(samples, error):
    w = 2 * np.pi / (samples * H)
    t = H * np.arange(400)
    inner = slice(20, -20)
    first, second = derivatives(np.sin(w * t)[None], H)
    assert abs(first[0] / w - np.cos(w * t))[inner].max() < error / 4
    assert abs(second[0] / w**2 + np.sin(w * t))[inner].max() < error


def test_it_converges_by_the_fourth_order_at_least():
    def error(h):
        t = h * np.arange(round(4 / h))
        true = -4 * np.pi**2 * np.sin(2 * np.pi * t)
        return abs(derivatives(np.sin(2 * np.pi * t)[None], h)[1][0] - true)[20:-20].max()

    assert np.log2(error(0.05) / error(0.025)) > 3.8


def test_a_handful_of_samples_will_do():
    first, second = derivatives(np.array([[0.0, 1.0, 4.0, 9.0]]), 1.0)
    np.testing.assert_allclose(first, [[0.0, 2.0, 4.0, 6.0]])
    np.testing.assert_allclose(second, [[2.0, 2.0, 2.0, 2.0]])
