"""Saturating oscillations of known growth, amplitude and harmonics."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.limit_cycle import cycle, harmonic_levels

STEP = 2e-5


def saturating(growth, duration, frequency=2200.0, size=3.0, begin=1e-4):
    """Amplitude of the van der Pol kind: exponential growth from ``begin`` that ends at ``size``."""
    time = np.arange(0, duration, STEP)
    ratio = (begin / size) ** 2 * np.exp(2 * growth * time)
    return size * np.sqrt(ratio / (1 + ratio)) * np.sin(2 * np.pi * frequency * time)


@pytest.mark.exact
def test_settled_cycle_and_its_growth_before():
    found = cycle(saturating(100.0, 0.4), STEP, 0.1, 0.02)
    assert found.settled and found.grew and found.drift < 0.02
    assert found.frequency == pytest.approx(2200, abs=0.5)
    assert found.amplitude == pytest.approx(3.0, rel=1e-3)
    assert found.growth == pytest.approx(100.0, rel=0.03)


def test_a_window_in_pure_growth_has_not_settled():
    found = cycle(saturating(100.0, 0.06), STEP, 0.02, 0.02)
    assert not found.settled and found.drift > 0.5
    assert found.growth == pytest.approx(100.0, rel=0.03)


def test_a_window_of_too_few_periods_is_not_called_settled():
    assert not cycle(np.sin(2 * np.pi * 100 * np.arange(0, 1, STEP)), STEP, 0.1, 0.02).settled


def test_steady_and_decaying_motion_show_no_growth():
    time = np.arange(0, 0.4, STEP)
    for signal in (np.sin(14e3 * time), np.exp(-20 * time) * np.sin(14e3 * time), np.full(len(time), 2.0)):
        found = cycle(signal, STEP, 0.1, 0.02)
        assert not found.grew and found.growth == 0
    assert found.settled and found.amplitude == 0


@pytest.mark.parametrize("speed", [0.1, -0.3, 1 / 3, 0.0])
def test_a_uniform_motion_is_no_cycle(speed):
    """A free mass that is carried along: what rounding leaves about the mean is no amplitude."""
    signal = np.full(20000, speed)
    signal[::7] = np.nextafter(speed, 1.0) if speed else 0.0
    found = cycle(signal, STEP, 0.1, 0.02)
    assert found.settled and found.amplitude == found.drift == found.frequency == 0


@pytest.mark.exact
def test_harmonics_of_known_amplitude():
    time = np.arange(0, 0.2, STEP)
    signal = sum(a * np.cos(2 * np.pi * 2000 * k * time + k) for k, a in ((1, 2.0), (2, 0.1), (3, 0.5), (12, 0.3)))
    found = harmonic_levels(signal + 7, 1 / STEP, 2000.0, 13)
    np.testing.assert_allclose(found[[0, 1, 2, 11]], [2.0, 0.1, 0.5, 0.3], rtol=1e-3)
    np.testing.assert_allclose(found[[3, 7, 12]], 0, atol=1e-3)


def test_window_beyond_the_signal_is_refused():
    with pytest.raises(ConfigError, match="window"):
        cycle(np.ones(100), STEP, 0.1, 0.02)
