"""Growth rate and frequency of onsets: exponentials in noise, van der Pol's oscillator, and what is no onset."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.physics.signals.onsets.growth_rate import Growth, growth, mean, spread_of

RATE = 25.6e3
#: a squeal of three channels, 1 in saturation
ROOT, SHAPE = 120 + 2j * np.pi * 1830, np.array([1.0, 0.4 * np.exp(1.1j), -0.7j])


def squeal(root=ROOT, noise=1e-3, seed=0, start=2e-5, duration=0.3, begin=0.1):
    """(3, n) of Stuart and Landau's oscillator z' = p z (1 - |z|^2), begun at ``begin`` s, in white noise."""
    random = np.random.default_rng(seed)
    time = np.arange(round(duration * RATE)) / RATE
    since = np.maximum(time - begin, 0.0)
    grown = np.minimum(2 * root.real * since, 300)
    size = start * np.exp(grown / 2) / np.sqrt(1 + start**2 * np.expm1(grown)) * (time >= begin)
    wave = size * np.exp(1j * (root.imag * since + random.uniform(0, 2 * np.pi)))
    return np.real(np.outer(SHAPE, wave)) + noise * random.standard_normal((3, len(time)))


def clipped(root=ROOT, noise=1e-3, seed=0):
    """(3, n) of an exponential that stops growing at once when it has reached 1, in white noise."""
    random = np.random.default_rng(seed)
    time = np.arange(round((0.12 + 14 / root.real) * RATE)) / RATE
    since = time - 0.1 - np.log(5e4) / root.real
    wave = np.exp(np.minimum(root.real * since, 0.0)) * (time > 0.1)
    wave = wave * np.exp(1j * (root.imag * since + random.uniform(0, 2 * np.pi)))
    return np.real(np.outer(SHAPE, wave)) + noise * random.standard_normal((3, len(time)))


@pytest.mark.parametrize("make", [squeal, clipped])
def test_the_growth_of_a_squeal_in_noise_is_found_within_its_stated_error(make):
    """200 draws: 95 % intervals of either part hold in 90 to 98 %, and the mean error lies below the stated one."""
    fits = [growth(make(seed=k), RATE, 300, 5000) for k in range(200)]
    error, std = np.array([f.root for f in fits]) - ROOT, np.array([f.std for f in fits])
    for part in (error.real, error.imag):
        assert 0.90 <= np.mean(abs(part) < 1.96 * std) <= 0.98
        assert abs(part.mean()) < std.mean()
    assert all(f.saturates for f in fits) and std.mean() < 0.01 * ROOT.real


@pytest.mark.parametrize("root", [45 + 2j * np.pi * 640, 420 + 2j * np.pi * 3100])
def test_slow_and_fast_growth(root):
    fits = [growth(squeal(root, seed=k, duration=0.12 + 14 / root.real), RATE, 300, 5000) for k in range(20)]
    for fit in fits:
        assert abs(fit.root.real - root.real) < 4 * fit.std and abs(fit.root.imag - root.imag) < 4 * fit.std
    assert np.median([fit.std for fit in fits]) < 0.01 * root.real


def test_the_direction_of_the_mode_is_told():
    shape = growth(squeal(noise=1e-4), RATE, 300, 5000).shape
    assert shape / shape[0] == pytest.approx(SHAPE / SHAPE[0], abs=2e-3)


@pytest.mark.parametrize("strength", [0.01, 0.04])
def test_van_der_pol_from_onset_to_limit_cycle(strength):
    """x'' - e w (1 - x^2) x' + w^2 x = 0: p = w (e / 2 + i sqrt(1 - e^2 / 4)) about rest, amplitude 2 at the end."""
    omega = 2 * np.pi * 1000
    time = np.arange(0, 0.05 + 30 / (strength * omega), 1 / RATE)
    motion = scipy.integrate.solve_ivp(
        lambda t, x: (x[1], strength * omega * (1 - x[0]**2) * x[1] - omega**2 * x[0]), (0, time[-1]),
        (1e-4, 0.0), "DOP853", time, rtol=1e-10, atol=1e-12).y[0]
    quiet = np.zeros(round(0.1 * RATE))
    samples = np.concatenate((quiet, motion)) + 1e-4 * np.random.default_rng(0).standard_normal(len(quiet) + len(time))
    fit = growth(samples[None], RATE, 300, 3000)
    exact = omega * (strength / 2 + 1j * np.sqrt(1 - strength**2 / 4))
    assert abs(fit.root.real - exact.real) < 2.5 * fit.std and abs(fit.root.imag - exact.imag) < 2.5 * fit.std
    assert fit.std < 0.02 * exact.real and fit.saturates


def test_a_law_that_bends_early_ends_the_window_early():
    """Growth that falls with the amplitude itself, not with its square, is no exponential with a beginning of
    saturation: the window ends where that is lost in the noise, and what stays is below 2 % of the growth."""
    time = np.arange(round(0.4 * RATE)) / RATE
    size = np.full(len(time), 1e-5)
    for k in range(round(0.1 * RATE), len(time)):
        size[k] = size[k - 1] * np.exp((1 - min(4 * size[k - 1], 1.0)) * 120 / RATE)
    samples = size * np.cos(2 * np.pi * 1830 * time) + 1e-5 * np.random.default_rng(0).standard_normal(len(time))
    fit = growth(samples[None], RATE, 300, 5000)
    assert fit.end < 0.17 and fit.root.real == pytest.approx(120, rel=0.02)


def test_a_record_without_squeal_has_no_onset():
    noise = np.random.default_rng(0).standard_normal((3, 8000))
    with pytest.raises(ConfigError, match="outgrows the noise floor"):
        growth(noise, RATE, 300, 5000)


def test_a_tap_that_decays_has_no_onset():
    time = np.arange(8000) / RATE
    ring = np.exp(-40 * time) * np.sin(2 * np.pi * 900 * time) * (time > 0.1)
    with pytest.raises(ConfigError, match="onset"):
        growth(ring[None] + 1e-4 * np.random.default_rng(0).standard_normal((1, 8000)), RATE, 300, 5000)


def test_a_record_that_begins_in_the_squeal_has_no_onset():
    with pytest.raises(ConfigError, match="onset"):
        growth(squeal()[:, round(0.19 * RATE):], RATE, 300, 5000)


def test_an_onset_that_noise_leaves_too_short_is_told():
    with pytest.raises(ConfigError, match="outgrows the noise floor 90 times"):
        growth(squeal(noise=0.1, duration=0.4), RATE, 300, 5000)


def test_an_onset_of_a_few_periods_is_told():
    with pytest.raises(ConfigError, match="10 periods and a growth by e"):
        growth(squeal(1500 + 2j * np.pi * 400, noise=1e-4, start=1e-5), RATE, 300, 5000)


def test_growth_that_is_not_over_is_not_called_saturated():
    assert not growth(clipped()[:, :round(0.18 * RATE)], RATE, 300, 5000).saturates


def fit(root, std=1.0):
    return Growth(root, std, 0.0, SHAPE * np.exp(1j * root.real), 0.0, 0.1, 3.0, True)


def test_the_mean_of_stops_that_agree_is_known_better_by_their_root():
    stops = mean([fit(ROOT + 0.5, 2.0), fit(ROOT - 0.5j, 2.0), fit(ROOT, 2.0)])
    assert stops.root == pytest.approx(ROOT + 0.5 / 3 - 0.5j / 3) and stops.std == pytest.approx(2 / np.sqrt(3))
    assert abs(np.vdot(stops.shape, SHAPE)) == pytest.approx(np.linalg.norm(SHAPE)) and stops.count == 3


def test_the_spread_over_stops_counts_beyond_their_own_errors():
    """Six points of three stops whose growth rates spread by 10 rad/s: the pooled spread, and 95 % intervals of the
    means."""
    random, spreads, held = np.random.default_rng(2), [], []
    for _ in range(200):
        points = [[fit(ROOT + 10 * random.standard_normal() + 1j * random.standard_normal(), own)
                   for own in (0.1, 1.0, 3.0)] for _ in range(6)]
        spreads.append(spread_of(points))
        held += [abs(stops.root.real - ROOT.real) < 1.96 * stops.std
                 for stops in (mean(point, spreads[-1]) for point in points)]
    assert np.mean(np.square(spreads)) == pytest.approx(100, rel=0.1)
    assert 0.90 <= np.mean(held) <= 0.98


def test_stops_that_agree_within_their_errors_have_no_spread():
    assert spread_of([[fit(ROOT + 0.5), fit(ROOT - 0.5)]]) == 0.0
    assert spread_of([[fit(ROOT)], []]) == 0.0
