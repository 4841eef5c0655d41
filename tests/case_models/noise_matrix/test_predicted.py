"""Shares by condition, module, band and brake are those of the draws; what lies beyond the friction map."""

from types import SimpleNamespace

import numpy as np

from pipeline.case_models.noise_matrix.predicted import described, outside, predicted
from pipeline.case_models.noise_matrix.schedule import Module, schedule
from tests.stages.small_structure import small_friction_map

NOISY = np.zeros((4, 2, 3, 2), bool)
NOISY[0, :, 0, 0] = NOISY[1, 0, 0, 1] = NOISY[2, :, 1, 0] = NOISY[2, :, 1, 1] = True
APPLICATIONS = np.array([[1, 3, 0], [0, 0, 4]])
SETTINGS = SimpleNamespace(points=2, wheel_radius=0.3, pressure_factor=0.5, level=0.05)
MODULE = {"module": "a", "kind": "drag", "speeds": ["3 km/h", "1200 km/h"], "pressures": ["1 bar", "20 bar"],
          "temperatures": ["50 degC"]}


def test_shares_are_weighted_by_the_applications():
    made = predicted(NOISY, APPLICATIONS)
    np.testing.assert_allclose(made["probability"], [3 / 8, 2 / 8, 0])
    np.testing.assert_allclose(made["module_occurrence"], [(3 / 8 + 3 * 2 / 8) / 4, 0])
    assert made["occurrence"] == np.mean(made["module_occurrence"])
    np.testing.assert_allclose(made["brake_occurrence"], [1 / 8, 1 / 16, 3 / 8, 0])
    np.testing.assert_allclose(made["band_occurrence"], [(2 / 8 + 3 * 2 / 8) / 8, (1 / 8 + 3 * 2 / 8) / 8])
    low, high = np.transpose(made["interval"])
    assert (low <= made["probability"]).all() and (made["probability"] <= high).all() and low[2] == 0 < high[2]
    np.testing.assert_array_equal(made["noisy"], NOISY.any(axis=3).reshape(8, 3))


def test_conditions_beyond_the_map_are_marked():
    """Computed at 0.1 to 1 MPa and 0.1 to 10 m/s; contacts at 100 mm under a wheel of 300 mm."""
    plan = schedule(None, (Module.model_validate(MODULE),))
    law = small_friction_map()
    law = law.__class__(**{**vars(law), "computed_pressure": [1e5, 1e6], "computed_speed": [0.1, 10.0]})
    beyond = outside(law, plan, np.array([0.1]), SETTINGS)
    far = [(c.pressure / 1e5, round(3.6 * c.speed)) for c, b in zip(plan.conditions, beyond, strict=True) if b]
    assert far == [(1, 3), (1, 1200), (20, 1200)]
    assert not outside(None, plan, np.array([0.1]), SETTINGS).any()
    np.testing.assert_allclose(described(plan, SETTINGS)["pad_pressure"], [5e4, 1e6, 5e4, 1e6])
