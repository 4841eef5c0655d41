"""The Mach angle of made-up velocity fields, and of a source of known speed."""

import numpy as np
import pytest

from pipeline.physics.closed_form.wave_speeds import mach_angle
from pipeline.physics.rupture.fronts import LEFT, RIGHT, Arrival
from pipeline.physics.rupture.mach_fronts import View, front_angle, mach_angle_of
from pipeline.physics.rupture.plate_grid import ABSORBING, FREE, largest_step, plate
from pipeline.physics.rupture.plate_step import rims, step_plate
from tests.physics.small_ruptures import SOFT, STIFF


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
    arrival, slow = (Arrival(x < 2e-3, np.abs(x - 2e-3) / speed, 0 * x, 0 * x, 0 * x) for speed in (1700, 900))
    y = 1e-5 * np.arange(60)[:, None]
    fields = [np.stack([np.tanh((x - 2e-3 + 1700 * t - y / np.tan(np.arcsin(1 / 1.7))) / 3e-5), 0 * x + 0 * y])
              for t in time]
    view = View(time, tuple(fields), 1e-5, 1000.0)
    measured, expected = front_angle(view, arrival, x, 2e-3, 6e-5, LEFT)
    assert expected == pytest.approx(np.arcsin(1 / 1.7)) and measured == pytest.approx(expected, abs=0.035)
    assert np.isnan(front_angle(view, slow, x, 2e-3, 6e-5, LEFT)).all(), "slower than the shear wave"
    assert np.isnan(front_angle(view, arrival, x, 2e-3, 6e-5, RIGHT)).all(), "nothing came by"


def moving_source(solid, speed, spacing, duration, width=3e-5):
    """(velocity, tip in m) of a half-plane under a patch of shear that runs to the left along its edge."""
    everywhere, free = (ABSORBING, ABSORBING), (FREE, FREE)
    grid = plate(solid, 4e-3, 1.5e-3, spacing, 0.1, [everywhere, everywhere, free, everywhere])
    steps = int(duration / (0.9 * largest_step(grid))) + 1
    step, x = duration / steps, spacing * np.arange(grid.columns) - 2e-3
    rim, window = rims(grid, step), np.zeros((3, 2, grid.columns))
    displacement, velocity = np.zeros((2, 2, grid.rows, grid.columns))
    for count in range(1, steps + 1):
        step_plate(grid, rim, displacement, velocity, step, window)
        patch = np.exp(-(((x + speed * count * step) / width) ** 2)) * (x <= 0.0)
        velocity[0, 0] += rim.row_gain[0, 0] * spacing * patch
        displacement[0, 0] += step * rim.row_gain[0, 0] * spacing * patch
    return velocity, 2e-3 - speed * duration


@pytest.mark.exact
@pytest.mark.parametrize("solid, errors", [(STIFF, (2.5, 1.5, 1.5)), (SOFT, (5.5, 3.0, 2.0))])
def test_a_source_of_known_speed_shows_its_angle_as_the_mesh_is_refined(solid, errors):
    """1660 m/s for half a microsecond, as the left front: degrees on 25, 12.5 and 6.25 um; low in the slower solid."""
    expected, found = np.degrees(mach_angle(solid.shear_speed, 1660.0)), []
    tangent = solid.shear_speed * 5e-7 * np.cos(np.radians(expected))
    for spacing in (2.5e-5, 1.25e-5, 6.25e-6):
        velocity, tip = moving_source(solid, 1660.0, spacing, 5e-7)
        found.append(np.degrees(mach_angle_of(velocity, spacing, tip, LEFT, (2 * spacing, 0.9 * tangent), 8 * spacing)))
    low = expected - np.array(found)
    assert (np.abs(low) < errors).all()
    assert solid is STIFF or low[0] > low[1] > low[2] > 0.0
