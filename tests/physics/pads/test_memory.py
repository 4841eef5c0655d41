"""Memory of pads, advanced once per accepted step: against closed forms and transients of the same model."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.friction.dry_friction import constant, tabulated
from pipeline.physics.friction.state_variables import Healing, Memory, Plateaus, state_kernel
from pipeline.physics.pads import exudyn_model, newmark
from pipeline.physics.pads.contact_history import contact_history
from pipeline.physics.pads.memory import remembers
from pipeline.physics.pads.pad_system import pad_elements, pad_friction
from pipeline.physics.pads.sliding_pads import static_start
from pipeline.physics.time_stepping.elements import BoucWen, Dry, Element, Maxwell, Sliders
from pipeline.physics.time_stepping.simulate import Start, Table, simulate
from tests.physics.lumps import lumps
from tests.physics.small_pads import block_on_belt

LOAD, SPRING, MASS, STEP, STEPS = 50.0, 1e5, 2.0, 5e-6, 4000
LAW = Table(np.array([0.0, 5e-3, 1e-2]), 1e12 * np.array([0.0, 5e-3, 1e-2]), 0.2)
FALLING = tabulated(np.array([0.0, 0.9, 1.0, 1.1, 5.0]), np.array([0.6, 0.5, 0.4, 0.35, 0.3]))
RUB = np.array([1.0, 0.0])


def pads(friction=FALLING, elements=(), **more):
    """A block on a belt of 1 m/s with this Friction and these Elements."""
    system = block_on_belt(mass=MASS, spring=SPRING, damping=20.0, load=LOAD, law=LAW)
    contact = system.contact._replace(dry=pad_friction(friction, 1), states=state_kernel(friction, np.array([1e-4])),
                                      **more)
    return system._replace(contact=contact, elements=pad_elements(elements, 2))


def rubbed(friction=FALLING, elements=(), wear=0.0):
    """The same block as a transient sees it: its Motion."""
    model = lumps([MASS, MASS], np.eye(2), [SPRING, 0.0], [20.0, 20.0], [[0.0, 1.0]], [[1.0, 0.0]], 1.0)
    model = replace(model, contacts=replace(model.contacts, area=np.array([1e-4]), wear=wear), elements=tuple(elements))
    start = Start(np.array([0.0, -LOAD / 1e8]), np.zeros(2), memory=None)
    return simulate(model, LAW, friction, step=STEP, duration=STEPS * STEP, inputs=[0.0, -LOAD], record_every=20,
                    start=start)


@pytest.mark.parametrize("state", [None, Memory(2e-3), Healing(0.1, 0.5, 1e-3), Plateaus(2.0, 1e6, 2e-3)])
def test_friction_that_remembers_moves_the_pads_as_it_moves_a_transient(state):
    friction = FALLING if state is None else FALLING.with_state(state)
    system = pads(friction)
    assert remembers(system) == (state is not None)
    time, q, _ = newmark.integrate(system, static_start(system), STEP, STEPS, 20)
    expected = rubbed(friction).displacement[0]
    np.testing.assert_allclose(q[:, 0], expected, atol=2e-3 * np.ptp(expected))
    if state is not None:
        assert np.abs(rubbed().displacement[0] - expected).max() > 0.02 * np.ptp(expected)


@pytest.mark.parametrize("law", [Sliders(np.array([5e4, 3e4]), np.array([4.0, 9.0])), BoucWen(0.0, 5e4, 1e-4),
                                 Maxwell(np.array([4e4]), np.array([1e-3])), Dry(1e5, 6.0, 6.0)])
def test_elements_that_remember_move_the_pads_as_they_move_a_transient(law):
    elements = (Element("joint", RUB, law),)
    system = pads(elements=elements)
    _, q, _ = newmark.integrate(system, static_start(system), STEP, STEPS, 20)
    expected = rubbed(elements=elements).displacement[0]
    np.testing.assert_allclose(q[:, 0], expected, atol=2e-3 * np.ptp(expected))
    assert np.abs(rubbed().displacement[0] - expected).max() > 0.05 * np.ptp(expected)


@pytest.mark.exact
def test_wear_lowers_a_pressed_block_by_force_times_way():
    rate = 1e-9
    system = pads(constant(0.0), wear=np.array([rate]))
    time, q, v = newmark.integrate(system, static_start(system), STEP, STEPS, 20)
    np.testing.assert_allclose(q[:, 1] - q[0, 1], -rate * LOAD * time, atol=0.01 * rate * LOAD * time[-1])
    assert rubbed(constant(0.0), wear=rate).displacement[1, -1] == pytest.approx(q[-1, 1], rel=1e-3)


def test_exudyn_and_newmark_remember_the_same():
    system = pads(FALLING.with_state(Memory(2e-3)), (Element("joint", RUB, BoucWen(0.0, 5e4, 1e-4)),),
                  wear=np.array([1e-9]))
    start = static_start(system)
    (_, q, v), (_, other, _) = (each.integrate(system, start, STEP, 1000) for each in (newmark, exudyn_model))
    np.testing.assert_allclose(other, q, atol=1e-7 * np.ptp(q[:, 0]))
    again = newmark.integrate(system, start, STEP, 1000)[1]
    np.testing.assert_array_equal(again, q)     # a run leaves nothing behind


@pytest.mark.exact
def test_the_history_repeats_what_was_remembered():
    """Mass times acceleration is what springs, dampers and the recorded contact forces leave."""
    system = pads(FALLING.with_state(Memory(2e-3)))
    time, q, v = newmark.integrate(system, static_start(system), STEP, STEPS)
    drawn = contact_history(system.contact, np.zeros(1, int), 1, time, q, v).friction[0]
    acceleration = np.diff(v[:, 0]) / STEP
    rest = drawn - 20.0 * v[:, 0] - SPRING * q[:, 0]
    np.testing.assert_allclose(MASS * acceleration[1:], (rest[2:] + rest[1:-1]) / 2, atol=1e-5 * abs(rest).max())
