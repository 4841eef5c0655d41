"""Dominant frequency and growth rate of a measured or computed oscillation."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pipeline.contract.errors import ConfigError

#: longest Hann frame whose amplitude is one point of the envelope, in periods; frames overlap by half
FRAME_PERIODS = 6
#: shortest signal with a growth rate, in periods: three frames of half its length
FEWEST_PERIODS = 6


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
    """Growth rate in 1/s of the oscillation at ``frequency`` in ``signal`` (m,): negative when damped.

    The envelope (amplitude in Hann frames at the frequency) is fitted by an exponential: least squares of its
    logarithm, weighted with the squared envelope, so that the floor under a decayed oscillation does not count.
    """
    if len(signal) * step * frequency < FEWEST_PERIODS:
        raise ConfigError("oscillation", f"at least {FEWEST_PERIODS} periods at {frequency:.4g} Hz",
                          f"{len(signal) * step:.3g} s", "simulate longer")
    size = min(round(FRAME_PERIODS / (frequency * step)), len(signal) // 2)
    carrier = np.hanning(size) * np.exp(-2j * np.pi * frequency * step * np.arange(size))
    frames = sliding_window_view(signal - np.mean(signal), size)[::size // 2]
    envelope = np.abs(frames @ carrier)
    if not envelope.max() > 0:
        return 0.0
    logarithm = np.log(np.maximum(envelope, np.finfo(float).tiny))
    return np.polyfit(size // 2 * step * np.arange(envelope.size), logarithm, 1, w=envelope)[0]
