"""Bursts of a gated tone, and the lines of a sum of tones."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.bursts import bursts, harmonic_lines

INTERVAL = 1e-5
TIME = INTERVAL * np.arange(60000)


@pytest.mark.exact
def test_a_tone_switched_on_and_off():
    """40 ms on, 20 ms off: two thirds of the time."""
    gate = (TIME % 0.06) < 0.04
    found = bursts(gate * np.sin(2 * np.pi * 2700 * TIME), INTERVAL, 2e-3, 0.3)
    assert found.share == pytest.approx(2 / 3, abs=0.01)
    assert found.burst == pytest.approx(0.04, abs=1e-3) and found.pause == pytest.approx(0.02, abs=1e-3)


@pytest.mark.exact
def test_a_steady_tone_and_silence():
    steady = bursts(np.sin(2 * np.pi * 2700 * TIME), INTERVAL, 2e-3, 0.3)
    assert steady.share == 1.0 and steady.burst == pytest.approx(0.6) and steady.pause == 0.0
    silent = bursts(np.zeros(1000), INTERVAL, 1e-3, 0.3)
    assert silent.share == 0.0 and silent.pause == pytest.approx(0.01)
    with pytest.raises(ConfigError, match="frame"):
        bursts(np.zeros(100), INTERVAL, 1e-3, 0.3)


@pytest.mark.exact
def test_lines_of_three_tones():
    """Amplitudes 1, 0.1, 0.01: 0, -20 and -40 dB; the fourth multiple is not there."""
    noise = 1e-5 * np.random.default_rng(1).standard_normal(len(TIME))
    signal = sum(0.1**k * np.sin(2 * np.pi * 2700 * (k + 1) * TIME) for k in range(3)) + noise
    fundamental, level, height = harmonic_lines(signal, INTERVAL, 20.0, 100.0, 4)
    assert fundamental == pytest.approx(2700, abs=10)
    np.testing.assert_allclose(level[:3], [0, -20, -40], atol=0.1)
    assert np.all(height[:3] > 25) and level[3] < -80 and height[3] < 15
