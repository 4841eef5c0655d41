"""A spring with a dry slider beside a joint."""

import numpy as np
import pytest

from tests.effects.sliding import pulled


@pytest.mark.exact
def test_slow_pull_is_stiffer_until_the_slider_slips():
    e, force = pulled("jenkins", {"stiffness": 300.0, "limit": 1.0})
    inside = e > 2e-4
    np.testing.assert_allclose(force[inside], 400 * e[inside] + np.minimum(300 * e[inside], 1.0), rtol=3e-3)
    assert e[-1] > 4e-3
