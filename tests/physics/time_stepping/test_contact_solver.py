"""Forces of one step: complementarity with several contacts, and codes for what has no solution."""

import numpy as np
import pytest

from pipeline.physics.friction.dry_friction import constant, kernel, tabulated
from pipeline.physics.time_stepping.contact_solver import (
    HARD,
    JAMMED,
    LAGRANGE,
    OPEN,
    PENALTY,
    SLIP,
    SOLVED,
    STICK,
    TABLE,
    TOO_LONG,
    UNCONVERGED,
    ContactStep,
    NormalKernel,
    solve_contacts,
    yielding_force,
)


def normal(kind, contacts, stiffness=1e6, restitution=0.0):
    each = np.ones(contacts)
    return NormalKernel(kind, 0 * each, -1.0 * each, each, stiffness * each, 0 * each, np.array([0.0, 1e-6, 1e-5]),
                        np.array([0.0, 1.0, 100.0]), np.zeros(contacts, np.int64), 0.5 * each, restitution,
                        kind == LAGRANGE)


def solve(law, mobility, free, mu=0.3, past=None, status=None, dry=None, **friction):
    """(code, forces, status) of one step; ``mobility`` (2 c, 2 c) gives velocities, displacements are its 1e-6."""
    contacts = law.gap.size
    blocks = np.asarray(mobility, float).reshape(2, contacts, 2, contacts).transpose(0, 2, 1, 3)
    response = np.array([1e-6 * blocks[0], blocks[0], 1e-6 * blocks[1], blocks[1]])
    force, none = np.zeros((2, contacts)), np.zeros((4, contacts))
    status = np.full(contacts, OPEN) if status is None else np.array(status)
    step = ContactStep(np.array(free, float), none if past is None else np.array(past, float), np.zeros((2, contacts)),
                       np.zeros((2, contacts)), np.zeros(contacts), force, status, status.copy())
    code, _ = solve_contacts(law, kernel(dry or constant(mu, **friction), contacts), response, step)
    return code, force, status


@pytest.mark.exact
def test_hard_contacts_satisfy_their_conditions():
    """Random coupled contacts: N >= 0, no approach, no pull on what parts; sticking within the cone, sliding on it."""
    random, contacts, mu = np.random.default_rng(3), 6, 0.4
    seen = set()
    for _ in range(50):
        root = random.standard_normal((2 * contacts, 3 * contacts))
        mobility = root @ root.T / (3 * contacts)
        velocity = random.standard_normal((2, contacts))
        free = np.array([np.full(contacts, -1e-9), velocity[0], np.zeros(contacts), velocity[1]])
        code, force, status = solve(normal(HARD, contacts), mobility, free, mu)
        after = velocity + (mobility @ force.ravel()).reshape(2, contacts)
        assert code == SOLVED and np.all(force[0] >= 0)
        rest = 1e-7 * force.max()       # what sweeps that change no force by more than 1e-9 of the largest leave
        np.testing.assert_array_less(-rest, after[0])
        np.testing.assert_allclose(force[0] * after[0], 0, atol=rest * force.max())
        np.testing.assert_allclose(after[1, status == STICK], 0, atol=rest)
        slides = status == SLIP
        np.testing.assert_allclose(force[1, slides], -mu * force[0, slides] * np.sign(after[1, slides]), atol=rest)
        assert np.all(abs(force[1]) <= mu * force[0] + rest)
        seen |= set(status)
    assert seen == {OPEN, STICK, SLIP}


@pytest.mark.exact
def test_restitution_and_static_friction():
    past = [[0.0], [-2.0], [0.0], [0.0]]
    code, force, _ = solve(normal(HARD, 1, restitution=0.5), np.eye(2), [[-1e-9], [-2.0], [0], [0.0]], past=past)
    assert code == SOLVED and force[0, 0] == pytest.approx(3.0)
    pushed = [[-1e-9], [-1.0], [0], [0.35]]
    for before, found, friction in ((STICK, STICK, -0.35), (SLIP, SLIP, -0.3)):
        _, force, status = solve(normal(HARD, 1), np.eye(2), pushed, status=[before], static_factor=1.5)
        assert status[0] == found and force[1, 0] == pytest.approx(friction)


@pytest.mark.exact
@pytest.mark.parametrize("slope, end", [(0.5, 0.5), (1.4, 0.5), (1.6, 1.0), (5.0, 1.0), (5e5, 1.0), (1e12, 1.0)])
def test_a_coefficient_that_rises_over_speed_is_read_in_the_middle_and_where_it_rises_steeply_at_the_end(slope, end):
    """Pressed by N = 1, mobility 1, sliding at v0: mu = .1 + a v at v = v0 - e mu, so that mu (1 + a e) = .1 + a v0.

    From a = 2 on reading mu anew at the mean speed (e = 1 / 2) that it leads to runs away, and from 1.5 on slowly.
    """
    fast, begin = 0.9, [[0.0], [0.0], [0.0], [0.9]]
    dry = tabulated(np.array([0.0, 1.0]), np.array([0.1, 0.1 + slope]))
    code, force, status = solve(normal(HARD, 1), np.eye(2), [[-1e-9], [-1.0], [0.0], [fast]], past=begin, dry=dry)
    assert code == SOLVED and status[0] == SLIP
    assert -force[1, 0] == pytest.approx((0.1 + slope * fast) / (1 + slope * end), rel=1e-8)
    assert abs(force[1, 0]) < fast, "it goes on sliding"


@pytest.mark.exact
def test_laws_hold_at_the_end_of_the_step():
    free = [[-5e-6], [-0.1], [0.0], [2e-2]]
    _, force, _ = solve(normal(PENALTY, 1, 1e3), np.diag([0.1, 1.0]), free)
    assert force[0, 0] == pytest.approx(1e3 * (5e-6 - 1e-7 * force[0, 0]))
    law = normal(TABLE, 1)
    _, force, _ = solve(law, np.diag([1e-3, 1.0]), free)
    end = 5e-6 - 1e-9 * force[0, 0], 0.1 - 1e-3 * force[0, 0]
    assert force[0, 0] == pytest.approx(yielding_force(law, 0, *end)[0])
    assert yielding_force(law, 0, 2e-5, 0.0)[0] == pytest.approx(100 + 1e-5 * 1.1e7)
    assert yielding_force(law, 0, -1e-9, 1.0) == yielding_force(law, 0, 1e-6, -0.6) == (0.0, 0.0, 0.0)


def test_an_open_contact_feels_nothing():
    code, force, status = solve(normal(HARD, 1), np.eye(2), [[1e-9], [-1.0], [0], [1.0]])
    assert (code, status[0]) == (SOLVED, OPEN) and not force.any()


def test_codes_of_what_has_no_solution():
    closing = [[-1e-9], [-1.0], [0], [-5.0]]
    assert solve(normal(HARD, 1), [[1.0, -1.2], [-1.2, 1.0]], closing, mu=2.0)[0] == JAMMED
    assert solve(normal(PENALTY, 1, 1e9), np.eye(2), closing)[0] == TOO_LONG
    assert solve(normal(HARD, 1), np.eye(2), closing, description="elastic", stiffness=1e9)[0] == TOO_LONG
    opposed = np.array([[1.0, -1.0], [-1.0, 1.0]])
    both = np.kron(np.diag([1, 0]), opposed) + np.kron(np.diag([0, 1]), np.eye(2))
    assert solve(normal(HARD, 2), both, [[-1e-9] * 2, [-1.0] * 2, [0] * 2, [0] * 2])[0] == UNCONVERGED
