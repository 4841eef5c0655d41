"""Effective samples, weights of runs, and energy that noise does not explain."""

import numpy as np
import pytest

from pipeline.inference.fitting.effective_sample_size import coherent_energy, effective_share, tempering
from pipeline.inference.fitting.noise import whitening
from tests.inference.fitting.test_noise import coloured, run

SIZE = 40000


def unit_noise(size=SIZE, channels=1):
    return whitening(run(np.zeros((channels, size))), np.ones((channels, 1)))


@pytest.mark.exact
@pytest.mark.parametrize("coefficient", [0.5, 0.9])
def test_the_effective_number_of_an_autoregression(coefficient):
    share = np.mean([effective_share(unit_noise(), coloured(k, SIZE, coefficient)) for k in range(8)])
    expected = (1 - coefficient**2) / (1 + coefficient**2)
    assert share == pytest.approx(expected, rel=0.05)


@pytest.mark.exact
@pytest.mark.parametrize("coefficient", [0.3, 0.9])
def test_the_effective_number_along_a_slow_motion(coefficient):
    """1 + 2 sum_k a^k = (1 + a) / (1 - a): what var(sum r cos(w t)) tends to for slow motion."""
    share = np.mean([effective_share(unit_noise(), coloured(k, SIZE, coefficient), 1) for k in range(8)])
    assert share == pytest.approx((1 - coefficient) / (1 + coefficient), rel=0.15)


def test_it_predicts_how_much_a_sum_of_squares_varies():
    series = np.array([coloured(k, 2000, 0.8, 1.0) for k in range(400)])
    sums = (series**2).sum(axis=1)
    share = np.mean([effective_share(unit_noise(2000), s) for s in series[:40]])
    assert np.var(sums) == pytest.approx(2 * sums.mean() ** 2 / (2000 * share), rel=0.25)


def test_white_noise_counts_in_full():
    shares = [effective_share(unit_noise(), np.random.default_rng(k).standard_normal(SIZE)) for k in range(10)]
    assert min(shares) > 0.99


@pytest.mark.exact
def test_channels_add():
    white, slow = np.random.default_rng(0).standard_normal(SIZE), coloured(1, SIZE, 0.9)
    one = unit_noise()
    expected = (effective_share(one, white) + effective_share(one, slow)) / 2
    assert effective_share(unit_noise(channels=2), np.concatenate((white, slow))) == pytest.approx(expected)


def test_a_run_weighs_less_where_its_residual_exceeds_its_noise():
    white = np.random.default_rng(0).standard_normal(SIZE)
    weights = tempering((unit_noise(),) * 2, (white, 3 * white))
    assert weights[0] > 0.97 and weights[1] == pytest.approx(1 / np.mean((3 * white) ** 2), rel=0.01)


def test_faint_colour_counts_along_a_motion_in_short_records():
    shares = [effective_share(unit_noise(500), coloured(k, 500, 0.2, 1.0), 1) for k in range(40)]
    assert np.mean(shares) == pytest.approx(2 / 3, abs=0.08)
    assert np.mean([effective_share(unit_noise(500), np.random.default_rng(k).standard_normal(500), 1)
                    for k in range(40)]) > 0.94


def test_colour_is_no_coherent_energy():
    alarms = [coherent_energy(unit_noise(500), coloured(k, 500, 0.2, 1.0)) > 0 for k in range(400)]
    assert np.mean(alarms) < 0.02


def test_coherent_energy_is_that_of_a_tone_and_nothing_in_noise():
    noise, time = unit_noise(4000), np.arange(4000)
    tone = 0.3 * np.sin(2 * np.pi * 100 * time / 4000)
    found = [coherent_energy(noise, np.random.default_rng(k).standard_normal(4000) + tone) for k in range(40)]
    assert np.mean(found) == pytest.approx(tone @ tone, rel=0.05)
    alarms = [coherent_energy(noise, np.random.default_rng(k).standard_normal(4000), chance=0.05) > 0
              for k in range(400)]
    assert 0.02 < np.mean(alarms) < 0.09
