"""Terms of small motions: what settles, in other coordinates and where a contact cannot yield."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant, tabulated
from pipeline.physics.friction.state_variables import Memory
from pipeline.physics.stability.linearisation import friction_about, maxwell_branches, present, settling
from pipeline.physics.time_stepping.elements import Element, Maxwell
from tests.physics.lumps import belt

LOAD, AREA = np.array([20.0]), np.array([1.0])


def about(friction, **contacts):
    """(model with a yielding contact, FrictionState, states) of a mass on a belt at 0.5 m/s."""
    model = belt(400.0, 0.5, speed=0.5)
    model = replace(model, contacts=replace(model.contacts, **{"preload": LOAD, "stiffness": np.array([1e4]),
                                                               "damping": np.array([3.0]), **contacts}))
    return model, *friction_about(friction, np.array([0.5]), LOAD, AREA)


@pytest.mark.exact
def test_memory_hears_load_and_speed_over_its_length():
    """z' = (v / L) (dN - z), dN = -k n q - c n q': friction of full memory acts through its states alone."""
    falling = tabulated([0.0, 1.0], [0.4, 0.2]).with_state(Memory(0.1))
    model, whole, states = about(falling)
    assert whole.coefficient == pytest.approx(0.3) and whole.speed_slope == pytest.approx(-0.2)
    assert not any(np.any(part) for part in vars(present(whole, states)).values())
    found = settling(model, whole, states)
    rate, contacts = 0.5 / 0.1, model.contacts
    np.testing.assert_allclose(found.decay, [rate, rate])
    np.testing.assert_allclose(found.push.T, np.array([[0.3], [20.0 * -0.2]]) * contacts.tangent)
    np.testing.assert_allclose(found.by_place, [-rate * 1e4 * contacts.normal[0], 0 * contacts.normal[0]])
    np.testing.assert_allclose(found.by_speed, [-rate * 3.0 * contacts.normal[0], -rate * contacts.tangent[0]])


def test_without_memory_friction_acts_at_once():
    _, whole, states = about(constant(0.3))
    assert present(whole, states) is whole


def test_branches_without_stiffness_are_none():
    row = np.array([1.0, 0.0])
    model = replace(belt(400.0, 0.5), elements=(Element("pad", row, Maxwell([0.0, 70.0], [1.0, 2.0])),))
    rows, springs, times = maxwell_branches(model)
    assert list(springs) == [70.0] and list(times) == [2.0] and rows.tolist() == [[1.0, 0.0]]


def test_projection_is_that_of_the_coordinates():
    model, whole, states = about(constant(0.3).with_state(Memory(0.1)))
    basis = np.array([[1.0], [2.0]])
    here = settling(model, whole, states).projected(basis.T, basis)
    there = settling(model.projected(basis), whole, states)
    for name in ("push", "by_place", "by_speed", "decay"):
        np.testing.assert_allclose(getattr(here, name), getattr(there, name))


def test_a_hard_contact_cannot_remember_its_load():
    model, whole, states = about(constant(0.3).with_state(Memory(0.1)), stiffness=np.array([0.0]))
    with pytest.raises(ConfigError, match="contacts that yield"):
        settling(model, whole, states)
