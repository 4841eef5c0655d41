"""Dahl friction in a joint."""

import numpy as np
import pytest

from tests.effects.sliding import pulled, sliding_error

VALUES = {"force": 1.0, "length": 2e-3}


@pytest.mark.exact
def test_slow_pull_follows_the_exponential():
    e, force = pulled("dahl", VALUES)
    inside = e > 2e-4
    np.testing.assert_allclose(force[inside], 400 * e[inside] + 1 - np.exp(-e[inside] / 2e-3), rtol=2e-3)
    assert e[-1] > 4e-3


@pytest.mark.exact
def test_sliding_is_that_of_scipy_at_order_two():
    errors = [sliding_error("dahl", VALUES, lambda x, v, z: (z[0], ((v - abs(v) * z[0]) / 2e-3,)), (0.0,), step)
              for step in (2e-3, 1e-3)]
    assert errors[1] < 2e-4 and errors[0] / errors[1] == pytest.approx(4, rel=0.2)
