"""Evolution finds a known minimum; stretch moves have the right mean and spread; seeds give the same bits."""

import numpy as np
import pytest

from pipeline.physics.numerics.search import evolve, stretch_samples

LOWER, UPPER = np.array([-2.0, -2.0, -2.0]), np.array([2.0, 2.0, 2.0])


def valley(point):
    """Rosenbrock's function, 0 at (1, 1, 1)."""
    return float(np.sum(100 * (point[1:] - point[:-1] ** 2) ** 2 + (1 - point[:-1]) ** 2))


def start(count, seed=3):
    return np.random.default_rng(seed).uniform(LOWER, UPPER, (count, 3))


@pytest.mark.exact
def test_evolution_finds_the_end_of_a_valley():
    found = evolve(valley, start(24), LOWER, UPPER, 250, seed=1)
    assert found.cost == pytest.approx(valley(found.best)) and found.cost < 0.01
    np.testing.assert_allclose(found.best, 1.0, atol=0.15)
    assert found.evaluations == 24 * 251 and np.all(found.costs >= found.cost)


def test_cost_never_rises_and_seeds_repeat():
    population = start(10)
    one, other = (evolve(valley, population, LOWER, UPPER, 5, seed=4) for _ in range(2))
    np.testing.assert_array_equal(one.population, other.population)
    assert np.all(one.costs <= [valley(p) for p in population])


def test_evolution_stays_within_its_bounds():
    found = evolve(lambda p: -p.sum(), start(8), LOWER, UPPER, 60, seed=2)
    assert np.all(found.population <= UPPER) and np.all(found.population >= LOWER) and np.all(found.best > 1.9)


@pytest.mark.exact
def test_stretch_moves_sample_a_correlated_gaussian():
    covariance = np.array([[0.09, 0.05], [0.05, 0.04]])
    precision = np.linalg.inv(covariance)
    walkers = 0.1 * np.random.default_rng(5).standard_normal((20, 2))
    samples = stretch_samples(lambda p: -p @ precision @ p / 2, walkers, LOWER[:2], UPPER[:2], 1500, seed=6)[4000:]
    assert samples.shape == (26000, 2)
    np.testing.assert_allclose(samples.mean(axis=0), 0.0, atol=0.02)
    np.testing.assert_allclose(np.cov(samples.T), covariance, rtol=0.15)


def test_samples_stay_within_the_bounds():
    walkers = 0.5 + 0.1 * np.random.default_rng(5).standard_normal((12, 2))
    samples = stretch_samples(lambda p: 0.0, walkers, np.zeros(2), np.ones(2), 200, seed=1)
    assert samples.min() >= 0 and samples.max() <= 1 and samples.std() > 0.2
