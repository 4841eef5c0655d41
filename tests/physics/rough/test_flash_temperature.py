"""Moving heat source: the wave solution, the slow limit, and spots that share their heat."""

import numpy as np
import pytest

from pipeline.physics.rough.flash_temperature import ThermalSolid, spot_heating, surface_rise

IRON, LINING = ThermalSolid(50.0, 7200.0, 500.0), ThermalSolid(1.0, 2200.0, 1000.0)
NODES, LENGTH = 64, 1e-3
SPACING = (LENGTH / NODES,) * 2
WAVE = 2 * np.pi * 2 / LENGTH
X = np.arange(NODES) * SPACING[1]


@pytest.mark.exact
def test_resting_wave_of_heat():
    flux = np.tile(np.cos(WAVE * X), (NODES, 1))
    np.testing.assert_allclose(surface_rise(flux, SPACING, IRON, 0.0), flux / (50.0 * WAVE), atol=1e-9 / (50.0 * WAVE))


@pytest.mark.exact
def test_fast_wave_of_heat_is_one_eighth_of_a_turn_late():
    """root -> sqrt(i k v / a): amplitude 1 / (K sqrt(k v / a)), phase 45 degrees."""
    speed = 1e4
    rise = surface_rise(np.tile(np.cos(WAVE * X), (NODES, 1)), SPACING, IRON, speed)
    amplitude = 1.0 / (50.0 * np.sqrt(WAVE * speed / IRON.diffusivity))
    np.testing.assert_allclose(rise[0], amplitude * np.cos(WAVE * X - np.pi / 4), atol=1e-3 * amplitude)


def test_heat_trails_behind_the_moving_spot():
    flux = np.zeros((NODES, NODES))
    flux[30:34, 30:34] = 1.0
    profile = surface_rise(flux, SPACING, IRON, 2.0)[31]
    assert profile[36] > profile[27]


def test_the_better_conductor_takes_the_heat():
    mask = np.zeros((NODES, NODES), dtype=bool)
    mask[30:34, 30:34] = True
    both, = spot_heating(mask, SPACING, LINING, IRON, [1.3])
    only_disc = surface_rise(np.where(mask, 1.3, 0.0), SPACING, IRON, 1.3)[mask].mean()
    assert 0.8 * only_disc < both < only_disc


def test_no_speed_no_heat():
    slow, fast = spot_heating(np.eye(NODES, dtype=bool), SPACING, LINING, IRON, [1e-9, 1.0])
    assert slow < 1e-6 * fast


@pytest.mark.exact
@pytest.mark.parametrize("shape", [(64, 64), (48, 63)])
def test_heating_of_spots_is_the_mean_of_the_map_of_their_rise(shape):
    mask, speeds = np.random.default_rng(3).random(shape) < 0.1, [0.4, 1.3, 20.0]
    rest, passed = ([surface_rise(np.where(mask, speed, 0.0), SPACING, solid, over)[mask].mean()
                     for speed, over in zip(speeds, way, strict=True)]
                    for solid, way in ((LINING, [0.0] * 3), (IRON, speeds)))
    expected = np.multiply(rest, passed) / np.add(rest, passed)
    np.testing.assert_allclose(spot_heating(mask, SPACING, LINING, IRON, speeds), expected, rtol=1e-12)
