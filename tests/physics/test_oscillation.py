"""Frequency and growth rate of synthetic oscillations."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.oscillation import dominant_frequency, growth_rate

STEP = 2e-5
TIME = np.arange(0, 0.2, STEP)


@pytest.mark.exact
@pytest.mark.parametrize("rate", [-40.0, -8.0, 0.0, 15.0])
@pytest.mark.parametrize("frequency", [431.7, 2003.0])
def test_an_exponential_oscillation_is_read_back(rate, frequency):
    signal = 3e-6 * np.exp(rate * TIME) * np.cos(2 * np.pi * frequency * TIME + 0.4) + 7e-5
    found = dominant_frequency(signal, STEP)
    assert found == pytest.approx(frequency, abs=0.5)
    assert growth_rate(signal, STEP, found) == pytest.approx(rate, abs=0.5)


def test_the_floor_under_a_decayed_oscillation_does_not_count():
    noise = 1e-8 * np.random.default_rng(1).normal(size=TIME.size)
    signal = 3e-6 * np.exp(-150 * TIME) * np.sin(2 * np.pi * 800 * TIME) + noise
    assert growth_rate(signal, STEP, 800.0) == pytest.approx(-150, rel=0.05)


def test_a_limit_cycle_neither_grows_nor_decays():
    envelope = 1 / (1 + np.exp(-(TIME - 0.02) * 400))
    assert abs(growth_rate(envelope * np.sin(2 * np.pi * 800 * TIME), STEP, 800.0)) < 2


def test_slow_drift_below_the_limit_is_no_oscillation():
    signal = 1e-4 * np.sin(2 * np.pi * 25 * TIME) + 1e-6 * np.sin(2 * np.pi * 900 * TIME)
    assert dominant_frequency(signal, STEP, 100.0) == pytest.approx(900, abs=1)
    assert dominant_frequency(signal, STEP) == pytest.approx(25, abs=2)


def test_silence_does_not_grow():
    assert growth_rate(np.zeros(5000), STEP, 500.0) == 0.0


def test_too_short_signals_are_refused():
    with pytest.raises(ConfigError, match="at least 6 periods"):
        growth_rate(np.sin(np.arange(100)), STEP, 2500.0)
    with pytest.raises(ConfigError, match="lines above"):
        dominant_frequency(np.zeros(100), STEP, 1e6)
