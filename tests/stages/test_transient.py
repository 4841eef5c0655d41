"""The stage transient on small models: a sliding mass, a flutter pair, no contact at all."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.errors import ConvergenceError
from pipeline.products import ReducedModel
from stages.reduced_model import NO_SHEAR
from stages.squeal import Settings as SquealSettings
from stages.squeal import squeal
from stages.transient import Settings, transient
from tests.diagnosis.small_rig import effects
from tests.stages.small_brake import small_brake
from tests.views.products_for_views import filled

QUICK = {"step": "10 us", "duration": "0.3 s", "window": "0.1 s", "record_every": 2, "lowest_frequency": "20 Hz"}


def pair(contacts=1, law=()):
    """Two coupled modes of 1 kg near 160 Hz over a belt: x along it, y onto it; 1 N of load per pascal."""
    stiffness = np.array([[1.1e6, 1e5], [1e5, 1.2e6 - 4e5]])
    normal, tangent = ([[0.0, 1.0]], [[-1.0, 0.0]]) if contacts else (np.zeros((0, 2)), np.zeros((0, 2)))
    return filled(
        ReducedModel, body_name=["pair"], coordinate_body=[0, 0], mass=np.eye(2), stiffness=stiffness,
        damping=np.diag([4.0, 4.0]), joint_rows=np.zeros((0, 2)), joint_name=[], contact_normal=normal,
        contact_tangent=tangent, contact_lateral=0 * np.array(normal), contact_area=np.ones(contacts),
        contact_lever=np.ones(contacts), pressure=[100.0, 400.0], preload=np.zeros((2, contacts)),
        contact_stiffness=np.zeros((2, contacts)), contact_position=np.zeros((contacts, 3)),
        contact_body=np.zeros(contacts, int), law_closure=law, law_pressure=4e5 * np.array(law), **NO_SHEAR,
        input_name=["load"], input_rows=[[0.0, -1.0]], input_area=[1.0], input_history=np.empty((0, 1)),
        drive_history=[], sensor_name=["x", "y"], sensor_rows=np.eye(2), sensor_position=np.zeros((2, 3)))


def move(model=None, added=None, **settings):
    chosen = {**QUICK, "speeds": ["3 rad/s"], "contact": "penalty", "contact_stiffness": "0.4 N/um", "friction": 0.3,
              **settings}
    return transient(pair() if model is None else model, added, settings=Settings.model_validate(chosen))


CYCLING = {"friction": 0.6, "friction_at_rest": 0.6, "contact_damping": "100 N s/m", "speeds": ["20 mrad/s"],
           "duration": "1 s", "window": "0.3 s"}


def growing_root(friction=0.6, damping=100.0):
    """Root (1/s) of the growing mode of ``pair`` about steady sliding."""
    stiffness = pair().stiffness + 4e5 * np.array([[0, -friction], [0, 1]])
    drag = 4 * np.eye(2) + damping * np.array([[0, -friction], [0, 1]])
    roots = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -drag]]))
    return max(roots, key=lambda s: (s.real, s.imag))


def test_flutter_grows_as_its_root_into_a_stick_slip_cycle_that_has_settled():
    """The belt sets the size of a cycle that sticks: the load makes no difference."""
    found = move(**CYCLING)
    assert found.velocity.shape[:2] == (2, 2) and list(found.pressure) == [100.0, 400.0]
    assert found.settled.all() and found.grew.all()
    np.testing.assert_allclose(found.growth_rate, growing_root().real, rtol=0.03)
    np.testing.assert_allclose(found.cycle_frequency, growing_root().imag / (2 * np.pi), rtol=0.03)
    np.testing.assert_allclose(found.cycle_amplitude[1], found.cycle_amplitude[0], rtol=1e-3)
    assert 0.02 <= found.cycle_amplitude[0, 0] < 0.025
    np.testing.assert_allclose(found.harmonic_amplitude[..., 0], found.cycle_amplitude, rtol=0.02)
    assert np.all(found.imbalance < 0.005) and np.all(found.status_share[:, 0, 1] > 0.05)
    peak = found.frequency[found.velocity_spectrum[0, 0].argmax()]
    assert peak == pytest.approx(found.cycle_frequency[0, 0], abs=5)
    np.testing.assert_allclose(found.status_share.sum(axis=2), 1)


def test_falling_friction_as_an_effect_is_that_of_the_settings():
    """mu (1 + r exp(-v / v_s)): the table of the effect and that of the settings agree to their interpolation."""
    short = {"speeds": ["0.2 rad/s"], "decay_speed": "0.1 m/s", "duration": "0.1 s", "window": "0.02 s"}
    falling = effects({"falling_friction": {"contact": {"rise": 0.5, "decay_speed": "0.1 m/s"}}})
    given = move(friction=0.3, friction_at_rest=0.45, **short)
    added, plain = move(friction=0.3, added=falling, **short), move(friction=0.3, **short)
    change = abs(given.velocity - plain.velocity).max()
    assert change > 0 and abs(added.velocity - given.velocity).max() < 0.02 * change


def test_an_effect_of_a_sensor_is_refused_where_nothing_is_recorded():
    with pytest.raises(ConfigError, match="effects.sensor_gain"):
        move(added=effects({"sensor_gain": {"x": {"error": 0.1}}}))


def test_a_cycle_with_contact_loss_that_wanders_says_so():
    found = move(friction=0.4, friction_at_rest=0.4, duration="1.5 s", window="0.3 s")
    assert found.grew.all() and not found.settled.any() and np.all(found.cycle_drift > 0.05)
    assert np.all(found.status_share[..., 0] > 0.1)


def test_a_window_in_growth_says_that_it_has_not_settled():
    found = move(friction=0.6, friction_at_rest=0.6, duration="0.12 s", kick="1 um/s")
    assert not found.settled.any() and np.all(found.cycle_drift > 0.1)


def test_below_the_threshold_the_kick_dies():
    found = move(friction=0.2, friction_at_rest=0.2, duration="1 s", speeds=["3 rad/s", "-3 rad/s"])
    assert len(found.pressure) == 4 and not found.grew.any()
    assert np.abs(found.velocity[..., -100:]).max() < 0.2 * np.abs(found.velocity[..., :100]).max()


@pytest.mark.parametrize("settings", [
    {"contact": "hard"}, {"contact": "forward"}, {"contact": "lagrange", "gamma": 0.6},
    {"contact": "table", "damping_speed": "0.5 m/s"}, {"start": "rest"},
    {"description": "elastic", "tangential_stiffness": "1 N/um"},
    {"description": "evolution", "tangential_stiffness": "1 N/um", "exponent": 2}])
def test_every_contact_and_friction_carries_the_load(settings):
    found = move(pair(law=[0.0, 1e-2]), friction=0.1, friction_at_rest=0.1, **settings)
    expected = np.linalg.solve([[1.1e6, 1e5 + 0.1 * 4e5], [1e5, 1.2e6]], [0.0, -100.0])[1] * -4e5
    if settings.get("contact") in ("hard", "lagrange", "forward"):     # y = 0: x = -0.1 N / k11, N = 100 + k12 x
        expected = 100 / (1 + 0.1 * 1e5 / 1.1e6)
    assert found.normal_force[0, 0, -2000:].mean() == pytest.approx(expected, rel=0.03)


def test_no_contact_at_all():
    found = move(pair(contacts=0), start="rest", kick="1 mm/s")
    assert found.normal_force.shape[1] == 0 and np.abs(found.velocity).max() > 1e-4
    angular = np.sqrt(np.linalg.eigvalsh(pair(0).stiffness)) / (2 * np.pi)
    assert np.abs(found.cycle_frequency[0, 0] - angular).min() < 1


def test_the_same_settings_give_the_same_bits_and_another_seed_does_not():
    first, second, other = (move(friction=0.6, friction_at_rest=0.6, seed=s).velocity for s in (1, 1, 2))
    np.testing.assert_array_equal(first, second)
    assert np.any(first != other)


def test_the_small_brake_slides_by_its_own_law():
    found = move(small_brake(), contact="table", speeds=["10 rad/s"], step="1 us", duration="20 ms", window="10 ms",
                 record_every=10, lowest_frequency="500 Hz")
    np.testing.assert_allclose(found.normal_force[:, :3].sum(axis=1).mean(axis=-1), [900, 2700], rtol=0.05)


def test_squeal_is_found_in_the_motion():
    motion = move(**CYCLING)
    found = squeal(motion, settings=SquealSettings.model_validate(
        {"lowest_frequency": "100 Hz", "highest_frequency": "500 Hz", "window": "50 ms", "settling": "0.7 s",
         "lowest_fundamental": "100 Hz", "threshold": "1 mm/s"}))
    np.testing.assert_allclose(found.peak_frequency, motion.cycle_frequency, atol=4)
    assert {*found.event_operating} == {0, 1} and found.coupling == "transient"


@pytest.mark.parametrize("settings, said", [
    ({"contact": "table"}, "no law comes with the contacts"),
    ({"step": "5 ms", "duration": "2 s", "window": "1 s"}, "highest mode"),
    ({"contact_stiffness": "1e9 N/um"}, "soften"), ({"window": "0.2 ms"}, "samples")])
def test_what_does_not_fit_is_refused(settings, said):
    with pytest.raises(ConfigError, match=said):
        move(**settings)


def test_friction_and_stiffness_come_from_the_model_where_the_settings_leave_them_out():
    """The law of the model, typed in, gives the same motion; another law another one."""
    def own(friction, stiffness):
        law = {f"shear_{name}": [value] * 2 for name, value in (
            ("friction", friction), ("stiffness", stiffness), ("elastic_stiffness", stiffness / 2), ("exponent", 0.5))}
        return replace(pair(), **law, shear_pressure=[1.0, 1e3], preload=[[100.0], [400.0]],
                       contact_stiffness=np.full((2, 1), 4e5))

    absent = dict.fromkeys(("contact_stiffness", "friction"))
    for description, stiffness in (("rigid", "1 N/m"), ("elastic", "0.5 N/um"), ("evolution", "1 N/um")):
        kept = {"description": description, "duration": "0.2 s"}
        found, other = (move(own(*law), **absent, **kept).velocity for law in ((0.55, 1e6), (0.5, 2e6)))
        typed = move(friction=0.55, tangential_stiffness=stiffness, exponent=0.5, **kept).velocity
        np.testing.assert_allclose(found, typed, atol=1e-9 * np.abs(typed).max())
        assert np.abs(found - other).max() > 0.01 * np.abs(found).max()


@pytest.mark.parametrize("settings, said", [
    ({"friction": None}, "tangential law"), ({"friction": None, "friction_at_rest": 0.3}, "give both"),
    ({"description": "elastic"}, "tangential law")])
def test_a_model_without_a_law_of_its_own_says_what_is_missing(settings, said):
    with pytest.raises(ConfigError, match=said):
        move(**settings)


def test_friction_that_locks_is_told():
    with pytest.raises(ConvergenceError, match="locks"):
        move(friction=60.0, friction_at_rest=60.0, speeds=["-3 rad/s"])
