"""Energies of the pads along a motion: closed forms of a block, order two, coordinates, wrong forces, both codes."""

import numpy as np
import pytest

from pipeline.physics.pads import exudyn_model, newmark
from pipeline.physics.pads.contact_history import contact_history
from pipeline.physics.pads.energy_balance import energy_balance
from pipeline.physics.pads.pad_system import pad_elements
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.pads.sliding_pads import static_start
from pipeline.physics.time_stepping.elements import BoucWen, Element, Polynomial
from tests.physics.small_pads import block_on_belt, random_assembly

SPRING, LOAD, FRICTION, BELT = 1e5, 50.0, 0.4, 1.0
DRAWN, ALONG = FRICTION * LOAD, np.array([1.0, 0.0])


def block(law=None, **more):
    """A block on a belt of BELT m/s that friction pulls on from rest; ``law`` of an element along the belt."""
    system = block_on_belt(mass=2.0, spring=SPRING, damping=200.0, load=LOAD, friction=FRICTION, **more)
    return system if law is None else system._replace(elements=pad_elements((Element("joint", ALONG, law),), 2))


def balance(system, step=1e-5, duration=0.2, every=1, highest=np.inf, integrate=newmark.integrate, change=None):
    """EnergyBalance of the motion from the static start, in preloaded modes; ``change`` of its ContactHistory."""
    start = static_start(system)
    modal, basis = preloaded_modes(system, start, highest)
    scale = np.linalg.norm(basis.T @ system.load)
    motion = integrate(modal, np.zeros(basis.shape[1]), step, round(duration / step), every, scale)
    history = contact_history(modal.contact, np.zeros(len(system.contact.radius), int), 1, *motion)
    return energy_balance(system, modal, start, basis, change(history) if change else history, *motion)


@pytest.mark.exact
def test_friction_heats_the_belt_loads_the_spring_and_what_the_block_swings_is_lost():
    """It comes to rest at T / k: the spring has half of what friction has done, dampers the rest."""
    energy = balance(block(), duration=0.4)
    stretch = DRAWN / SPRING
    assert energy.friction_work[-1] == pytest.approx(DRAWN * stretch, rel=1e-6)
    assert energy.stored[-1] == pytest.approx(DRAWN * stretch / 2, rel=1e-5)
    assert energy.damping_loss[-1] == pytest.approx(DRAWN * stretch / 2, rel=1e-4)
    assert energy.sliding_loss[-1] == pytest.approx(DRAWN * (BELT * 0.4 - stretch), rel=1e-6)
    assert not energy.added_loss.any() and not energy.element_work.any()
    assert abs(energy.normal_work).max() < 1e-9 * energy.friction_work[-1]


@pytest.mark.exact
def test_an_element_stores_what_a_spring_of_its_stiffness_would():
    energy = balance(block(Polynomial(linear=SPRING)))
    stretch = DRAWN / (2 * SPRING)
    assert energy.element_work[-1] == pytest.approx(-SPRING * stretch**2 / 2, rel=1e-4)
    assert energy.imbalance < 1e-6


def test_a_joint_that_remembers_loses_energy_and_the_balance_closes():
    energy = balance(block(BoucWen(0.0, 5e4, 1e-4)))
    assert energy.element_work[-1] < -0.05 * energy.friction_work[-1] and energy.imbalance < 1e-4


@pytest.mark.exact
def test_the_error_falls_with_the_square_of_the_step_and_of_the_interval_of_the_record():
    coarse, fine = (balance(random_assembly(), step, 0.02).imbalance for step in (4e-6, 2e-6))
    assert coarse / fine == pytest.approx(4, rel=0.01) and fine < 1e-5
    seldom, often = (balance(random_assembly(), 1e-6, 0.02, every).imbalance for every in (8, 4))
    assert seldom / often == pytest.approx(4, rel=0.1) and often < 1e-4


@pytest.mark.exact
def test_the_load_works_against_the_contacts_that_it_presses():
    """Energies are those of the assembly itself, in whatever coordinates about its static start it moves."""
    system, start = random_assembly(), static_start(random_assembly())
    modal, basis = preloaded_modes(system, start)
    time, moved, velocity = newmark.integrate(modal, np.zeros(basis.shape[1]), 5e-6, 400)
    history = contact_history(modal.contact, np.zeros(8, int), 1, time, moved, velocity)
    energy = energy_balance(system, modal, start, basis, history, time, moved, velocity)
    place, speed = start + moved[-1] @ basis.T, velocity[-1] @ basis.T
    stored = (place @ system.stiffness @ place - start @ system.stiffness @ start + speed @ system.mass @ speed) / 2
    np.testing.assert_allclose(energy.stored[-1], stored, rtol=1e-9)
    np.testing.assert_allclose(energy.input_work[-1], system.load @ (place - start), rtol=1e-9)


def test_static_answers_lose_energy_in_their_own_damping():
    energy = balance(random_assembly(size=40, count=6), 2e-6, 0.02, highest=4e3)
    assert 0 < energy.added_loss[-1] < energy.damping_loss[-1] and energy.imbalance < 1e-2


def test_a_wrong_friction_force_does_not_pass():
    def stronger(history):
        return history._replace(power=history.power * np.array([[1.0], [1.05], [1.0]]))

    assert balance(block(), change=stronger).imbalance > 0.02
    assert balance(block()).imbalance < 1e-6


def test_exudyn_has_the_same_energies():
    ours, exudyn = (balance(random_assembly(), 5e-6, 2e-3, integrate=code.integrate)
                    for code in (newmark, exudyn_model))
    for value, other in zip(ours, exudyn, strict=True):
        np.testing.assert_allclose(other, value, atol=1e-6 * ours.sliding_loss[-1])
