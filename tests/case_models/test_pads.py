"""Effects on the pads of a disc brake, as the stage multibody has them."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from stages.multibody import multibody
from tests.diagnosis.small_rig import effects
from tests.effects.systems import system
from tests.stages.small_brake import small_brake, small_map
from tests.stages.test_complex_modes import changed

BRAKE = "brake multibody"


def braking(block=None, friction_map=None, model=None, **settings):
    one = system(BRAKE)
    return multibody(model or one.model, friction_map or small_map(), effects(block or {}),
                     settings=one.settings.model_copy(update=settings))


def same(one, other, rtol=1e-9):
    """Fields are the same up to rounding; growth rates are those of a chaotic envelope no longer."""
    for field in ("pad_motion", "patch_force", "friction_force", "mean_friction", "stability"):
        there = getattr(other, field)
        np.testing.assert_allclose(getattr(one, field), there, rtol=rtol, atol=rtol * np.abs(there).max())


def halved():
    whole = small_map()
    return replace(whole, friction=whole.friction / 2)


@pytest.mark.exact
def test_fog_that_halves_friction_is_a_map_of_half_the_friction():
    damp = {"moisture": {"contact": {"slope": -1.0}}, "conditions": {"humidity": 1.0}}
    same(braking(damp), braking(friction_map=halved()))


@pytest.mark.exact
def test_groups_add_up_to_all_contacts():
    falling = {"rise": 0.3, "decay_speed": "0.5 m/s"}
    same(braking({"falling_friction": {"pad_outer": falling, "pad_inner": falling}}),
         braking({"falling_friction": {"contact": falling}}))
    assert np.any(braking({"falling_friction": {"pad_outer": falling}}).mean_friction
                  != braking({"falling_friction": {"contact": falling}}).mean_friction)


@pytest.mark.exact
def test_contact_damping_joins_that_of_the_settings():
    """1 / v_0 grows by the loss."""
    damped = {"contact_damping": {"contact": {"loss": "0.5 s/m", "length": "1 mm"}}}
    same(braking(damped), braking(damping_speed=1 / 1.5))


@pytest.mark.exact
def test_a_joint_changed_by_an_effect_is_that_joint():
    model = small_brake()
    pin = np.array(model.joint_name) == "guide_pin"
    softer = changed(model, joint_stiffness=np.where(pin, model.joint_stiffness / 1.2, model.joint_stiffness))
    own = float(model.joint_stiffness[pin][0])
    arm = {"compliance": f"{0.2 / own!r} m/N", "behind": 0.0}
    same(braking({"compliant_arm": {"guide_pin": arm}}), braking(model=softer))


def test_runout_moves_the_pads_and_leaves_the_stability_map_alone():
    found = braking({"runout": {"contact": {"amplitude": "50 um", "order": 8.0, "phase": "90 deg"}}})
    plain = braking()
    axial = 1
    swing, before = (np.ptp(one.pad_motion[..., axial, :], axis=-1).max() for one in (found, plain))
    assert swing > 100 * before
    np.testing.assert_array_equal(found.stability, plain.stability)


def test_what_does_not_act_is_refused_or_left_out_by_name():
    name = "friction_induced_damping"
    block = {name: {"contact": {"share": 1.0}}}
    with pytest.raises(ConfigError, match=f"effects.{name}: expected .*stage multibody.*without: .{name}"):
        braking(block)
    same(braking(block, without=(name,)), braking(), rtol=0)


def test_friction_that_jumps_is_refused():
    with pytest.raises(ConfigError, match="effects.dahl: expected .*stage multibody.*jumps where the motion turns"):
        braking({"dahl": {"piston": {"force": "1 N", "length": "1 um"}}})


@pytest.mark.parametrize("block", [
    {"wear": {"contact": {"rate": "1e-12 m^2/N"}}}, {"contact_memory": {"contact": {"length": "1 mm"}}},
    {"viscoelastic_pad": {"piston": {"share": 0.3, "time": "1 ms"}}}])
def test_what_remembers_acts_alike_in_both_integrators(block):
    compiled, multibody = braking(block), braking(block, integrator="exudyn")
    plain, size = braking(), np.abs(compiled.pad_motion).max()
    moved = np.abs(compiled.pad_motion - plain.pad_motion).max()
    assert np.abs(multibody.pad_motion - compiled.pad_motion).max() < min(1e-6 * size, 1e-2 * moved)
    assert np.abs(multibody.normal_force - compiled.normal_force).max() < 1e-4 * compiled.normal_force.max()


def test_an_effect_of_the_flexible_disc_alone_is_refused():
    with pytest.raises(ConfigError, match="changes nothing at disc"):
        braking({"attached_mass": {"disc": {"mass": "0.1 kg"}}})


def test_the_names_left_out_are_those_of_the_catalogue():
    with pytest.raises(ConfigError, match="did you mean 'wear'"):
        braking(without=("waer",))
