"""Plane waves in one plate, and the compiled step against the plain one."""

import numpy as np
import pytest

from pipeline.physics.closed_form.wave_speeds import Solid
from pipeline.physics.rupture.plate_grid import ABSORBING, FIXED, FREE, largest_step, plate, strain_energy
from pipeline.physics.rupture.plate_step import plain_step, rims, step_plate

SOLID = Solid(5.3e9, 0.25, 1246.0)


@pytest.mark.exact
@pytest.mark.parametrize("edges", [
    [(FREE, FREE)] * 4, [(FIXED, FREE), (ABSORBING, ABSORBING), (FIXED, FIXED), (FREE, ABSORBING)]])
def test_the_compiled_step_is_the_plain_one(edges):
    grid = plate(SOLID, 2e-3, 1e-3, 1e-4, 0.1, edges)
    random, step = np.random.default_rng(1), 0.9 * largest_step(grid)
    displacement, velocity = 1e-9 * random.standard_normal((2, 2, grid.rows, grid.columns))
    plain = displacement.copy(), velocity.copy()
    for _ in range(20):
        step_plate(grid, rims(grid, step), displacement, velocity, step, np.zeros((3, 2, grid.columns)))
        plain_step(grid, rims(grid, step), *plain, step)
    np.testing.assert_allclose(displacement, plain[0], atol=1e-13 * np.abs(plain[0]).max())
    np.testing.assert_allclose(velocity, plain[1], atol=1e-13 * np.abs(plain[1]).max())


def standing_wave(axis, spacing):
    """Frequency over the exact one of a standing plane wave along a strip: P for axis 0, S for axis 1."""
    across = (FREE, FIXED) if axis == 0 else (FIXED, FREE)
    ends = (FREE, FIXED) if axis == 0 else (FIXED, FIXED)
    grid = plate(SOLID, 4e-3, 1e-3, spacing, 0.0, [ends, ends, across, across])
    x = 2 * np.pi * np.arange(grid.columns) * spacing / 4e-3
    displacement = np.zeros((2, grid.rows, grid.columns))
    displacement[axis] = np.cos(x) if axis == 0 else np.sin(x)
    mode, velocity, step = displacement[axis].copy(), np.zeros_like(displacement), 0.2 * largest_step(grid)
    period = 4e-3 / (SOLID.dilatational_speed if axis == 0 else SOLID.shear_speed)
    rim, window, probe = rims(grid, step), np.zeros((3, 2, grid.columns)), []
    for _ in range(int(2.2 * period / step)):
        step_plate(grid, rim, displacement, velocity, step, window)
        probe.append((displacement[axis] * mode).sum())
    probe = np.array(probe)
    zero = np.flatnonzero(np.diff(np.sign(probe)))
    times = step * (zero + probe[zero] / (probe[zero] - probe[zero + 1]))
    return period / (2.0 * (times[-1] - times[0]) / (len(times) - 1))


@pytest.mark.exact
@pytest.mark.parametrize("axis, name", [(0, "P"), (1, "S")])
def test_plane_wave_speed_converges_with_order_two(axis, name):
    errors = [abs(standing_wave(axis, spacing) - 1.0) for spacing in (2.5e-4, 1.25e-4)]
    assert errors[1] < 2e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.15), name


@pytest.mark.exact
@pytest.mark.parametrize("axis", [0, 1])
def test_an_absorbing_edge_takes_a_plane_wave(axis):
    """P (axis 0) and S (axis 1) pulses that run into the right edge leave less than 1e-4 of their energy."""
    across = (FREE, FIXED) if axis == 0 else (FIXED, FREE)
    grid = plate(SOLID, 4e-3, 2.5e-4, 2.5e-5, 0.0, [(ABSORBING,) * 2, (ABSORBING,) * 2, across, across])
    x = 2.5e-5 * np.arange(grid.columns)
    speed = SOLID.dilatational_speed if axis == 0 else SOLID.shear_speed
    step = 0.9 * largest_step(grid)
    displacement, velocity = np.zeros((2, 2, grid.rows, grid.columns))
    displacement[axis] = 1e-9 * np.exp(-(((x - 2e-3) / 3e-4) ** 2))
    velocity[axis] = speed * 2 * (x - 2e-3) / 3e-4**2 * displacement[axis]
    start = strain_energy(grid, displacement)
    for _ in range(int(4e-3 / speed / step)):
        step_plate(grid, rims(grid, step), displacement, velocity, step, np.zeros((3, 2, grid.columns)))
    assert strain_energy(grid, displacement) < 1e-4 * start
