"""Dominant frequency and growth rate of a measured or computed oscillation."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pipeline.contract.errors import ConfigError

#: longest Hann frame whose amplitude is one point of the envelope, in periods, and frames per its length
FRAME_PERIODS, FRAME_OVERLAP = 6, 8
#: shortest signal with a growth rate, in periods
FEWEST_PERIODS = 6
#: windows of the envelope whose growth rates are compared
WINDOWS = 3
#: share of the largest amplitude below which an envelope is the floor before or after the oscillation
FLOOR = 0.01
#: a growth rate has a sign when it exceeds so many standard errors
DECIDED = 2.0


def dominant_frequency(signal, step, lowest=0.0):
    """Frequency in Hz of the largest peak above ``lowest`` of the Hann spectrum of ``signal`` (m,).

    The peak is refined by a parabola through the logarithms of three lines; ``step`` in s.
    """
    spectrum = np.abs(np.fft.rfft((signal - np.mean(signal)) * np.hanning(len(signal))))
    frequency = np.fft.rfftfreq(len(signal), step)
    inner = np.arange(1, len(spectrum) - 1)
    searched = inner[frequency[inner] >= lowest]
    if not searched.size:
        raise ConfigError("oscillation", f"a signal with lines above {lowest:g} Hz",
                          f"{len(signal)} samples of {step:g} s", "simulate longer or lower the limit")
    peak = searched[np.argmax(spectrum[searched])]
    left, middle, right = np.log(np.maximum(spectrum[peak - 1:peak + 2], np.finfo(float).tiny))
    curvature = left - 2 * middle + right
    shift = 0.5 * (left - right) / curvature if curvature < 0 else 0.0
    return max((peak + np.clip(shift, -0.5, 0.5)) * frequency[1], lowest)


def growth_rate(signal, step, frequency):
    """(growth rate, its standard error) in 1/s of the oscillation at ``frequency`` in ``signal`` (m,); damped: < 0.

    The envelope (amplitude in Hann frames at the frequency, without the floor before and after the oscillation) is cut
    into thirds, and each is fitted by an exponential: least squares of its logarithm, weighted with the squared
    envelope. The rate is the mean of the three; thirds that disagree, as where the oscillation saturates or beats,
    show in the standard error.
    """
    if len(signal) * step * frequency < FEWEST_PERIODS:
        raise ConfigError("oscillation", f"at least {FEWEST_PERIODS} periods at {frequency:.4g} Hz",
                          f"{len(signal) * step:.3g} s", "simulate longer")
    time, envelope = _envelope(signal - np.mean(signal), step, frequency)
    if not envelope.max() > 0:
        return 0.0, 0.0
    logarithm = np.log(np.maximum(envelope, np.finfo(float).tiny))
    rates = [np.polyfit(time[w], logarithm[w], 1, w=envelope[w])[0] for w in np.array_split(_heard(envelope), WINDOWS)]
    return np.mean(rates), np.std(rates, ddof=1) / np.sqrt(WINDOWS)


def sign_is_decided(rate, deviation):
    """Whether growth rates differ from zero by at least two of their standard errors."""
    return np.abs(rate) >= DECIDED * deviation


def _heard(envelope):
    """Frames around the largest without a break above the floor; all frames where these are too few for lines."""
    low, largest = np.flatnonzero(envelope < FLOOR * envelope.max()), np.argmax(envelope)
    begin, end = low[low < largest].max(initial=-1) + 1, low[low > largest].min(initial=envelope.size)
    heard = np.arange(begin, end)
    return heard if heard.size >= 2 * WINDOWS else np.arange(envelope.size)


def _envelope(signal, step, frequency):
    """(begin of the frames in s, amplitude in them up to a factor)."""
    size = min(round(FRAME_PERIODS / (frequency * step)), len(signal) // 2)
    hop = max(size // FRAME_OVERLAP, 1)
    carrier = np.hanning(size) * np.exp(-2j * np.pi * frequency * step * np.arange(size))
    envelope = np.abs(sliding_window_view(signal, size)[::hop] @ carrier)
    return hop * step * np.arange(envelope.size), envelope
