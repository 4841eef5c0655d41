"""A case about steady sliding: what moves it, and where it comes to rest with laws and elements of effects."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.effect_block import terms
from pipeline.case_models.steady_sliding import (
    branch_stiffness,
    mapped_friction,
    posed,
    refuse_twice,
    sliding_friction,
)
from pipeline.contract import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.sliding.equilibrium import closure_response
from tests.diagnosis.small_rig import effects
from tests.effects.systems import rig
from tests.stages.small_structure import small_friction_map

LOAD, SPEED = np.array([40.0]), 20.0
SETTINGS = SimpleNamespace(damping_speed=10.0, centrifugal=True)
CURVED = {"cubic_stiffness": {"tie": {"coefficient": "1e7 N/m^3"}}}
STIFFER = {"contact_stiffness_law": {"contact": {"exponent": 0.5, "pressure": "20 kPa"}}}


def case(block=None):
    return posed(rig(), 0, SPEED, SETTINGS.damping_speed, terms(effects(block or {})))


def sliding(one, friction=0.3):
    return one.slide(closure_response(one.bench.model), LOAD, constant(friction), friction, SETTINGS)


@pytest.mark.parametrize("block, moved", [
    ({}, False), ({"joint_damping": {"tie": {"damping": "3 N s/m"}}}, False), (CURVED, True), (STIFFER, True),
    ({"viscoelastic_pad": {"tie": {"share": 0.3, "time": "10 ms"}}}, False),
    ({"clearance": {"contact": {"gap": "10 um"}}}, True), ({"coulomb": {"tie": {"force": "3 N"}}}, False)])
def test_laws_and_elements_that_bear_load_move_the_state(block, moved):
    assert case(block).moved is moved


@pytest.mark.exact
def test_both_ways_to_the_sliding_state_agree():
    """An element so soft that it only asks for the other solver."""
    hair = {"cubic_stiffness": {"tie": {"coefficient": "1e-9 N/m^3"}}}
    given, anew = sliding(case()), sliding(case(hair))
    for name in ("force", "stiffness", "closure"):
        np.testing.assert_allclose(getattr(anew.contact, name), getattr(given.contact, name), rtol=1e-8)
    np.testing.assert_allclose(anew.damping, given.damping, rtol=1e-8)


@pytest.mark.exact
@pytest.mark.parametrize("block", [CURVED, STIFFER, CURVED | STIFFER])
def test_static_answers_hold_all_that_rests(block):
    """The state found among static answers is that of all coordinates."""
    whole, condensed = sliding(case(block)), sliding(case(block).condensed())
    assert case(block).condensed().bench.model.size <= case(block).bench.model.size
    np.testing.assert_allclose(condensed.contact.force, whole.contact.force, rtol=1e-9)
    np.testing.assert_allclose(condensed.slopes, whole.slopes, rtol=1e-8)


@pytest.mark.exact
def test_friction_with_effects_comes_on_top_of_the_given():
    falling = case({"falling_friction": {"contact": {"rise": 0.5, "decay_speed": "2 m/s"}}})
    found = falling.friction(constant(0.3)).at_speed(2.0)
    assert found == pytest.approx(0.3 * (1 + 0.5 * np.exp(-1)), rel=1e-4)
    kept = constant(0.3)
    assert case(CURVED).friction(kept) is kept


def test_branches_and_turning_friction():
    pad = case({"viscoelastic_pad": {"tie": {"share": 0.3, "time": "10 ms"}}}).bench.model
    row = pad.joints.rows[pad.joints.name.index("tie")]
    np.testing.assert_allclose(branch_stiffness(pad), 0.3 * 4e3 * np.outer(row, row))
    assert branch_stiffness(case().bench.model) is None
    turning = case({"friction_induced_damping": {"contact": {"share": 1.0}}}).bench
    refuse_twice(turning, False)
    with pytest.raises(ConfigError, match="friction_damping: false"):
        refuse_twice(turning, True)


def test_places_of_all_effects_are_checked():
    with pytest.raises(ConfigError, match="effect wear: location"):
        case({"wear": {"nowhere": {"rate": "1e-12 m^2/N"}}})


@pytest.mark.exact
def test_a_share_of_the_friction_leaves_the_contacts_as_they_are():
    """All that friction adds to the matrices is that share of it, also what settles beside the motion."""
    remembering = case({"falling_friction": {"contact": {"rise": 0.5, "decay_speed": "2 m/s"}},
                        "contact_ageing": {"contact": {"share": 0.1, "speed": "2 m/s", "length": "1 mm"}}})
    whole = sliding(remembering)
    part, model = whole.with_share(0.3), whole.about(remembering.bench.model)
    assert part.contact is whole.contact and part.states is whole.states
    for less, full in zip(model.friction_matrices(part.acting()), model.friction_matrices(whole.acting()), strict=True):
        assert full.any()
        np.testing.assert_allclose(less, 0.3 * full, atol=1e-12 * abs(full).max())
    none, less, full = (s.beside(model) for s in (whole.with_share(0.0), part, whole))
    assert abs(full.push - none.push).max() > 0
    np.testing.assert_allclose(less.push - none.push, 0.3 * (full.push - none.push))
    forgetful = case({"falling_friction": {"contact": {"rise": 0.5, "decay_speed": "2 m/s"}}})
    assert sliding(forgetful).beside(forgetful.bench.model) is None


def test_friction_of_a_map_is_read_at_one_distance():
    """Values of the table at its own points, at the distance between two of them."""
    given = small_friction_map()
    table = np.multiply.outer(given.pressure, np.ones(len(given.speed)))[..., None] * (1 + given.distance / 10) * 1e-7
    given = replace(given, friction=table)
    middle = given.distance[:2].mean()
    friction, state = mapped_friction(given, middle)
    assert friction.distance == middle
    read = state(given.pressure, np.full(len(given.pressure), given.speed[0]))
    np.testing.assert_allclose(read.coefficient, table[:, 0, :2].mean(axis=1))


def test_friction_of_the_map_of_the_settings_or_of_the_model():
    settings = SimpleNamespace(sliding_distance=0.5, friction=0.3, friction_at_rest=None, decay_speed=0.01)
    at, speed = np.full(2, 1e6), np.full(2, 1.0)
    for given, expected in ((small_friction_map(), 0.5), (None, 0.3)):
        friction, state = sliding_friction(given, None, settings)
        assert state(at, speed).coefficient == pytest.approx(expected)
        assert friction.at_speed(speed) == pytest.approx(expected)
    law = SimpleNamespace(shear_pressure=np.array([1e5, 1e7]), shear_friction=np.array([0.4, 0.4]),
                          shear_stiffness=np.array([1e9, 1e9]), shear_elastic_stiffness=np.array([1e9, 1e9]),
                          shear_exponent=np.array([1.0, 1.0]))
    _, state = sliding_friction(None, law, SimpleNamespace(**{**vars(settings), "friction": None}))
    assert state(at, speed).coefficient == pytest.approx(0.4)
    with pytest.raises(ConfigError, match="complex_modes.sliding_distance"):
        sliding_friction(small_friction_map(), None, SimpleNamespace(**{**vars(settings), "sliding_distance": 2.0}))
