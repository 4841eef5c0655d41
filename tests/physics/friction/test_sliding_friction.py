"""Friction in the plane of a contact: regularisation, direction, slopes by differences."""

import numpy as np
import pytest

from pipeline.physics.friction.dry_friction import Friction, characteristic, falling, kernel
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.friction.sliding_friction import sliding_friction, sliding_part

pytestmark = pytest.mark.exact
STICK = 0.1


def friction(normal, x, y, area=1e-3):
    """Force with friction that rises by 2e-8 per Pa and falls by 0.05 per m/s."""
    pressure, slip = normal / area, float(np.hypot(x, y))
    return sliding_friction(normal, pressure, slip, x, y, 0.4 + 2e-8 * pressure - 0.05 * slip, 2e-8, -0.05, STICK)


def test_friction_is_regularised_below_the_stick_speed_only():
    assert sliding_part(0.0, 0.1) == (0.0, 15.0)
    assert sliding_part(0.1, 0.1) == sliding_part(5.0, 0.1) == sliding_part(0.0, 0.0) == (1.0, 0.0)
    step = 1e-7
    slope = (sliding_part(0.04 + step, 0.1)[0] - sliding_part(0.04 - step, 0.1)[0]) / (2 * step)
    assert sliding_part(0.04, 0.1)[1] == pytest.approx(slope, rel=1e-8)


def test_full_sliding_has_the_size_mu_n_along_the_slip():
    force = friction(500.0, 0.3, -0.4)
    mu = 0.4 + 0.01 - 0.025
    assert (force.x, force.y) == pytest.approx((0.6 * mu * 500, -0.8 * mu * 500))


@pytest.mark.parametrize("slip", [(0.3, -0.4), (-0.02, 0.03), (0.05, 0.0)])
def test_slopes_are_those_of_the_force(slip):
    force, x, y, step = friction(500.0, *slip), *slip, 1e-6
    over_x, over_y, over_n = (np.subtract(there[:2], force[:2]) for there in (
        friction(500.0, x + step, y), friction(500.0, x, y + step), friction(500.0 + 1e-3, *slip)))
    np.testing.assert_allclose(over_x / step, (force.xx, force.xy), rtol=1e-4, atol=0.05)
    np.testing.assert_allclose(over_y / step, (force.xy, force.yy), rtol=1e-4, atol=0.05)
    np.testing.assert_allclose(over_n / 1e-3, (force.x_by_normal, force.y_by_normal), rtol=1e-5, atol=1e-8)


def test_without_slip_creep_is_viscous_in_all_directions():
    force = friction(500.0, 0.0, 0.0)
    assert force.x == force.y == force.xy == 0 and force.xx == force.yy == pytest.approx(500 * 0.41 * 1.5 / STICK)


def test_the_characteristic_is_the_law_with_its_slopes():
    law = FrictionLaw([0.0, 1e6, 4e6], [0.0, 1.0], [0.0, 0.01], 0.3 + np.arange(12).reshape(3, 2, 2) / 40)
    mu, by_pressure, by_speed, outside = characteristic(kernel(falling(0.4, 0.4, 1.0, backward=0.5), 1), 0, 1e6, 1.0,
                                                        0.0, -1.0)
    assert (mu, by_pressure, by_speed) == (0.2, 0.0, 0.0)
    dry = kernel(Friction(law), 1)
    mu, by_pressure, by_speed, outside = characteristic(dry, 0, 2e6, 0.4, 0.004, 1.0)
    assert mu == pytest.approx(law.evaluate(2e6, 0.4, 0.004)[0]) and outside == 0
    step = characteristic(dry, 0, 2e6 + 10, 0.4, 0.004, 1.0)[0], characteristic(dry, 0, 2e6, 0.4 + 1e-5, 0.004, 1.0)[0]
    assert ((step[0] - mu) / 10, (step[1] - mu) / 1e-5) == pytest.approx((by_pressure, by_speed), rel=1e-5)
    assert characteristic(dry, 0, 5e6, 0.4, 0.004, 1.0)[3] == 1
