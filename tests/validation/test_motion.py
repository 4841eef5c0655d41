"""Motion rows of signals whose figures are known."""

import numpy as np
import pytest

from pipeline.products import Multibody
from pipeline.validation.motion import motion_rows
from tests.views.products_for_views import filled

KNOWN = {"pressure_lowest": 1e6, "pressure_highest": 3e6, "speed_lowest": 8.5, "speed_highest": 12.0}
PRESSURE, SPEED = np.repeat([1e6, 3e6], 2), np.tile([8.5, 12.0], 2)
TIME = np.arange(2000) * 1e-4
GROWTH, FREQUENCY = np.array([-10.0, -5.0, -20.0, 0.0]), 200.0


def motion(**given):
    swing = np.exp(GROWTH[:, None] * TIME) * np.sin(2 * np.pi * FREQUENCY * TIME)
    pads = np.zeros((4, 2, 3, len(TIME)))
    pads[:, 0, 0], pads[:, 1, 0] = swing, 0.5 * swing
    phase = 2 * np.pi * (20 * TIME + 0.25 * np.arange(4)[:, None])
    force = PRESSURE[:, None, None, None] * (1 + 0.5 * np.sin(phase)) * np.ones((1, 2, 1, 1))
    factors = np.array([0.5, 1.0, 2.0])
    stability = 6 * factors[:, None] + 2 * factors + np.zeros((4, 1, 1))
    values = {"pressure": PRESSURE, "speed": SPEED, "time": TIME, "pad_motion": pads, "patch_force": force,
              "growth_rate": GROWTH, "growth_rate_std": np.ones(4), "growth_decided": [1, 1, 1, 0],
              "oscillation_frequency": np.full(4, FREQUENCY), "caliper_factor": factors,
              "abutment_factor": factors, "stability": stability}
    return filled(Multibody, **{**values, **given})


def test_every_row():
    rows = {key: row.value for key, row in motion_rows(motion(), KNOWN).items()}
    omega = 2 * np.pi * FREQUENCY
    assert rows.pop("amplitude_rises_with_pressure") > 2
    assert rows.pop("pads_and_forces_not_correlated") < 0.05
    assert rows == pytest.approx({
        "pressure_lowest": 1e6, "pressure_middle": 2e6, "pressure_highest": 3e6, "speed_lowest": 8.5,
        "speed_highest": 12.0, "operating_points": 4, "sub_discs": 4, "patch_phase_shift": 90,
        "oscillation_not_from_patches": 10, "pads_in_phase": 1, "damped_at_low_load": 10 / omega,
        "critically_stable_at_high_load": 0, "caliper_decides": 3, "forces_rise_with_pressure": 3,
        "pressure_damps_at_low_speed": 10 / omega, "pressure_destabilises_at_high_speed": -5 / omega}, rel=1e-6)


def test_pads_against_each_other_are_not_in_phase():
    against = motion().pad_motion.copy()
    against[:, 1] *= -1
    assert motion_rows(motion(pad_motion=against), KNOWN)["pads_in_phase"].value == pytest.approx(-1)


def test_rows_of_operating_points_that_were_not_run_are_left_out():
    rows = motion_rows(motion(pressure=np.repeat([1.5e6, 3e6], 2)), KNOWN)
    assert "damped_at_low_load" not in rows and "amplitude_rises_with_pressure" not in rows
    assert "critically_stable_at_high_load" in rows


def test_a_growth_rate_within_two_standard_errors_has_no_sign():
    rows = motion_rows(motion(growth_rate_std=np.full(4, 6.0), growth_decided=[0, 0, 1, 0]), KNOWN)
    assert rows["damped_at_low_load"].value is None
    assert rows["damped_at_low_load"].note.endswith("growth rate -10 +- 6 1/s: sign undecided")
    assert rows["critically_stable_at_high_load"].note.endswith("growth rate 0 +- 6 1/s: sign undecided")


def test_nothing_moves():
    """Null test: without motion and without a stability map, rows are open, not numbers."""
    still = motion(pad_motion=np.zeros((4, 2, 3, len(TIME))), oscillation_frequency=np.zeros(4),
                   caliper_factor=[1.0], abutment_factor=[1.0], stability=np.zeros((4, 1, 1)))
    rows = motion_rows(still, KNOWN)
    for key in ("pads_in_phase", "damped_at_low_load", "amplitude_rises_with_pressure", "caliper_decides"):
        assert rows[key].value is None, key
