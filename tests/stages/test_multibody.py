"""Stage multibody on a brake of lumps: shape of the product, static start, friction, stability, determinism."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from stages.multibody import Settings, multibody
from tests.stages.small_brake import CONTACT_AREA, small_brake, small_map

QUICK = {"pressures": ("1 MPa", "3 MPa"), "speeds": ("8.5 rad/s",), "duration": "20 ms", "settling": "2 ms",
         "lowest_frequency": "350 Hz",
         "caliper_factors": (1.0, 2.0), "abutment_factors": (0.5, 1.0, 2.0)}


def run(model=None, **changed):
    return multibody(model or small_brake(), small_map(), settings=Settings(**{**QUICK, **changed}))


@pytest.fixture(scope="module")
def outcome():
    return run()


def test_every_operating_point_and_pad_is_there(outcome):
    assert outcome.pressure.tolist() == [1e6, 3e6] and outcome.speed.tolist() == [8.5, 8.5]
    assert outcome.pad_name.tolist() == ["outer", "inner"]
    assert outcome.pad_motion.shape == (2, 2, 3, 2001) and outcome.patch_force.shape == (2, 2, 4, 2001)
    assert outcome.time[-1] == pytest.approx(0.02) and outcome.stability.shape == (2, 2, 3)
    assert outcome.stability_root.shape == (2, 2, 3) and (outcome.stability_root < 10e3).all()
    assert (outcome.growth_rate_std >= 0).all() and set(outcome.growth_decided) <= {0, 1}


@pytest.mark.exact
def test_the_run_starts_in_frictionless_balance_with_the_piston(outcome):
    for point, pressure in enumerate(outcome.pressure):
        inner = outcome.normal_force[point, 3:, 0]
        np.testing.assert_allclose(inner, inner.mean(), rtol=1e-5)
        assert inner.mean() == pytest.approx(pressure * CONTACT_AREA, rel=0.1)
        assert not outcome.friction_force[point, :, 0].any()


@pytest.mark.exact
def test_sub_discs_share_the_force_of_each_pad(outcome):
    expected = outcome.normal_force.reshape(2, 2, 3, -1).sum(axis=2)
    np.testing.assert_allclose(outcome.patch_force.sum(axis=2), expected, rtol=1e-5)


@pytest.mark.exact
def test_friction_drags_the_pads_along_by_its_sum_over_the_abutment():
    outcome = run(small_brake(damping=2e-4), pressures=("1 MPa",), duration="60 ms", integrator="newmark")
    drag = outcome.friction_force[0].reshape(2, 3, -1).sum(axis=1)
    np.testing.assert_allclose(outcome.pad_motion[0, :, 0, -1], drag[:, -1] / 3e6, rtol=1e-3)
    assert 0.35 < outcome.mean_friction[0] < 0.55


@pytest.mark.exact
def test_the_energy_balance_closes(outcome):
    given = outcome.input_work + outcome.normal_work + outcome.friction_work + outcome.element_work
    lost = outcome.damping_loss + outcome.stored_energy
    np.testing.assert_allclose(lost, given, rtol=1e-4)
    assert (outcome.imbalance < 1e-3).all() and not outcome.element_work.any()
    assert (outcome.sliding_loss > 0).all() and (outcome.added_loss >= 0).all() and (outcome.added_loss < 1).all()


def test_more_pressure_gives_more_friction_as_the_map_says(outcome):
    assert outcome.mean_friction[1] > outcome.mean_friction[0] + 0.01


def test_the_transient_grows_or_decays_as_the_linearised_system_says():
    outcome = run(small_brake(damping=1e-5), pressures=("1 MPa",), duration="60 ms", integrator="newmark",
                  caliper_factors=(1.0,), abutment_factors=(1.0,))
    assert outcome.stability[0, 0, 0] < 0 and outcome.growth_rate[0] < 0


def test_both_integrators_agree(outcome):
    other = run(integrator="newmark")
    scale = np.abs(outcome.pad_motion).max()
    assert np.abs(other.pad_motion - outcome.pad_motion).max() < 1e-6 * scale


def test_the_same_settings_give_the_same_bits(outcome):
    again = run()
    for name in ("pad_motion", "patch_force", "normal_force", "growth_rate", "stability"):
        np.testing.assert_array_equal(getattr(again, name), getattr(outcome, name))


def test_caliper_and_abutment_count(outcome):
    assert np.ptp(outcome.stability, axis=(1, 2)).min() > 1e-3
    assert np.abs(run(small_brake(finger=3e7)).pad_motion - outcome.pad_motion).max() > 1e-8


@pytest.mark.parametrize(("changed", "message"), [
    ({"sectors": 18}, "multiple of 4"), ({"bedding": ("1 mm",)}, "one per sub-disc"),
    ({"duration": "4 ms"}, "periods of the lowest"),
    ({"step": "6 us"}, "highest frequency turns by 0.4 rad"),
])
def test_wrong_settings_are_refused(changed, message):
    with pytest.raises(ConfigError, match=message):
        run(**changed)
