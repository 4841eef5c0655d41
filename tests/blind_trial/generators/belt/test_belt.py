"""A rig on a belt: dragged as dry friction drags, changed by what is hidden, apart from what solves it."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.belt import belt
from pipeline.blind_trial.generators.belt.hidden_friction import Contact, Rubbed, plain
from pipeline.blind_trial.generators.spring_mass.motion import World, moved
from pipeline.blind_trial.generators.spring_mass.rig import Rig
from pipeline.contract.errors import ConfigError
from tests.blind_trial.generators.imported import imported


@pytest.fixture(scope="module")
def control():
    return belt.made(1, level=0.01)


@pytest.mark.exact
def test_a_free_mass_is_dragged_until_it_moves_with_the_belt():
    """x = mu N t^2 / 2 m up to the speed of the belt, then x' = V; drawn friction is blunt near no slip."""
    contact, run, speed = Contact(0.3, 0.01, 8.0, 5.0, (0.5,) * 3), Rubbed(0.25, 8.0, 0.5), 0.6
    law = belt.dragging(plain(contact), run, np.full(200, speed), 1)
    found = moved(World(Rig((2.0,), ()), (law,)), np.zeros(200), 1 / belt.RATE, 1e4)[0]
    time = np.linspace(0, 1.99, len(found))
    turn = speed * 2.0 / (0.25 * 8.0)
    exact = np.where(time < turn, 0.5 * time**2, 0.5 * turn**2 + speed * (time - turn))
    np.testing.assert_allclose(found, exact, atol=2e-3)


def test_a_control_is_repeatable_starts_from_rest_and_believes_other_values(control):
    again = belt.made(1, level=0.01)
    assert all(np.array_equal(a, b) for one, other in zip(control.runs, again.runs, strict=True)
               for a, b in zip(one, other, strict=True))
    assert control.kind == "control" and control.change == 0 and all(w[0] == 0 for _, w, _ in control.runs)
    assert 0.09 < abs(np.log(control.believed / control.belt.friction)) < 0.27


def test_what_is_hidden_in_the_contact_changes_the_motion_as_wanted(control):
    found = belt.made(1, ("pressure_dependent_friction",), change=0.1)
    assert 0.07 < found.change < 0.14 and found.left[0] > 20 and found.planted[0].place == "contact"
    assert found.belt.truth == control.belt.truth


def test_unknown_physics_is_refused_and_classes_are_told():
    with pytest.raises(ConfigError, match="falling_friction"):
        belt.made(1, ("gravity",))
    assert [belt.kind_of(h) for h in ((), ("viscous",), ("patchy",), ("viscous", "backlash"))] == [
        "control", "effect", "foreign", "pair"]


def test_the_wrong_value_is_friction_or_one_of_the_rig(control):
    found = {belt._believed(np.random.default_rng(k), control.belt, (), "wrong_value")[2] for k in range(20)}
    assert "friction" in found and len(found) > 2


def test_it_is_not_made_of_what_solves_it():
    assert not [m for m in imported("pipeline.blind_trial.generators.belt.belt") if m.startswith((
        "pipeline.effects", "pipeline.case_models", "pipeline.diagnosis", "pipeline.inference", "pipeline.physics"))]
