"""Richardson's extrapolation: exact for a power law of the spacing on grids of any ratio, cautious elsewhere."""

import numpy as np
import pytest

from pipeline.physics.numerics.grid_limit import ORDERS, grid_limit


@pytest.mark.exact
@pytest.mark.parametrize("order", [0.7, 1.0, 2.0, 3.5])
@pytest.mark.parametrize("fineness", [(4, 8, 16), (4, 6, 16, 20)])
def test_a_power_law_has_its_limit_and_order(order, fineness):
    found = grid_limit(fineness, 0.3 + 0.2 * np.array(fineness, float) ** -order)
    assert found.value == pytest.approx(0.3, rel=1e-9) and found.order == pytest.approx(order, rel=1e-9)
    assert found.error == pytest.approx(1.25 * 0.2 * fineness[-1] ** -order, rel=1e-6)


def test_the_error_covers_the_limit_of_a_second_power():
    fineness = np.array([4.0, 8.0, 16.0])
    found = grid_limit(fineness, 0.3 + 0.2 / fineness + 0.3 / fineness**2)
    assert abs(found.value - 0.3) < found.error < 0.02


def test_values_that_swing_have_the_least_order_and_the_largest_error():
    found = grid_limit((4, 8, 16), (0.30, 0.34, 0.31))
    assert found.order == ORDERS[0] and found.error > 0.03


def test_few_grids_tell_no_order():
    assert grid_limit((8, 16), (0.3, 0.28))[:2] == pytest.approx((0.28, 0.02))
    assert grid_limit((8,), (0.3,)) == (0.3, 0.3, 0.0)
    assert grid_limit((4, 8, 16), (0.3, 0.2, 0.2)).error == 0
    with pytest.raises(ValueError, match="must rise"):
        grid_limit((8, 4), (0.3, 0.2))
