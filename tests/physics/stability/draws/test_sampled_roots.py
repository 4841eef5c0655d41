"""Roots of draws on common bases: closed form, whole model, null tests."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.two_mode_flutter import growth_rate, onset_friction
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL, Factors, Family
from pipeline.physics.stability.draws.whole_roots import whole_roots
from tests.physics.stability.draws.scattered_block import draws, family

K11, K22, K12, KF = 1.0e6, 1.3e6, 2e5, 8e5


def two_modes(friction):
    """Unit masses; a contact of stiffness KF on coordinate 2, whose friction acts on coordinate 1 against it."""
    none, rows = np.zeros((2, 2)), np.eye(2)
    contacts = Contacts(rows[1:], rows[:1], np.zeros((1, 2)), np.zeros((1, 3)), np.ones(1), np.ones(1), np.ones(1),
                        np.array([KF]), np.zeros(1))
    stiffness = np.array([[K11, K12], [K12, K22 - KF]])
    model = SlidingModel(("two",), np.zeros(2, int), np.eye(2), none, none, stiffness, none,
                         Joints((), np.empty((0, 2)), np.empty(0), np.empty(0)), contacts, (), np.empty((0, 2)), (),
                         np.empty((0, 2)), -1.0)
    return Family(model, lambda p, v: FrictionState(np.full_like(p, friction), 0 * p, 0 * p), np.empty(0), np.inf, none,
                  np.empty(0), friction_damping=False)


@pytest.mark.exact
def test_two_modes_flutter_as_in_closed_form():
    onset = onset_friction(K11, K22, K12, KF)
    case = sampled(two_modes(onset), (-1.0,), 1e3)
    for change in (-0.05, 0.05, 0.2):
        roots = case.roots(Factors(friction=change), -1.0)
        exact = growth_rate(K11, K22, K12, KF, onset + change)
        assert roots[0].real == pytest.approx(exact, rel=1e-6, abs=1e-3)


@pytest.mark.exact
def test_probability_of_flutter_is_that_of_the_friction():
    """Normal friction of mean m and deviation d: P = Phi((m - onset) / d)."""
    onset, deviation = onset_friction(K11, K22, K12, KF), 0.1
    for shift, seed in ((0.0, 1), (0.08, 2), (-0.12, 3)):
        case = sampled(two_modes(onset + shift), (-1.0,), 1e3)
        drawn = np.random.default_rng(seed).normal(0.0, deviation, 600)
        grows = [case.roots(Factors(friction=a), -1.0)[0].real > 1e-2 for a in drawn]
        interval = scipy.stats.binomtest(sum(grows), len(grows)).proportion_ci(0.999, "wilson")
        assert interval.low < scipy.stats.norm.cdf(shift / deviation) < interval.high


@pytest.fixture(scope="module")
def block():
    return sampled(family(), (1.5, 2.5), 20e3, (NOMINAL, *draws(4, 1)))


@pytest.mark.exact
@pytest.mark.parametrize("factors", [NOMINAL, *draws(9, 12)])
def test_roots_are_those_of_the_whole_model(block, factors):
    exact = whole_roots(block.family, factors, 2.5, 20e3, smallest=1e-4)
    roots = block.roots(factors, 2.5)
    assert len(block.small.mass) < 0.9 * block.family.model.size
    for root in exact[(exact.real > 0) & (abs(exact) < 0.98 * 2 * np.pi * 20e3)]:
        nearest = roots[np.argmin(abs(roots - root))]
        assert abs(nearest.imag / root.imag - 1) < 5e-3
        assert abs(nearest.real - root.real) < max(10.0, 0.1 * root.real)
    assert np.sum(roots.real > 10) <= np.sum(exact.real > 0)


@pytest.mark.exact
@pytest.mark.parametrize("factors", [Factors(friction=0.4), Factors(0.3, 1.0, 1.0, 0.5, 4.0)],
                         ids=["twice the friction", "loose joints, soft lining, hard contacts"])
def test_draws_far_beyond_the_training_are_those_of_the_whole_model(block, factors):
    exact, roots = whole_roots(block.family, factors, 2.5, 20e3, smallest=1e-4), block.roots(factors, 2.5)
    exact, roots = (each[each.real > 10] for each in (exact, roots))
    assert len(roots) == len(exact) > 0
    np.testing.assert_allclose(roots, exact, rtol=1e-3)


def test_the_block_has_growing_roots_in_some_draws_and_none_in_others(block):
    growth = [block.roots(factors, 2.5)[0].real for factors in draws(12, 12)]
    assert min(growth) < 0 < max(growth)


def test_the_same_draw_gives_the_same_bits(block):
    factors = draws(1, 3)[0]
    np.testing.assert_array_equal(block.roots(factors, 1.5), block.roots(factors, 1.5))


@pytest.mark.exact
def test_overdamped_contacts_are_solved_without_condensation():
    case = sampled(family(damping_speed=0.02), (2.5,), 20e3)
    exact, roots = whole_roots(case.family, NOMINAL, 2.5, 20e3, smallest=1e-6), case.roots(NOMINAL, 2.5)
    for root in exact[exact.real > 0]:
        assert abs(roots - root).min() < 1e-3 * abs(root)
    assert np.sum(roots.real > 0) == np.sum(exact.real > 0)


def test_a_drive_at_rest_is_refused():
    with pytest.raises(ConfigError, match="friction_damping"):
        sampled(family(), (0.0, 1.0), 20e3)
