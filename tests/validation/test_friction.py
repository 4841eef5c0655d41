"""Friction rows of a table whose figures are known."""

import numpy as np
import pytest

from pipeline.products import MicroFriction
from pipeline.validation.friction import friction_rows
from tests.views.products_for_views import filled

KNOWN = {"pressure_lowest": 1e6, "pressure_highest": 3e6, "speed_lowest": 8.0, "speed_highest": 12.0,
         "distance_first": 3e-4, "distance_middle": 5e-3, "distance_last": 1e-2, "wear_iterations": 200}
PRESSURE, SPEED, DISTANCE = np.array([1e6, 2e6, 3e6]), np.array([8.0, 12.0]), np.array([0.0, 1e-3, 1e-2])
RUN = DISTANCE / DISTANCE[-1]


def table(**given):
    """mu = .4 + .02 per MPa + .15 over the run + .001 per speed; area 3 % per MPa growing by 2 % per MPa."""
    p, v = np.arange(3)[:, None, None], np.arange(2)[:, None]
    values = {"pressure": PRESSURE, "disc_speed": SPEED, "distance": DISTANCE,
              "friction": 0.4 + 0.02 * p + 0.15 * RUN + 0.001 * v, "real_area": (p + 1) * (0.03 + 0.02 * RUN) + 0 * v,
              "wear_depth": 7e-7 * RUN + 0 * p + 0 * v, "largest_wear": 6e-6 * RUN + 0 * p + 0 * v}
    return filled(MicroFriction, **{**values, **given})


def test_every_row():
    rows = {key: row.value for key, row in friction_rows(table(), KNOWN).items()}
    expected = {
        "micro_pressures": 3, "micro_speeds": 2, "distance_last": 1e-2, "real_area_start": 0.03,
        "real_area_rises_with_pressure": 1.5, "largest_wear_first": 6e-6 / 200,
        "friction_pressure_difference_start": 0.04, "friction_speed_over_pressure": 0.001 / 0.04,
        "real_area_growth": 0.02, "real_area_growth_rises_with_pressure": 3, "wear_depth": 7e-7,
        "wear_depth_over_pressure": 0, "largest_wear_last": 6e-6, "friction_pressure_difference_end": 0.04,
        "friction_lowest": 0.4, "friction_highest": 0.591, "friction_rises_with_pressure": 0.02,
        "friction_rises_with_distance": 0.15 * 0.97, "friction_distance_over_pressure": 0.15 * 0.97 / 0.04,
        "friction_follows_real_area": 1}
    assert rows == pytest.approx(expected, abs=1e-12)


def test_points_beyond_the_paper_change_no_row_but_their_number():
    """One more pressure and speed at either end, with friction, area and wear far from all others."""
    given = {name: np.pad(getattr(table(), name), ((1, 1), (1, 1), (0, 0)), constant_values=9.0)
             for name in ("friction", "real_area", "wear_depth", "largest_wear")}
    wider = table(pressure=[5e5, *PRESSURE, 6e6], disc_speed=[6.5, *SPEED, 14.5], **given)
    counts = {"micro_pressures": 5, "micro_speeds": 4}
    expected = {key: row.value for key, row in friction_rows(table(), KNOWN).items()} | counts
    assert {key: row.value for key, row in friction_rows(wider, KNOWN).items()} == expected


def test_nothing_within_the_paper_leaves_every_row_open():
    rows = friction_rows(table(pressure=10 * PRESSURE), KNOWN)
    assert rows.keys() == friction_rows(table(), KNOWN).keys()
    assert rows["friction_lowest"].value is None and rows["real_area_start"].value is None
    assert "within the paper's pressures" in rows["friction_lowest"].note


def test_short_run_leaves_the_rows_of_the_end_open():
    rows = friction_rows(table(distance=DISTANCE / 10), KNOWN)
    assert rows["wear_depth"].value is None and "1 mm" in rows["wear_depth"].note
    assert rows["real_area_start"].value == pytest.approx(0.03)


def test_one_pressure_says_nothing_about_pressure():
    full = table()
    rows = friction_rows(table(pressure=PRESSURE[1:2], **{name: getattr(full, name)[1:2] for name in (
        "friction", "real_area", "wear_depth", "largest_wear")}), KNOWN)
    for key in ("real_area_start", "real_area_rises_with_pressure", "friction_pressure_difference_start",
                "friction_rises_with_pressure", "friction_distance_over_pressure", "real_area_growth"):
        assert rows[key].value is None, key
    assert rows["friction_lowest"].value == pytest.approx(0.42)
