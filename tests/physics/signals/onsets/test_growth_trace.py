"""The trace of a squeal: amplitudes in frames, the floor before it, the tone that grows."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.physics.signals.onsets.growth_trace import demodulated, frame_length, traced
from tests.physics.signals.onsets.test_growth_rate import RATE, ROOT, squeal


def test_frames_follow_an_exponential_exactly():
    root = 90 + 2j * np.pi * 1500
    time = np.arange(4000) / RATE
    at, amplitude = demodulated(np.exp(root * time)[None], RATE, 1490.0, 300)
    ratio = amplitude[0, 1:] / amplitude[0, :-1]
    assert ratio == pytest.approx(np.exp((root - 2j * np.pi * 1490) * np.diff(at)))


def test_a_frame_is_told_at_its_last_sample():
    at, amplitude = demodulated(np.r_[np.zeros(1000), np.ones(1000)][None], RATE, 2000.0, 90)
    assert not amplitude[0, at < 1000 / RATE].any() and amplitude[0, at >= 1000 / RATE].all()


def test_the_tone_that_grows_is_traced_not_its_harmonic():
    """In saturation the second harmonic is the louder one; it grows twice as fast from nothing."""
    samples = squeal(noise=1e-4)
    harmonic = 3 * np.apply_along_axis(lambda row: row**2, 1, samples)
    trace = traced(samples + harmonic, RATE, 300, 6000)
    assert trace.frequency == pytest.approx(ROOT.imag / (2 * np.pi), rel=0.01)


def test_level_over_the_floor_and_saturation():
    trace = traced(squeal(noise=1e-3), RATE, 300, 5000)
    quiet = trace.level[trace.time < 0.09]
    assert np.sqrt(np.mean(quiet**2)) == pytest.approx(1, rel=0.25)
    white = 1e-3 * np.sqrt(2 * 1.5 / (trace.size / 2) / 2 * 2)        # of a Hann frame: noise bandwidth 1.5 lines
    assert trace.floor == pytest.approx(np.full(3, white), rel=0.25)
    assert trace.largest == pytest.approx(np.sqrt(np.mean(abs(np.array([1, 0.4, 0.7]) / trace.floor) ** 2)), rel=0.05)


def test_frames_follow_the_growth():
    assert frame_length(1.0) == 20e-3 and frame_length(300.0) == pytest.approx(5e-3) and frame_length(-5.0) == 20e-3


def test_bands_records_and_channels_that_show_nothing_are_refused():
    with pytest.raises(ConfigError, match="band"):
        traced(squeal(), RATE, 300, 20000)
    with pytest.raises(ConfigError, match="record of at least"):
        traced(squeal()[:, :800], RATE, 300, 5000)
    with pytest.raises(ConfigError, match="a motion between"):
        traced(np.zeros((2, 8000)), RATE, 300, 5000)


def test_what_the_converter_rounds_away_counts_as_noise():
    """Noise below the step of the converter reads as zeros: the floor is that of rounding."""
    step = 1e-3
    trace = traced(step * np.round(squeal(noise=1e-6) / step), RATE, 300, 5000)
    assert trace.floor == pytest.approx(np.full(3, step / np.sqrt(12) * np.sqrt(6 / trace.size)), rel=0.05)
