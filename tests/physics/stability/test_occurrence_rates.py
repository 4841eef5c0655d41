"""Shares over brakes and stops: closed forms, calibration of the test in simulated agreement, and its power."""

import numpy as np
import pytest
import scipy

from pipeline.physics.stability.occurrence_rates import Rate, rate


def drawn(rng, share, correlation, brakes, stops):
    """(brakes, stops) whether stops are noisy: the share of each brake is Beta distributed."""
    size = (1 - correlation) / correlation
    own = rng.beta(share * size, (1 - share) * size, (brakes, 1))
    return rng.uniform(size=(brakes, stops)) < own


@pytest.mark.exact
def test_of_one_stop_a_brake_the_interval_is_that_of_wilson():
    for hits in (0, 1, 17, 40):
        exact = scipy.stats.binomtest(hits, 40).proportion_ci(0.95, "wilson")
        made = rate(np.repeat([1, 0], [hits, 40 - hits])[:, None])
        assert made.effective == pytest.approx(40)
        assert made.interval() == pytest.approx((exact.low, exact.high), abs=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("correlation", [0.1, 0.4, 0.8])
def test_the_correlation_of_stops_of_one_brake_comes_back(correlation):
    made = rate(drawn(np.random.default_rng(1), 0.3, correlation, 4000, 3))
    assert made.share == pytest.approx(0.3, abs=0.02) and made.correlation == pytest.approx(correlation, abs=0.03)
    assert made.effective == pytest.approx(12000 / (1 + 2 * correlation), rel=0.05)


@pytest.mark.exact
def test_without_scatter_every_stop_is_the_same():
    for certain in (0, 1):
        made = rate(np.full((100, 2), certain))
        assert made.share == certain and made.interval()[certain] == certain
        assert made.p_value(certain * 10, 10) == pytest.approx(1, abs=1e-12)
        assert made.p_value((1 - certain) * 10, 10) < 0.02


@pytest.mark.parametrize("share, correlation", [
    (0.05, 0.3), (0.3, 0.02), (0.3, 0.5), (0.7, 0.9), (0.5, 0.2), (0.004, 0.9), (0.98, 0.5), (0.99, 0.02)])
def test_false_alarms_are_at_most_as_frequent_as_stated(share, correlation):
    """Bench and model are of one law: a p-value of at most 5 % occurs in at most 5 %, within 3.1 standard errors."""
    rng, count = np.random.default_rng(7), 600
    values = np.array([rate(drawn(rng, share, correlation, 60, 2)).p_value(
        int(drawn(rng, share, correlation, 1, 12).sum()), 12) for _ in range(count)])
    assert np.mean(values <= 0.05) <= 0.05 + 3.1 * np.sqrt(0.05 * 0.95 / count)


@pytest.mark.exact
@pytest.mark.parametrize("share, correlation", [(0.3, 0.2), (0.0, 0.999), (0.9, 0.001)])
def test_the_distribution_is_beta_binomial(share, correlation):
    made = Rate(share, correlation, 80.0)
    p, rho = (share * 80 + 0.5) / 81, min(correlation + (1 - correlation) / 81, 0.999)
    law = scipy.stats.betabinom(12, p * (1 - rho) / rho, (1 - p) * (1 - rho) / rho)
    np.testing.assert_allclose(made.distribution(12), law.pmf(np.arange(13)), rtol=1e-9, atol=1e-15)
    tails = law.sf(4) if share == 0 else 2 * min(law.cdf(5), law.sf(4))
    assert made.p_value(5, 12) == pytest.approx(min(1, tails), rel=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("count", [20, 100, 250])
def test_what_no_draw_does_is_as_improbable_as_their_number_says(count):
    """A brake that differs with probability q, of which ``count`` draws show none, is at most max q (1 - q)^count
    frequent: the p-value is not below that."""
    made = rate(np.zeros((count, 1)))
    q = 1 / (count + 1)
    assert q * (1 - q) ** count <= made.p_value(10, 10) <= 1 / (count + 1)


def test_one_brake_cannot_contradict_what_differs_between_brakes_alone():
    rng = np.random.default_rng(2)
    apart = rate(np.repeat(rng.uniform(size=(200, 1)) < 0.3, 2, axis=1))
    alike = rate(rng.uniform(size=(200, 2)) < 0.3)
    assert apart.correlation > 0.95 and alike.correlation < 0.2
    assert apart.least(12) > 0.3 and alike.least(12) < 1e-3
    assert alike.p_value(12, 12) < 1e-4 and alike.p_value(3, 12) > 0.5
