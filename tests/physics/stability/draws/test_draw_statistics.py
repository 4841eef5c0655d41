"""Rates, bands and first-order indices beside what is known exactly."""

import numpy as np
import pytest
import scipy

from pipeline.physics.stability.draws.draw_statistics import (
    among_bands,
    band_of,
    draws_needed,
    even_scores,
    explained,
    first_order,
    rate_change,
    rate_interval,
    squealing,
    third_octaves,
)

pytestmark = pytest.mark.exact


def _wilson(hits, n):
    """(middle, half the width) of the interval."""
    p, z = hits / n, 1.959963984540054
    middle, half = p + z**2 / (2 * n), z * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
    return middle / (1 + z**2 / n), half / (1 + z**2 / n)


def test_interval_is_wilsons():
    middle, half = _wilson(10, 40)
    np.testing.assert_allclose(rate_interval(10, 40), (middle - half, middle + half))
    assert rate_interval(0, 0) == (0.0, 1.0)


def test_draws_needed_are_the_first_whose_interval_is_narrow_enough():
    for hits, count in ((87, 100), (50, 100), (0, 20), (20, 20)):
        needed = draws_needed(hits, count, 0.05)
        assert _wilson(hits / count * needed, needed)[1] <= 0.05 < _wilson(hits / count * (needed - 1), needed - 1)[1]
    assert draws_needed(90, 1000, 0.05) == 1000


def test_ending_draws_by_the_width_of_the_interval_takes_less_than_a_point_off_its_95_percent():
    """Exactly: the chance of every number of hits at every end of the draws, as the stage makes them by default."""
    rate, step, within, layer, covered = 0.87, 10, 0.05, {(0, 0): 1.0}, 0.0
    while layer:
        following = {}
        for (hits, count), chance in layer.items():
            needed = draws_needed(hits, count, within) if count else 100
            if needed == count:
                low, high = rate_interval(hits, count)
                covered += chance * (low <= rate <= high)
                continue
            more = max(needed - count, step)
            for extra, share in enumerate(scipy.stats.binom.pmf(np.arange(more + 1), more, rate)):
                if chance * share > 1e-7:
                    key = hits + extra, count + more
                    following[key] = following.get(key, 0.0) + chance * share
        layer = following
    assert 0.94 < covered < 0.95


def test_even_scores_are_standard_normal_and_the_first_of_more_are_those_of_fewer():
    scores = even_scores(512, 12, 3)
    assert all(scipy.stats.kstest(column, "norm").pvalue > 0.99 for column in scores.T)
    assert abs(np.corrcoef(scores.T) - np.eye(12)).max() < 0.05
    np.testing.assert_array_equal(even_scores(100, 12, 3), scores[:100])
    assert abs(even_scores(512, 12, 4) - scores).max(axis=0).min() > 1
    assert even_scores(0, 12, 3).shape == (0, 12) and even_scores(3, 0, 3).shape == (3, 0)
    assert even_scores(1, 2, 3).shape == (1, 2)


def test_what_scores_explain_is_the_share_that_is_linear_in_them():
    """Of sign(x): (2 / pi); of the product of two sources, and of a source that is not there: nothing."""
    scores = np.random.default_rng(1).standard_normal((20_000, 4))
    assert explained(scores, scores[:, 0] > 0) == pytest.approx(2 / np.pi, abs=0.01)
    assert explained(scores, scores[:, 0] * scores[:, 1] > 0) < 0.002
    assert explained(scores[:, 1:], scores[:, 0] > 0) < 0.002
    few = [np.mean([explained(part, part[:, 0] > 0) for part in np.split(scores[:20_000], count)])
           for count in (200, 500)]
    np.testing.assert_allclose(few, 2 / np.pi, atol=0.01)       # of 100 and of 40 draws: adjusted, no more for fewer
    assert explained(scores[:20], scores[:20, 0] > 0) == 0.0 == explained(scores, scores[:, 0] > 9)


@pytest.mark.parametrize(("modes", "rate"), [(1, 0.84), (1, 0.5), (3, 0.84), (3, 0.3)])
def test_intervals_of_even_draws_hold_the_rate_in_95_percent_and_end_sooner(modes, rate):
    """A system squeals if any of some modes, each of which sources of its own drive, is above a level."""
    weights = np.kron(np.eye(modes), [[0.8], [0.5], [0.3], [0.1]]) / np.linalg.norm([0.8, 0.5, 0.3, 0.1])
    level = scipy.special.ndtri((1 - rate) ** (1 / modes))
    covered, made = [], []
    for seed in range(200):
        scores = even_scores(400, len(weights), seed)
        hits, count = (scores @ weights > level).any(axis=1), 0
        while count < (needed := 100 if not count else min(draws_needed(
                hits[:count].sum(), count, 0.05, explained(scores[:count], hits[:count])), 400)):
            count = needed
        low, high = rate_interval(hits[:count].sum(), count, explained(scores[:count], hits[:count]))
        covered.append(low <= rate <= high)
        made.append(count)
    assert np.mean(covered) >= 0.94
    assert np.mean(made) < 0.8 * draws_needed(100 * rate, 100, 0.05)


def test_change_of_two_rates_is_that_of_newcombes_example():
    """56 of 70 against 48 of 80: 0.2000, 0.0524 to 0.3339 (Stat. Med. 17 (1998) 873, table II, method 10)."""
    before, after = np.arange(80) < 48, np.arange(70) < 56
    change, interval = rate_change(before, after, paired=False)
    assert change == pytest.approx(0.2) and interval == pytest.approx((0.0524, 0.3339), abs=5e-5)
    assert rate_change([], after, paired=False) == (0.0, (-1.0, 1.0))


def test_paired_changes_are_covered_and_narrower():
    """Of 400 samples of 100 pairs about 95 % hold the true change; the same draws with nothing changed hold 0."""
    rng, covered, widths = np.random.default_rng(2), 0, []
    for _ in range(400):
        draw = rng.uniform(size=100)
        before, after = draw < 0.5, draw + 0.02 * rng.standard_normal(100) < 0.4
        ends = [rate_change(before, after, paired)[1] for paired in (True, False)]
        covered += ends[0][0] <= -0.1 <= ends[0][1]
        widths.append([high - low for low, high in ends])
    assert covered >= 372 and np.mean(widths, axis=0)[0] < 0.7 * np.mean(widths, axis=0)[1]
    change, (low, high) = rate_change(before, before, paired=True)
    assert change == 0 and low < 0 < high < 0.05


def test_bands_are_those_of_the_standard():
    middles = third_octaves(200.0, 20e3)
    np.testing.assert_allclose(middles[[0, 7, -1]], [199.526, 1000.0, 19952.6], rtol=1e-5)
    edge = 1e3 * 10 ** (1 / 20)
    np.testing.assert_array_equal(middles[band_of([edge * 0.999, edge * 1.001, 8e3], middles)].round(),
                                  [1000, 1259, 7943])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_first_order_indices_of_a_known_function(seed):
    """y = 2 a - b + 3 c d of standard normal a to e: indices 4/14, 1/14, 0, 0, 0."""
    values = np.random.default_rng(seed).standard_normal((2000, 5))
    outcome = 2 * values[:, 0] - values[:, 1] + 3 * values[:, 2] * values[:, 3]
    index, error, trend = first_order(values, outcome, seed)
    np.testing.assert_array_less(abs(index - np.array([4, 1, 0, 0, 0]) / 14), 4 * error + 0.01)
    assert trend[0] > 0.3 and trend[1] < -0.1 and abs(trend[4]) < 0.1 and error.max() < 0.04


def test_an_outcome_that_does_not_vary_has_no_sensitivities():
    assert not first_order(np.random.default_rng(0).normal(size=(100, 2)), np.ones(100), 1).any()


def test_roots_count_where_they_are_high_enough_and_in_the_nearest_band():
    root = 2 * np.pi * np.array([500j, 1000j, 3.2e3j, 5e4j])
    hits = squealing(root, np.array([0, 1, 1, 2]), np.array([0, 0, 1, 1]), (3, 2), 1000.0)
    assert hits.tolist() == [[False, False], [True, True], [False, True]]
    assert among_bands(root, third_octaves(1000.0, 4000.0)).tolist() == [0, 0, 5, 6]
