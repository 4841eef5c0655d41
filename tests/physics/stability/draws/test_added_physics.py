"""What effects add to the sliding state of a draw: laws of contacts, elements at rest, friction that remembers."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.contact.groups import Grouped
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.friction.state_variables import Memory
from pipeline.physics.stability.draws.added_physics import AddedPhysics, acting, resting, slopes_of_elements
from pipeline.physics.stability.draws.scatter import NOMINAL, Factors
from pipeline.physics.stability.linearisation import beside_motion
from pipeline.physics.time_stepping.elements import Element, Maxwell, Polynomial
from pipeline.physics.time_stepping.simulate import Penalty, Table
from tests.physics.stability.draws.scattered_block import LAW, family

AREA = np.full(3, 1e-4)
TABLE, SPRING = Table(*LAW, damping_speed=0.2), Penalty(2e7, 30.0)


@pytest.mark.exact
@pytest.mark.parametrize("law", [TABLE, SPRING, Grouped((TABLE, SPRING), (0, 1, 0))])
@pytest.mark.parametrize("factor", [1.0, 1.7])
def test_a_law_is_steeper_at_the_same_pressure(law, factor):
    """Pressed as far less as it is steeper, it carries the same; its slope is that of its force."""
    added, closure = AddedPhysics(constant(0.4), law), np.array([1.03e-6, 2.11e-6, -1e-7])
    force, slope = added.pressed(AREA, closure)
    steeper, more = added.pressed(AREA, closure / factor, factor)
    np.testing.assert_allclose(steeper, force, rtol=1e-12)
    np.testing.assert_allclose(more, factor * slope, rtol=1e-12)
    ahead, _ = added.pressed(AREA, closure + 1e-12)
    np.testing.assert_allclose((ahead - force) / 1e-12, slope, rtol=1e-3)
    assert force[2] == slope[2] == 0.0
    drawn = Factors(contact_stiffness=factor, damping_speed=2.0)
    stiffness, damping = added.tangent(AREA, force, drawn)
    plain, drag = added.tangent(AREA, force, NOMINAL)
    np.testing.assert_allclose(stiffness, factor * plain)
    np.testing.assert_allclose(damping, drag / 2)
    np.testing.assert_allclose(added.varied(drawn).tangent(AREA, force, NOMINAL), (stiffness, damping))


@pytest.mark.exact
def test_elements_at_rest_resist_with_their_force_and_its_slope():
    made = family()
    row = made.model.joints.rows[0]
    model = replace(made.model, elements=(Element("curved", row, Polynomial(1e6, 0.0, 1e15)),))
    place = 2e-5 * row + 1e-6
    force, slope = resting(model, place)
    moved = float(row @ place)
    np.testing.assert_allclose(force, (1e6 * moved + 1e15 * moved**3) * row, rtol=1e-12)
    np.testing.assert_allclose(slope, (1e6 + 3e15 * moved**2) * np.outer(row, row), rtol=1e-12)
    none = np.zeros(len(made.model.contacts.area))
    np.testing.assert_allclose(slopes_of_elements(model, place, none, none), [[1e6 + 3e15 * moved**2], [0.0]])
    assert resting(made.model, place) == (0.0, 0.0)


def test_only_what_remembers_settles_beside_the_motion():
    model = family().model
    load, count = np.full(len(model.contacts.area), 100.0), len(model.contacts.area)
    plain = AddedPhysics(constant(0.4))
    about = acting(plain.friction, model.direction(), model.contacts.area, load / model.contacts.area,
                   abs(model.sliding_speed))
    np.testing.assert_allclose(about.coefficient, 0.4)

    def beside(added, model):
        return beside_motion(model, about, added.states(model, load))

    assert beside(plain, model) is None
    remembering = AddedPhysics(constant(0.4).with_state(Memory(1e-3)))
    assert beside(remembering, model).decay.size == 2 * count
    branch = replace(model, elements=(Element("pad", model.joints.rows[0], Maxwell(np.array([1e6]),
                                                                                  np.array([1e-4]))),))
    np.testing.assert_allclose(beside(plain, branch).decay, [1e4])


def test_factors_leave_joints_of_effects_as_they_are():
    factors = Factors(joint_stiffness=np.array([2.0, 3.0]), body_loss=np.array([0.5]))
    longer = factors.filled(3, 2)
    np.testing.assert_array_equal(longer.joint_stiffness, [2.0, 3.0, 1.0])
    np.testing.assert_array_equal(longer.body_loss, [0.5, 1.0])
    assert longer.joint_loss == 1.0 and NOMINAL.filled(3, 2) == NOMINAL
