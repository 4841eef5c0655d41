"""Location: family-wise p-values that are even under the null, sets that cover, the right item on every axis."""

import numpy as np
import pytest
from scipy import stats

from pipeline.contract.errors import ConfigError
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.search.localisation import against_null, bands, credible_set, holm, places, regimes, stages
from tests.inference import linear

EVEN = 1.63     # Kolmogorov-Smirnov bound at 1 %, times 1 / sqrt(n)


@pytest.mark.exact
def test_holm_is_the_published_example():
    np.testing.assert_allclose(holm([0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02])


@pytest.mark.exact
def test_a_credible_set_is_the_smallest_that_suffices():
    np.testing.assert_array_equal(credible_set([0.05, 0.6, 0.35]), [False, True, True])
    np.testing.assert_array_equal(credible_set([0.03, 0.96, 0.01]), [False, True, False])


@pytest.mark.exact
def test_the_p_value_of_a_maximum_is_family_wise():
    null = np.random.default_rng(0).standard_normal((40000, 5))
    told = against_null("abcde", [2.0, 0, 0, 0, 0], null)
    assert told.p_value[0] == pytest.approx(1 - stats.norm.cdf(2.0) ** 5, abs=4 * np.sqrt(0.1 / 40000))
    assert told.significant(0.2) == ("a",) and told.members[0]


def test_regimes_find_the_bin_where_the_residual_grows_and_are_even_where_none_does():
    speed = np.sin(2 * np.pi * np.arange(4000) / 333)
    edges = np.linspace(-1, 1, 6)
    smallest = []
    for seed in range(150):
        white = np.random.default_rng(seed).standard_normal(4000)
        smallest.append(regimes(white**2, speed, edges, draws=400, seed=seed).p_value.min())
    assert stats.kstest(smallest, "uniform").statistic < EVEN / np.sqrt(150)
    loud = white * (1 + 2.0 * (np.abs(speed) < 0.2))
    told = regimes(loud**2, speed, edges)
    assert (told.p_value < 0.01).tolist() == [False, False, True, False, False]
    assert told.members.tolist() == [False, False, True, False, False]


def test_bands_find_a_tone_and_are_even_without():
    edges = np.linspace(0, 500, 11)
    smallest = [bands(np.random.default_rng(s).standard_normal(2000), 1000.0, edges, 400, s).p_value.min()
                for s in range(200)]
    assert stats.kstest(smallest, "uniform").statistic < EVEN / np.sqrt(200)
    white = np.random.default_rng(0).standard_normal(2000) + 0.5 * np.sin(2 * np.pi * 0.223 * np.arange(2000))
    told = bands(white, 1000.0, edges)
    assert told.significant(0.01) == ((200.0, 250.0),) and told.members.sum() == 1


def test_stages_find_what_removes_the_error_and_are_even_where_nothing_does():
    names = ("friction", "modes", "contact")
    smallest, generator = [], np.random.default_rng(0)
    for seed in range(200):
        noise = {name: generator.standard_normal(24) for name in names}
        smallest.append(stages(names, noise, 400, seed).p_value.min())
    assert stats.kstest(smallest, "uniform").statistic < EVEN / np.sqrt(200)
    told = stages(names, noise | {"contact": noise["contact"] + 2.0})
    assert told.significant(0.01) == ("contact",) and told.members.tolist() == [False, False, True]
    with pytest.raises(ConfigError, match="at least four blocks"):
        stages(names, {name: [1.0] for name in names})


def located(seed, truth=None):
    """Places of two force shapes each; the effects of the linear problem stand for their responses."""
    whole, noise, catalogue, tables = linear.problem((2, 2, 2, 2), seed=seed, truth=truth)
    null = fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(2), whole.training)
    bases = {c.name: linear.dense(whole, c, tables)[1] for c in catalogue}
    return places(tuple(bases), bases, null, draws=1000, seed=seed)


def test_places_are_found_and_their_p_values_even_under_the_null():
    smallest = [located(seed).p_value.min() for seed in range(200)]
    assert stats.kstest(smallest, "uniform").statistic < EVEN / np.sqrt(200)
    told = located(3, {"effect_2_0": 0.4, "effect_2_1": -0.4})
    assert told.significant(0.01) == ("effect_2",) and told.members.tolist() == [False, True, False]


def test_the_set_of_places_covers_the_truth():
    generator, inside = np.random.default_rng(1), []
    for seed in range(150):
        amplitude = generator.standard_normal(2) * 0.15
        told = located(seed, {"effect_1_0": amplitude[0], "effect_1_1": amplitude[1]})
        inside.append(told.members[0])
    assert np.mean(inside) > 0.95 - 3 * np.sqrt(0.05 * 0.95 / 150)
