"""Friction laws of one joint: steady sliding, what states do over a step, symmetry."""

import numpy as np
import pytest

from pipeline.physics.friction.joint_friction import REFERENCE_SPEED, positional, presliding, rate_state, settled

V = REFERENCE_SPEED
AGEING, SLIP = ((2.0, 0.02, 0.03, 1e-3, law) for law in (0.0, 1.0))


def advanced(p, psi, speed, passed):
    """(F, psi) of rate-and-state friction after ``passed`` s at a constant ``speed``."""
    memory = np.zeros(3)
    force = rate_state(speed, passed, np.array([psi, 0.0, max(abs(speed), 1e-300)]), memory, np.array(p))
    return force, memory[0]


@pytest.mark.exact
@pytest.mark.parametrize("p", [AGEING, SLIP])
def test_steady_sliding_follows_the_logarithm_of_the_speed(p):
    for speed in (1e-5, 1e-3, -0.1):
        force, psi = advanced(p, settled(speed), speed, 0.3)
        assert psi == pytest.approx(-np.log(abs(speed) / V), abs=1e-9)
        assert force == pytest.approx(np.sign(speed) * 2.0 * (1 - 0.01 * np.log(abs(speed) / V)), rel=1e-9)


@pytest.mark.exact
def test_at_rest_the_contact_ages_by_the_ageing_law_alone():
    psi = settled(1e-3)
    assert advanced(AGEING, psi, 0.0, 50.0)[1] == pytest.approx(np.log(np.exp(psi) + V * 50.0 / 1e-3), rel=1e-12)
    assert advanced(SLIP, psi, 0.0, 50.0)[1] == pytest.approx(psi, rel=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("p, slope", [
    (AGEING, lambda psi, v: V / 1e-3 * np.exp(-psi) - v / 1e-3),
    (SLIP, lambda psi, v: -v / 1e-3 * (psi + np.log(v / V)))])
def test_states_go_on_as_their_equations_say(p, slope):
    """In one step over one length and in many short ones, and the first change is the slope."""
    psi, speed = settled(1e-4), 1e-2
    once, many = advanced(p, psi, speed, 0.1)[1], psi
    for _ in range(50):
        many = advanced(p, many, speed, 0.1 / 50)[1]
    assert once == pytest.approx(many, rel=1e-10)
    assert (advanced(p, psi, speed, 1e-7)[1] - psi) / 1e-7 == pytest.approx(slope(psi, speed), rel=1e-5)


def test_a_motion_begins_settled():
    memory = np.zeros(3)
    rate_state(1e-3, 7.0, np.zeros(3), memory, np.array(AGEING))
    np.testing.assert_allclose(memory, [settled(1e-3), 7.0, 1e-3])
    assert settled(1e-9) == 0.0


@pytest.mark.exact
def test_dahl_friction_is_built_up_exponentially_over_the_way():
    memory, p = np.zeros(2), np.array([3.0, 1e-3, 0.0, 1.0, 0.0, 0.0])
    assert presliding(2e-3, 0.5, np.zeros(2), memory, p) == pytest.approx(3.0 * (1 - np.exp(-2.0)), rel=1e-12)
    assert presliding(-1e-3, -0.5, memory.copy(), memory, p) == pytest.approx(
        3.0 * (-1 + (2 - np.exp(-2.0)) * np.exp(-1.0)), rel=1e-12)


@pytest.mark.exact
def test_lugre_friction_slides_steadily_on_the_curve_of_stribeck():
    p = np.array([3.0, 1e-3, 0.5, 0.1, 2e-3, 0.7])
    for speed in (0.02, -0.1, 1.0):
        steady = np.sign(speed) * (1 + 0.5 * np.exp(-(speed / 0.1) ** 2))
        force = presliding(0.01 * speed, speed, np.array([steady, speed]), np.zeros(2), p)
        assert force == pytest.approx(3.0 * steady + 0.7 * speed, rel=1e-9)


@pytest.mark.exact
def test_positional_friction_follows_the_place_and_vanishes_where_it_would_drive():
    p = np.array([2.0, 50.0, 1e-9])
    assert positional(0.01, 0.3, p) == pytest.approx(3.0) and positional(0.01, -0.3, p) == pytest.approx(-3.0)
    assert positional(-0.05, 0.3, p) == 0.0 and positional(0.01, 0.0, p) == 0.0
