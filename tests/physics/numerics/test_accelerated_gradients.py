"""Accelerated gradients on a quadratic of known optimum: faster than plain ones, and restarted uphill."""

import numpy as np
import pytest

from pipeline.physics.numerics.accelerated_gradients import ahead_of

BENDS = np.geomspace(1e-3, 1.0, 20)


def steps_to(tolerance, accelerated):
    """Steps of length 1 down sum(bends x^2) / 2 with x >= 0, from x = 1, until all are below ``tolerance``."""
    before = ahead = np.ones(len(BENDS))
    momentum = 1.0
    for count in range(100_000):
        new = np.maximum(ahead - BENDS * ahead, 0.0)
        if new.max() < tolerance:
            return count
        ahead, momentum = ahead_of(new, before, ahead, momentum) if accelerated else (new, 1.0)
        before = new
    return np.inf


@pytest.mark.exact
def test_the_root_of_the_condition_number_decides():
    """Plain steps need ln(1 / tolerance) / smallest bend; accelerated ones, restarted, of the order of its root."""
    plain, fast = steps_to(1e-6, False), steps_to(1e-6, True)
    assert plain == pytest.approx(np.log(1e6) / 1e-3, rel=0.01) and fast < plain / 10


def test_momentum_restarts_where_it_points_uphill():
    before, ahead, new = np.array([1.0]), np.array([-0.5]), np.array([-0.1])
    again, momentum = ahead_of(new, before, ahead, 7.0)
    assert again is new and momentum == 1.0
    further, momentum = ahead_of(np.array([0.4]), before, np.array([0.5]), 1.0)
    assert further[0] == 0.4 and momentum == pytest.approx((1 + np.sqrt(5)) / 2)
