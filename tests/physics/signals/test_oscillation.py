"""Frequency and growth rate of synthetic oscillations."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.oscillation import dominant_frequency, growth_rate, sign_is_decided

STEP = 2e-5
TIME = np.arange(0, 0.2, STEP)


@pytest.mark.exact
@pytest.mark.parametrize("rate", [-40.0, -8.0, 0.0, 15.0])
@pytest.mark.parametrize("frequency", [431.7, 2003.0])
def test_an_exponential_oscillation_is_read_back(rate, frequency):
    signal = 3e-6 * np.exp(rate * TIME) * np.cos(2 * np.pi * frequency * TIME + 0.4) + 7e-5
    found = dominant_frequency(signal, STEP)
    assert found == pytest.approx(frequency, abs=0.5)
    fitted, deviation = growth_rate(signal, STEP, found)
    assert fitted == pytest.approx(rate, abs=0.5) and deviation < 0.5
    assert rate == 0 or sign_is_decided(fitted, deviation)


def test_the_floor_under_a_decayed_oscillation_does_not_count():
    noise = 1e-8 * np.random.default_rng(1).normal(size=TIME.size)
    signal = 3e-6 * np.exp(-150 * TIME) * np.sin(2 * np.pi * 800 * TIME) + noise
    fitted, deviation = growth_rate(signal, STEP, 800.0)
    assert fitted == pytest.approx(-150, rel=0.05) and deviation < 0.05 * 150


def test_a_floor_that_comes_and_goes_does_not_count():
    rest = 0.02 * np.sin(2 * np.pi * 800 * TIME) * (TIME > 0.15)
    fitted, deviation = growth_rate(np.exp(-80 * TIME) * np.sin(2 * np.pi * 800 * TIME) + rest, STEP, 800.0)
    assert fitted == pytest.approx(-80, rel=0.03) and sign_is_decided(fitted, deviation)


@pytest.mark.parametrize("reached", [0.02, 0.06, 0.12])
def test_growth_that_saturates_is_undecided(reached):
    envelope = 1 / (1 + np.exp(-(TIME - reached) * 400))
    fitted, deviation = growth_rate(envelope * np.sin(2 * np.pi * 800 * TIME), STEP, 800.0)
    assert fitted > 0 and not sign_is_decided(fitted, deviation)


@pytest.mark.parametrize("phase", [0.0, 1.0, 2.5])
def test_beating_is_undecided(phase):
    tones = np.sin(2 * np.pi * 800 * TIME) + 0.8 * np.sin(2 * np.pi * 806.5 * TIME + phase)
    assert not sign_is_decided(*growth_rate(tones, STEP, 800.0))


def test_growth_and_decay_under_noise_stay_decided():
    noise = 0.05 * np.random.default_rng(2).normal(size=TIME.size)
    for rate in (-12.0, 12.0):
        fitted, deviation = growth_rate(np.exp(rate * TIME) * np.sin(2 * np.pi * 800 * TIME) + noise, STEP, 800.0)
        assert np.sign(fitted) == np.sign(rate) and sign_is_decided(fitted, deviation)


def test_slow_drift_below_the_limit_is_no_oscillation():
    signal = 1e-4 * np.sin(2 * np.pi * 25 * TIME) + 1e-6 * np.sin(2 * np.pi * 900 * TIME)
    assert dominant_frequency(signal, STEP, 100.0) == pytest.approx(900, abs=1)
    assert dominant_frequency(signal, STEP) == pytest.approx(25, abs=2)


def test_silence_does_not_grow():
    assert growth_rate(np.zeros(5000), STEP, 500.0) == (0.0, 0.0)


def test_too_short_signals_are_refused():
    with pytest.raises(ConfigError, match="at least 6 periods"):
        growth_rate(np.sin(np.arange(100)), STEP, 2500.0)
    with pytest.raises(ConfigError, match="lines above"):
        dominant_frequency(np.zeros(100), STEP, 1e6)
