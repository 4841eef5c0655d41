"""Excitations: their size, and that they stay within their band."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.excitation import KINDS, force


@pytest.mark.parametrize("kind", KINDS)
def test_size_and_band(kind):
    found = force(kind, np.random.default_rng(1), 1000, 0.01, (1.0, 5.0))
    assert np.mean(found**2) == pytest.approx(1.0)
    power, frequency = np.abs(np.fft.rfft(found)) ** 2, np.fft.rfftfreq(1000, 0.01)
    assert power[(frequency > 0.5) & (frequency < 5.5)].sum() > 0.98 * power.sum()
