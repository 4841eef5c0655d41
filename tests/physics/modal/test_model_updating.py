"""Values of a model from natural frequencies: against closed forms, and how often their intervals hold the truth."""

import numpy as np
import pytest

from pipeline.contract import ConvergenceError
from pipeline.physics.modal.model_updating import ModelModes, Test, posterior, update, with_errors

MASS = np.diag([1.0, 1.3, 0.7, 1.1, 0.9])
STEP = 1e-6


def stiffness(values):
    """Five masses in a row: the springs at the ends, and those between, are two values."""
    end, inner = values
    matrix = np.diag([end + inner, 2 * inner, 2 * inner, 2 * inner, end + inner])
    return matrix - inner * (np.eye(5, k=1) + np.eye(5, k=-1))


def chain(latent, spread=0.2):
    """ModelModes of springs of 1 and 2 kN/m, times exp(.2 u)."""
    def modes(at):
        values, vectors = np.linalg.eigh(np.linalg.inv(np.sqrt(MASS)) @ stiffness(
            np.array([1e3, 2e3]) * np.exp(spread * at)) @ np.linalg.inv(np.sqrt(MASS)))
        return np.sqrt(values) / (2 * np.pi), np.linalg.inv(np.sqrt(MASS)) @ vectors

    frequency, shape = modes(latent)
    slope = [(np.log(modes(latent + STEP * unit)[0]) - np.log(frequency)) / STEP for unit in np.eye(2)]
    return ModelModes(frequency, np.array(slope).T, shape)


def measured(latent, error=0.0, spread=1e-4, random=None, kept=slice(None)):
    modes = chain(np.array(latent))
    noise = np.hypot(error, spread) * (random.standard_normal(5) if random else 0.0)
    return Test((modes.frequency * np.exp(noise))[kept], np.full(5, spread)[kept], modes.shown.T[kept])


def test_without_a_model_error_the_posterior_is_that_of_least_squares():
    random = np.random.default_rng(1)
    slope, noise = random.standard_normal((40, 3)), np.full(40, 0.05)
    left = slope @ (0.3, -0.5, 1.0) + noise * random.standard_normal(40)
    precision = np.eye(3) + slope.T @ slope / 0.05**2
    mean, covariance, error, _ = posterior(left, slope, noise)
    np.testing.assert_allclose(mean, np.linalg.solve(precision, slope.T @ left / 0.05**2), atol=2e-3)
    np.testing.assert_allclose(covariance, np.linalg.inv(precision), rtol=0.3, atol=2e-5)
    assert error < 0.02


def test_values_far_off_come_back_exactly():
    found = update(chain, lambda shape: shape, measured([1.2, -0.9], spread=1e-7), 2)
    np.testing.assert_allclose(found.latent, [1.2, -0.9], atol=2e-3)
    assert found.pairing.group.tolist() == [0, 1, 2, 3, 4] and found.pairing.clear.all()
    np.testing.assert_allclose(found.after.frequency, measured([1.2, -0.9]).frequency, rtol=1e-3)


def test_a_missing_mode_misleads_nothing():
    found = update(chain, lambda shape: shape, measured([0.5, 0.4], kept=[0, 1, 3, 4]), 2)
    assert found.pairing.group.tolist() == [0, 1, 3, 4]
    np.testing.assert_allclose(found.latent, [0.5, 0.4], atol=0.01)


def test_without_shapes_frequencies_alone_pair():
    test = measured([0.1, -0.1])
    found = update(chain, None, Test(test.frequency, test.spread, np.zeros((5, 0))), 2)
    np.testing.assert_allclose(found.latent, [0.1, -0.1], atol=0.02)


def test_intervals_hold_the_truth_as_often_as_they_say():
    """Values drawn from their priors, a model off by 1 % that nobody states: 95 % intervals, 200 draws."""
    random, inside = np.random.default_rng(5), []
    for _ in range(200):
        true = random.standard_normal(2)
        found = update(chain, lambda shape: shape, measured(true, 0.01, random=random), 2)
        inside.append(abs(found.latent - true) < 2 * np.sqrt(np.diag(found.covariance)))
    assert 0.90 <= np.mean(inside) <= 0.98


def test_an_error_of_known_shape_counts_in_the_values_that_look_like_it():
    """One that looks like a value leaves this as its prior, one that looks like none leaves both as they were."""
    found, test = (update(chain, lambda shape: shape, measured([0.3, -0.2]), 2), measured([0.3, -0.2]))
    slope = found.after.slope
    like, unlike = slope[:, 0] * 100, np.linalg.svd(slope)[0][:, 4] * 1e-3
    spread = np.sqrt(np.diag(with_errors(found, test, [like])))
    assert 0.9 < spread[0] < 1.05 and spread[1] < 0.05
    alone = with_errors(found, test, np.zeros((1, 5)))
    np.testing.assert_allclose(alone, found.covariance, rtol=0.05, atol=1e-9)
    ratio = np.sqrt(np.diag(with_errors(found, test, [unlike])) / np.diag(alone))
    assert ((ratio > 0.8) & (ratio < 1.4)).all()        # one unknown more for the same five frequencies


def test_two_modes_at_the_limit_of_a_group_do_not_keep_the_update_from_ending():
    """A gap that is just within a group at one step and just without it at the next."""
    gap, sides = 2e-3, []

    def modes(latent):
        sides.append(len(sides) % 2)
        split = gap * (1.05 if sides[-1] else 0.95)
        frequency = np.array([10.0, 10.0 * (1 + split), 30.0]) * np.exp(0.1 * latent[0])
        return ModelModes(frequency, np.full((3, 1), 0.1), np.eye(6)[:, :3])

    test = Test(np.array([10.2, 30.6]), np.full(2, 1e-5), np.eye(6)[[0, 2]])
    found = update(modes, lambda shape: shape, test, 1)
    assert found.latent[0] == pytest.approx(np.log(1.02) / 0.1, rel=0.05)


def test_modes_of_another_structure_are_refused():
    other = Test(np.array([500.0, 900.0]), np.full(2, 1e-4), np.random.default_rng(2).standard_normal((2, 5)))
    with pytest.raises(ConvergenceError, match="one of the model beyond doubt"):
        update(chain, lambda shape: shape, other, 2)


def test_what_splits_a_pair_counts_as_no_error_of_the_model():
    """Two equal pendulums that a test shows 1 % apart, and a third one."""
    def pendulums(latent):
        frequency = np.array([10.0, 10.0, 30.0]) * np.exp(0.1 * latent[0])
        return ModelModes(frequency, np.full((3, 1), 0.1), np.eye(6)[:, :3])

    middle = 10.0 * np.exp(0.05)
    test = Test(middle * np.array([np.exp(-0.005), np.exp(0.005), 3.0]), np.full(3, 1e-4), np.eye(6)[:3])
    found = update(pendulums, lambda shape: shape, test, 1)
    assert 10.0 * np.exp(0.1 * found.latent[0]) == pytest.approx(middle, rel=1e-3)
    assert found.pairing.group.tolist() == [0, 0, 1] and found.pairing.clear.all() and found.error < 3e-3
