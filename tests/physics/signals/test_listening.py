"""Sound to listen to keeps frequencies and levels."""

import numpy as np
import pytest

from pipeline.physics.signals.listening import RATE, excerpt, held


def heard(sound):
    """(frequency of the strongest line in Hz, effective value in the unit of the signal) of the middle of a Sound."""
    middle = sound.samples[len(sound.samples) // 4:-len(sound.samples) // 4] * sound.full_scale / 32767
    size = 2**20
    line = np.abs(np.fft.rfft(middle * np.hanning(len(middle)), size)).argmax()
    return line * RATE / size, middle.std()


@pytest.mark.exact
@pytest.mark.parametrize("rate", [25600.0, 44100.0, 51200.0, 1e5 / 3, 250000.0])
def test_an_excerpt_keeps_its_frequency_and_amplitude(rate):
    time = np.arange(int(1.5 * rate)) / rate
    sound = excerpt(5.0 + 0.02 * np.sin(2 * np.pi * 2781.3 * time), rate)
    frequency, effective = heard(sound)
    assert frequency == pytest.approx(2781.3, abs=0.1) and effective == pytest.approx(0.02 / np.sqrt(2), rel=0.01)
    assert len(sound.samples) == pytest.approx(1.5 * RATE, abs=2) and np.abs(sound.samples).max() == 29490
    assert sound.samples.dtype == np.int16 and abs(sound.samples[0]) < 20
    assert len(excerpt(np.ones(int(9 * rate)), rate).samples) == pytest.approx(3 * RATE, abs=2)


@pytest.mark.exact
def test_held_tones_have_the_strengths_that_are_given():
    frequency, effective = heard(held([1800.0, 3600.0, 30000.0], [2e-3, 1e-3, 9.0]))
    assert frequency == pytest.approx(1800.0, abs=0.1) and effective == pytest.approx(np.hypot(2e-3, 1e-3), rel=1e-3)
    with pytest.raises(ValueError, match="below 21600 Hz"):
        held([30000.0], [1.0])
