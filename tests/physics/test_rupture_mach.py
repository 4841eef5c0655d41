"""The Mach angle of made-up velocity fields."""

import numpy as np
import pytest

from pipeline.physics.rupture_fronts import LEFT, RIGHT, Arrival
from pipeline.physics.rupture_mach import View, front_angle, mach_angle_of


@pytest.mark.exact
@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize("degrees", [32.0, 51.0])
def test_the_mach_angle_of_a_plane_shear_front(side, degrees):
    """A velocity step across a straight front: to 2 degrees."""
    h, tip = 1e-5, 1e-3
    y, x = np.mgrid[0:60, 0:201] * h
    behind = side * (tip - x) - y / np.tan(np.radians(degrees))
    velocity = np.stack([np.tanh(behind / 3e-5), np.zeros_like(behind)])
    found = mach_angle_of(velocity, h, tip, side, (3e-5, 3e-4), 4e-5)
    assert np.degrees(found) == pytest.approx(degrees, abs=2.0)


def test_too_few_rows_show_no_mach_angle():
    assert np.isnan(mach_angle_of(np.zeros((2, 5, 50)), 1e-5, 2e-4, LEFT, (1e-5, 2e-5), 0.0))


@pytest.mark.exact
def test_the_angle_belongs_to_the_front_that_is_looked_at():
    """A front at 1700 m/s in a solid of shear speed 1000 m/s: asin(1000 / 1700) = 36 degrees."""
    x, time = 1e-5 * np.arange(401), np.array([4e-7, 8e-7, 1.2e-6])
    far = np.abs(x - 2e-3)
    arrival = Arrival(x < 2e-3, far / 1700, far / 1700, far / 1700, 0 * x)
    y = 1e-5 * np.arange(60)[:, None]
    fields = [np.stack([np.tanh((x - 2e-3 + 1700 * t - y / np.tan(np.arcsin(1 / 1.7))) / 3e-5), 0 * x + 0 * y])
              for t in time]
    view = View(time, tuple(fields), 1e-5, 1000.0)
    measured, expected = front_angle(view, arrival, x, 2e-3, 6e-5, 1700.0, LEFT)
    assert expected == pytest.approx(np.arcsin(1 / 1.7)) and measured == pytest.approx(expected, abs=0.035)
    assert np.isnan(front_angle(view, arrival, x, 2e-3, 6e-5, 900.0, LEFT)).all(), "slower than the shear wave"
    assert np.isnan(front_angle(view, arrival, x, 2e-3, 6e-5, 1700.0, RIGHT)).all(), "nothing came by"
