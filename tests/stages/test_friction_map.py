"""Stage friction_map: refined table and its CSV companion."""

import csv
import io
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import MicroFriction
from stages.friction_map import Settings, friction_map


@pytest.fixture
def computed():
    pressure, speed, distance = np.array([1e6, 2e6, 3e6]), np.array([1.1, 1.5]), np.array([0.0, 1e-3, 1e-2])
    friction = 0.4 + 0.03e-6 * pressure[:, None, None] + 0.01 * speed[:, None] + 8.0 * distance
    table = dict.fromkeys(("real_area", "wear_depth", "largest_wear", "flash_temperature", "full_slip_distance",
                           "limit_at_speed", "yielding_area"), np.zeros_like(friction))
    maps = dict.fromkeys(("contact_pressure", "pad_wear", "disc_wear"), np.zeros((3, 2, 2)))
    return MicroFriction(settings="", pressure=pressure, speed=speed, disc_speed=speed / 0.128, distance=distance,
                         friction=friction, pair_friction=friction[None],
                         friction_std=friction / 20, normal_stiffness=1e12 * friction,
                         shear_limit=13.5e6, block_compliance=3.5e-12, x=np.arange(2.0), y=np.arange(2.0),
                         nodes_per_wavelength=8.0, refinement=[8.0], refinement_area=[0.03], area_limit=0.03,
                         area_limit_error=0.003, area_order=0.0, bearing_share=[0.0, 1.0], stress_depth=[0.0, 1e-5],
                         **dict.fromkeys(("pad_bearing", "disc_bearing"), np.zeros((3, 2))), stress=np.zeros((2, 2)),
                         stress_largest=np.zeros(2), stress_row=0.0, tangential_stiffness=np.zeros(3),
                         **dict.fromkeys(("presliding_displacement", "presliding_friction"), np.empty((3, 0))),
                         **table, **maps)


def test_computed_points_stay_and_nothing_overshoots(computed):
    parts = Settings(pressure_subdivisions=4, speed_subdivisions=2, distance_subdivisions=5)
    made = friction_map(computed, settings=parts)
    assert made.friction.shape == (9, 3, 11)
    np.testing.assert_allclose(made.friction[::4, ::2, ::5], computed.friction, rtol=1e-14)
    assert made.friction.max() <= computed.friction.max() * (1 + 1e-14)
    np.testing.assert_array_equal(made.computed_speed, computed.speed)
    np.testing.assert_allclose(made.normal_stiffness[::4, ::5], computed.normal_stiffness.mean(axis=1), rtol=1e-14)


def test_a_fitted_law_is_smooth_and_reaches_beyond_the_computed_pressures(computed):
    made = friction_map(computed, settings=Settings(order=1))
    assert made.pressure[0] == 0.5e6 and made.pressure[-1] == 6e6
    inside = np.isin(made.pressure, computed.pressure)
    line = np.polynomial.Polynomial.fit(np.log(computed.pressure), computed.friction[:, 0, 0], 1,
                                        w=1 / computed.friction_std.mean(axis=(1, 2)))
    np.testing.assert_allclose(made.friction[inside, 0, 0], line(np.log(computed.pressure)), rtol=1e-12)
    assert (made.friction_std > 0).all() and (np.diff(made.friction[:, 0, 0]) >= -1e-15).all()
    stiffness = computed.normal_stiffness.mean(axis=1)
    np.testing.assert_allclose(made.normal_stiffness[inside][:, ::5], stiffness, rtol=1e-12)
    np.testing.assert_allclose(made.normal_stiffness[[0, -1]][:, ::5], [stiffness[0] / 2, stiffness[-1]], rtol=1e-12)


@pytest.mark.exact
def test_errors_of_the_slopes_are_those_of_a_weighted_line(computed):
    """In ln p and ln v, and at the pressure where errors of level and slope are uncorrelated: the weighted mean."""
    scattered = replace(computed, friction_std=0.02 * computed.pressure[:, None, None] / 1e6
                        * np.ones_like(computed.friction))
    x, weight = np.log(computed.pressure), 1 / (0.02 * computed.pressure / 1e6) ** 2
    middle = weight @ x / weight.sum()
    exact = 1 / np.sqrt(weight @ (x - middle) ** 2)
    for order in (1, None):
        made = friction_map(scattered, settings=Settings(order=order, pressure_subdivisions=40))
        np.testing.assert_allclose(made.pressure_slope_std, exact, rtol=0.02)
    made = friction_map(scattered, settings=Settings(order=1, pressure_subdivisions=40))
    np.testing.assert_allclose(np.log(made.best_pressure), middle, atol=0.03)
    error = 1 / np.sqrt(weight.sum())
    np.testing.assert_allclose(made.speed_slope_std, error / np.log(1.5 / 1.1) * np.sqrt(2), rtol=0.02)


def test_csv_holds_every_point_with_units(computed):
    made = friction_map(computed, settings=Settings())
    rows = list(csv.reader(io.StringIO(friction_map.companions(made)["friction_map.csv"])))
    assert rows[0] == ["pressure [Pa]", "speed [m/s]", "distance [m]", "friction [1]", "friction_std [1]"]
    table = np.array(rows[1:], dtype=float)
    assert len(table) == made.friction.size
    np.testing.assert_allclose(table[:, 3].reshape(made.friction.shape), made.friction, rtol=1e-9)
    np.testing.assert_allclose(table[-1, :3], [3e6, 1.5, 1e-2], rtol=1e-9)


@pytest.mark.exact
def test_errors_of_slopes_are_those_of_pairs_whose_friction_moves_together(computed):
    """Pairs that differ by a level alone have no error of a slope, however large that of their friction."""
    level = np.array([-0.05, 0.0, 0.05])[:, None, None, None]
    alike = replace(computed, pair_friction=computed.friction + level,
                    friction_std=np.full(computed.friction.shape, 0.03))
    tilt = 0.02 * level / 0.05 * np.log(computed.pressure / 2e6)[:, None, None]
    for order in (None, 1):
        made = friction_map(alike, settings=Settings(order=order))
        np.testing.assert_allclose(made.pressure_slope_std, 0, atol=1e-12)
        np.testing.assert_allclose(made.speed_slope_std, 0, atol=1e-12)
        tilted = replace(alike, pair_friction=computed.friction + level + tilt)
        made = friction_map(tilted, settings=Settings(order=order))
        np.testing.assert_allclose(made.pressure_slope_std, 0.02 / np.sqrt(3), rtol=1e-9)
        np.testing.assert_allclose(made.error_correlation[:, 0, 1], 1, atol=1e-9)


@pytest.mark.exact
def test_the_error_of_a_fitted_law_is_that_of_what_pairs_give(computed):
    """Pairs that differ by a level alone: the law differs by that level, however many points it is fitted to."""
    level = np.array([-0.05, 0.0, 0.05])[:, None, None, None]
    alike = replace(computed, pair_friction=computed.friction + level,
                    friction_std=np.full(computed.friction.shape, 0.05 / np.sqrt(3)))
    made = friction_map(alike, settings=Settings(order=1))
    inside = np.isin(made.pressure, computed.pressure)
    np.testing.assert_allclose(made.friction_std[inside], 0.05 / np.sqrt(3), rtol=1e-9)


def test_a_law_without_errors_is_refused_before_anything_is_computed():
    for pairs, realisations in ((1, 2), (2, 1), (1, 1)):
        sections = {"surface": SimpleNamespace(pairs=pairs), "friction_map": Settings(order=2),
                    "micro_friction": SimpleNamespace(realisations=realisations, softening=5e-4)}
        if pairs * realisations > 1:
            friction_map.check(sections)
            continue
        with pytest.raises(ConfigError, match="friction_map.order: expected none, or two or more surface.pairs"):
            friction_map.check(sections)
        friction_map.check(sections | {"friction_map": Settings()})
