"""Contact of pads on the four sub-discs: law, patches, friction, tangent."""

import numpy as np
import pytest

from pipeline.physics.contact.groups import Grouped
from pipeline.physics.friction.dry_friction import constant, kernel
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.pads.patch_contact import (
    contact_force,
    contact_state,
    contact_tangent,
    friction_share,
    patch_shares,
)
from pipeline.physics.pads.sliding_pads import static_start
from pipeline.physics.time_stepping.normal_laws import Penalty, Table
from tests.physics.small_pads import block_on_belt, contacts, random_assembly

TURNS = np.linspace(-0.3, 2 * np.pi + 0.3, 4001)


def shares_over_a_turn(half_angle, sectors=16):
    return np.array([patch_shares(np.array([0.7]), np.array([half_angle]), turn, sectors)[0] for turn in TURNS])


@pytest.mark.exact
@pytest.mark.parametrize("half_angle", [0.001, 0.05, 0.19, 0.6, 2.0])
def test_shares_sum_to_one_and_are_continuous(half_angle):
    shares = shares_over_a_turn(half_angle)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=1e-12)
    assert shares.min() > -1e-12
    steepest = np.diff(TURNS)[0] / (2 * half_angle)
    assert np.abs(np.diff(shares, axis=0)).max() <= steepest * (1 + 1e-9)


@pytest.mark.exact
def test_each_sub_disc_bears_a_quarter_of_a_turn_and_they_follow_each_other():
    shares = [patch_shares(np.array([0.7]), np.array([0.05]), turn, 16)[0]
              for turn in np.linspace(0, 2 * np.pi, 1600, endpoint=False)]
    np.testing.assert_allclose(np.mean(shares, axis=0), 0.25, atol=1e-12)
    np.testing.assert_allclose(np.roll(np.array(shares)[:, 1], 100), np.array(shares)[:, 0], atol=1e-12)


@pytest.mark.exact
def test_shares_are_the_overlaps_counted_by_hand():
    angle, half, turned, sectors = 0.4, 0.3, 0.25, 12
    samples = angle - turned + half * (np.arange(200000) + 0.5) / 100000 - half
    dealt = np.floor(samples * sectors / (2 * np.pi)).astype(int) % 4
    counted = np.bincount(dealt, minlength=4) / samples.size
    shares = patch_shares(np.array([angle]), np.array([half]), turned, sectors)[0]
    np.testing.assert_allclose(shares, counted, atol=1e-5)


@pytest.mark.exact
def test_friction_rises_from_nothing_and_stays():
    assert [friction_share(t, 2.0) for t in (0.0, 1.0, 2.0, 9.0)] == pytest.approx([0, 0.5, 1, 1])
    assert friction_share(0.0, 0.0) == 1.0


@pytest.mark.exact
def test_forces_are_those_of_the_friction_map():
    system, time = random_assembly(), 0.02
    contact, rest = system.contact, np.zeros(len(system.mass))
    velocity = np.random.default_rng(5).normal(size=rest.size) * 0.2
    start = static_start(system)
    state = contact_state(contact, time, start, velocity)
    closure = -(contact.rows[0] @ start + contact.law.gap)
    closing = 1 - contact.rows[0] @ velocity / contact.law.damping_speed
    pressure = np.interp(closure, contact.law.closure, contact.law.pressure) * closing
    slip = np.array([contact.disc_speed * contact.radius - contact.rows[1] @ velocity, -contact.rows[2] @ velocity])
    law = FrictionLaw(contact.dry.pressure, contact.dry.speed, contact.dry.distance, contact.dry.table)
    distance = contact.bedding + contact.bedding_speed * time
    friction, _ = law.evaluate(pressure[:, None], np.hypot(*slip)[:, None], distance)
    shares = patch_shares(contact.angle, contact.half_angle, contact.disc_speed * time, contact.sectors)
    expected = (friction * shares).sum(axis=1) * pressure * contact.law.area
    np.testing.assert_allclose(state.normal, pressure * contact.law.area, rtol=1e-12)
    np.testing.assert_allclose(state.friction.T, expected * slip / np.hypot(*slip), rtol=1e-12)
    assert np.ptp(friction) > 0.02 and (shares > 0).sum() > len(shares)


@pytest.mark.exact
@pytest.mark.parametrize("slow", [1.0, 3e-4], ids=["sliding", "creeping"])
def test_tangent_is_the_derivative_of_the_force(slow):
    system = random_assembly()
    contact = system.contact._replace(disc_speed=9.0 * slow, stick_speed=2e-3, ramp=0.0)
    start, time = static_start(system) + 1e-9, 3e-4
    velocity = 0.1 * slow * np.random.default_rng(5).normal(size=start.size)
    stiffness, damping = contact_tangent(contact, time, start, velocity)
    for exact, slope in ((stiffness, slopes(lambda q: contact_force(contact, time, q, velocity), start, 1e-12)),
                         (damping, slopes(lambda v: contact_force(contact, time, start, v), velocity, 1e-7 * slow))):
        np.testing.assert_allclose(exact, -slope, atol=1e-6 * np.abs(exact).max())


def slopes(function, point, step):
    moves = step * np.eye(point.size)
    return np.array([(function(point + m) - function(point - m)) / (2 * step) for m in moves]).T


def test_friction_opposes_the_slip_whatever_its_direction():
    backwards = contact_state(block_on_belt(speed=-10.0).contact, 0.0, np.array([0.0, -1e-6]), np.zeros(2))
    assert backwards.friction[0, 0] == pytest.approx(-0.4 * backwards.normal[0])


def test_open_contacts_bear_nothing():
    contact = random_assembly().contact
    apart = contact._replace(law=contact.law._replace(gap=np.full(8, 1e-6)))
    state = contact_state(apart, 0.1, np.zeros(12), np.ones(12))
    assert not state.normal.any() and not state.friction.any() and not state.drag.any()


@pytest.mark.exact
def test_waves_and_scatter_turn_with_the_disc():
    """The opening grows by a cos(n W t - phase), its rate by the derivative; friction is multiplied."""
    row, speed, time, stiffness = np.array([[0.0, 1.0]]), 10.0, 0.03, 1e8
    plain = contacts(row, np.array([[1.0, 0.0]]), speed=speed, stiffness=stiffness, damping_speed=2.0)
    waves = plain._replace(waviness=np.array([[0.0, 1e-6, 3.0, 0.0, 0.4, 0.0]]),
                           scatter=np.array([[0.0, 0.2, 2.0, 0.1]]))
    place, rest = np.array([0.0, -5e-6]), np.zeros(2)
    angle = 3 * speed * time - 0.4
    closure, opening = 5e-6 - 1e-6 * np.cos(angle), -1e-6 * 3 * speed * np.sin(angle)
    state, before = contact_state(waves, time, place, rest), contact_state(plain, time, place, rest)
    assert state.normal[0] == pytest.approx(stiffness * closure * (1 - opening / 2.0))
    factor = 1 + 0.2 * np.cos(2 * speed * time - 0.1)
    assert state.friction[0, 0] / state.normal[0] == pytest.approx(factor * before.friction[0, 0] / before.normal[0])


@pytest.mark.exact
def test_contacts_may_have_laws_and_friction_of_their_own():
    rows, aside = np.array([[0.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0], [1.0, 0.0]])
    closure = np.array([0.0, 1.0])
    laws = Grouped((Table(closure, 1e12 * closure), Table(closure, 3e12 * closure, 1.0)), (0, 1))
    both = contacts(rows, aside, law=laws)._replace(dry=kernel(Grouped((constant(0.4), constant(0.2)), (0, 1)), 2))
    state = contact_state(both, 0.0, np.array([0.0, -1e-6]), np.array([0.0, -0.1]))
    assert state.normal[1] == pytest.approx(3 * 1.1 * state.normal[0])
    assert state.friction[1, 0] / state.normal[1] == pytest.approx(state.friction[0, 0] / state.normal[0] / 2)


@pytest.mark.exact
def test_a_contact_may_be_a_spring_and_damper_beside_a_table():
    rows, aside, closure = np.array([[0.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0], [1.0, 0.0]]), np.array([0.0, 1.0])
    both = contacts(rows, aside, law=Grouped((Table(closure, 1e12 * closure), Penalty(2e8, 30.0)), (0, 1)))
    state = contact_state(both, 0.0, np.array([0.0, -1e-6]), np.array([0.0, -0.1]))
    np.testing.assert_allclose(state.normal, [100.0, 203.0])
    np.testing.assert_allclose((state.stiffness, state.damping), ([1e8, 2e8], [0.0, 30.0]))
