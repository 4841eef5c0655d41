"""Values that change along the runs: their size in closed form, even p-values where they do not, features."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.varying_values import followed
from pipeline.inference.problem import Problem
from tests.inference import linear


def fitted(seed=0, samples=400, shape=lambda time: 1.0, size=lambda time: 1.0):
    """Fit of the effect of a linear problem, 3 noises large at every sample and following ``shape`` of the time.

    ``size`` of the time: that of the column of the effect.
    """
    whole, noise, catalogue, tables = linear.problem((1, 1), 3, samples, {"nominal_0": 0.5}, seed)
    time, effect = np.linspace(-1, 1, samples), "effect_1_0"
    for columns in tables.values():
        columns[effect] *= size(time)
    runs = tuple(replace(run, samples=run.samples + 1.5 * shape(time) * tables[run.name][effect]) for run in whole.runs)
    whole = Problem(runs, whole.predict, whole.nominal)
    return fit(whole, tuple(noise[r.name] for r in runs), whole.nominal.joined(catalogue[0]), np.zeros(2), runs)


@pytest.mark.exact
def test_a_value_that_follows_time_is_told_by_how_much():
    by_time, _ = followed(fitted(shape=lambda time: 1 + 0.2 * time), 1)
    assert by_time.what == "time" and by_time.change == pytest.approx(0.2, abs=0.06) and by_time.deviate > 5


def test_deviates_are_even_where_nothing_changes():
    found = np.array([[f.deviate for f in followed(fitted(seed, 150), 1)] for seed in range(150)])
    for deviates in found.T:
        assert stats.kstest(2 * stats.norm.sf(deviates), "uniform").statistic < 1.63 / np.sqrt(150)


@pytest.mark.parametrize("power", [0.0, 0.1])
def test_a_value_that_follows_the_size_of_the_motion_is_told(power):
    """A force that grows as the power 1.1 of what is fitted as proportional: ln 10 of size, 0.115 to either end."""
    def grows(time):
        return 10.0 ** (0.5 * np.cos(np.pi * time))

    _, by_size = followed(fitted(samples=2000, size=grows, shape=lambda time: grows(time) ** power), 1)
    assert by_size.what == "the size of the motion"
    error = abs(by_size.change) / by_size.deviate
    assert by_size.change == pytest.approx(power * 0.5 * np.log(10.0), abs=3 * error)
    assert (by_size.deviate > 4) == (power > 0)


def test_nominal_values_and_effects_of_no_size_follow_nothing():
    found = fitted()
    assert followed(found, 0) == []
    assert followed(replace(found, latent=np.zeros(2)), 1) == []
