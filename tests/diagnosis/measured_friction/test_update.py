"""Measured friction beside a map: what was changed is found with its size, and nothing where nothing was."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.measured_friction import update as module
from pipeline.diagnosis.measured_friction.samples import Samples
from pipeline.diagnosis.measured_friction.update import TERMS, groups, update
from pipeline.physics.friction.friction_table import FrictionLaw

PRESSURE, SPEED, DISTANCE = np.linspace(0.5e6, 4e6, 15), np.geomspace(0.2, 3.0, 12), np.linspace(0.0, 30e-3, 40)
GRID = np.meshgrid(PRESSURE, SPEED, DISTANCE, indexing="ij")
LAW = FrictionLaw(PRESSURE, SPEED, DISTANCE,
                  0.4 * (GRID[0] / 1e6)**0.05 * (GRID[1] / 1.0)**0.01 * (1.3 - 0.3 * np.exp(-GRID[2] / 5e-3)))


def measured(seed=0, level=0.0, pressure=0.0, speed=0.0, distance=0.0, temperature=0.0, noise=0.01, scatter=0.0,
             count=60):
    """Samples of the law with these changes, about the means of the samples."""
    random = np.random.default_rng(seed)
    p, v = random.uniform(0.8e6, 3e6, count), np.exp(random.uniform(np.log(0.3), np.log(2.5), count))
    s, t = random.uniform(0.0, 8e-3, count), random.uniform(320, 480, count)
    mu = LAW.evaluate(p, v, np.exp(distance) * s)[0]
    mu = mu * np.exp(level + pressure * np.log(p / np.exp(np.log(p).mean())) + speed * np.log(v / np.exp(
        np.log(v).mean())) - temperature * (t - t.mean()))
    mu = mu * np.exp(noise * random.standard_normal(count) + scatter * random.standard_normal(count))
    return Samples(mu, noise * mu, p, v, s, t, np.array([f"stop_{k // 10}" for k in range(count)]))


def test_nothing_is_found_where_nothing_differs():
    told = [update(LAW, measured(seed)) for seed in range(30)]
    assert sum(t.verdict != "consistent" for t in told) <= 2        # a hundredth is asked for: three in 250 such sets


@pytest.mark.parametrize("change", [{"level": -0.2}, {"pressure": 0.1}, {"speed": -0.05}, {"distance": 0.8},
                                    {"temperature": 5e-4}, {"level": 0.1, "speed": 0.04, "distance": -0.7}])
def test_what_was_changed_is_found_with_its_size(change):
    told = update(LAW, measured(3, **change))
    assert {TERMS[t] for t in told.best.terms} == set(change) and told.verdict == "values"
    for t, value, std in zip(told.best.terms, told.best.values, told.best.std, strict=True):
        assert abs(value - change[TERMS[t]]) < 3 * std


def test_stated_errors_of_values_hold():
    """Of values found 95 % lie within two standard deviations (25 of 30 at least: binomial, three deviations)."""
    within = []
    for seed in range(30):
        told = update(LAW, measured(seed, level=0.2, scatter=0.02))
        within.append(abs(told.best.values[0] - 0.2) < 2 * told.best.std[0])
    assert sum(within) >= 25


def test_scatter_between_tests_is_told_and_does_not_become_a_law():
    told = update(LAW, measured(5, scatter=0.05))
    assert told.best.scatter == pytest.approx(0.05, rel=0.3) and told.verdict == "consistent"


@pytest.mark.exact
def test_the_scatter_is_what_stated_errors_leave():
    """Squares over the variances of both sum up to the degrees of freedom; errors that suffice leave none."""
    random = np.random.default_rng(6)
    error = random.uniform(0.01, 0.03, 40)
    left = np.hypot(error, 0.02) * random.standard_normal(40)
    found = module._scatter(left, error, 2)
    assert found > 0 and np.sum(left**2 / (error**2 + found**2)) == pytest.approx(38, rel=1e-6)
    assert module._scatter(0.9 * error, error, 2) == 0.0


def test_a_change_within_the_error_of_the_map_may_be_chance_of_its_surfaces():
    told = update(LAW, measured(1, level=0.05), (0.04, 0.0, 0.0, 0.0, 0.0))
    assert [TERMS[t] for t in told.best.terms] == ["level"] and told.verdict == "chance"
    assert update(LAW, measured(1, level=0.2), (0.04, 0.0, 0.0, 0.0, 0.0)).verdict == "values"


def test_the_change_is_shown_on_tests_that_were_not_fitted():
    samples = measured(7, level=-0.3, speed=0.05)
    told, shown = update(LAW, samples), np.log(samples.friction)
    assert np.std(told.unseen - shown) < 0.015 and np.sqrt(np.mean((told.mapped - shown) ** 2)) > 0.25
    assert not np.array_equal(told.unseen, told.updated)


def test_terms_that_the_samples_cannot_tell_are_not_tried():
    samples = measured(2, level=0.1)
    bare = replace(samples, pressure=np.full(60, 1e6), speed=np.full(60, 1.0), temperature=np.full(60, 400.0),
                   distance=np.full(60, 5e-3))
    assert update(LAW, bare).tested == (module.LEVEL,)


def test_what_lies_beyond_the_map_is_counted():
    samples = measured(2)
    assert update(LAW, replace(samples, pressure=np.where(np.arange(60) < 7, 1e7, samples.pressure))).outside.sum() == 7


def test_two_changes_that_the_samples_cannot_tell_apart_are_a_tie():
    """Faster and hotter at once."""
    samples = measured(4, speed=-0.08)
    hot = replace(samples, temperature=400 + 40 * np.log(samples.speed))
    assert update(LAW, hot).verdict == "tie"


def test_groups_are_runs_conditions_or_single_samples():
    samples = measured(0, count=30)
    assert [g.sum() for g in groups(samples)] == [10, 10, 10]
    one = replace(samples, run=np.full(30, "a"))
    assert len(groups(one)) > 3
    alike = replace(one, pressure=np.full(30, 1e6), speed=np.full(30, 1.0), temperature=np.full(30, 300.0))
    assert len(groups(alike)) == 30


def test_two_samples_tell_nothing():
    with pytest.raises(ConfigError, match="three measured coefficients"):
        update(LAW, measured(count=2))
