"""Amplitude of a squeal over time, from the noise floor to saturation, in Hann frames at its frequency.

A frame is told at its last sample, so that it holds nothing that comes later: what grows as exp(p t) is traced as
a exp(p t), whatever the length of the frames.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.oscillation import dominant_frequency

#: frames start this fraction of their length apart
HOP = 1 / 3
#: shortest frame in periods, so that its image at the negative frequency stays out
PERIODS = 6
#: first and longest frame in s, and length of a frame over the time in which the amplitude grows by e
FIRST, LONGEST, _PER_GROWTH = 6e-3, 20e-3, 1.5
#: level over the largest at which a squeal is loud: before it lies the growth, behind it saturation
_LOUD, _FULL = 0.3, 0.7
#: stretch before the loud part whose spectrum tells the frequency, s
_STRETCH = 0.04
#: frames of which a mean counts as a floor; shortest record in lengths of a frame
_BLOCK, _SHORTEST = 9, 6


@dataclass(frozen=True)
class Trace:
    """Complex amplitudes ``amplitude`` (c, k) at ``frequency`` Hz of frames of ``size`` samples that end at ``time``
    (k,) s, up to one factor; ``floor`` (c,) their effective values in quiet, ``level`` (k,) all channels over them."""

    time: np.ndarray
    amplitude: np.ndarray
    frequency: float
    size: int
    floor: np.ndarray

    @property
    def level(self):
        return np.sqrt(np.mean(abs(self.amplitude) ** 2 / self.floor[:, None] ** 2, axis=0))

    @property
    def largest(self):
        """Level of the saturated part; where none is reached, the largest."""
        level = self.level
        return float(np.median(level[np.argmax(level >= _FULL * level.max()):]))


def traced(samples, rate, low, high, length=FIRST):
    """Trace of samples (c, n) at ``rate`` Hz: the tone between ``low`` and ``high`` Hz that grows loudest, in frames of
    about ``length`` s. ConfigError for a band beyond the sampling, records too short, and channels without signal."""
    if not 0 < low < high < 0.5 * rate:
        raise ConfigError("onset: band", f"0 < low < high < {0.5 * rate:g} Hz", f"{low:g} to {high:g} Hz")
    samples = samples - samples.mean(axis=1, keepdims=True)
    frequency = _frequency(samples, rate, low, high)
    size = int(np.ceil(rate * max(length, PERIODS / frequency)))
    if samples.shape[1] < _SHORTEST * size:
        raise ConfigError("onset", f"a record of at least {_SHORTEST * size / rate:.3g} s",
                          f"{samples.shape[1] / rate:.3g} s", "record from before the squeal begins")
    time, amplitude = demodulated(samples, rate, frequency, size)
    return Trace(time, amplitude, frequency, size, np.maximum(_floor(amplitude), _steps(samples, size)))


def hop(size):
    """Samples from frame to frame of ``size`` samples."""
    return max(round(HOP * size), 1)


def frame_length(growth):
    """Length in s of frames that follow a growth rate in 1/s."""
    return float(np.clip(_PER_GROWTH / max(growth, 1e-9), 0.0, LONGEST))


def frame(size):
    """Hann window (size,)."""
    return np.hanning(size + 2)[1:-1]


def demodulated(samples, rate, frequency, size):
    """(time (k,) of their last samples in s, complex amplitudes (c, k) at ``frequency`` Hz) of Hann frames."""
    window = frame(size)
    last = np.arange(size - 1, samples.shape[1], hop(size))
    turning = samples * np.exp(-2j * np.pi * frequency * np.arange(samples.shape[1]) / rate)
    amplitude = np.array([turning[:, k - size + 1:k + 1] @ window for k in last]).T * 2 / window.sum()
    return last / rate, amplitude


def _frequency(samples, rate, low, high):
    """Frequency in Hz of the strongest line of the growth: harmonics, which grow faster, are faint there."""
    spectrum, line = np.fft.rfft(samples), np.fft.rfftfreq(samples.shape[1], 1 / rate)
    spectrum[:, (line < low) | (line > high)] = 0.0
    band = np.fft.irfft(spectrum, samples.shape[1])
    largest = abs(band).max(axis=1)
    if not largest.any():
        raise ConfigError("onset", f"a motion between {low:g} and {high:g} Hz", "none")
    band = band[largest > 0] / largest[largest > 0, None]
    part = max(int(FIRST * rate), 1)
    blocks = band[:, :band.shape[1] // part * part].reshape(len(band), -1, part)
    level = np.sqrt(np.mean(blocks**2, axis=(0, 2)))
    loud = part * int(np.argmax(level >= _LOUD * level.max()) + 1)
    begin = max(min(loud - round(_STRETCH * rate), band.shape[1] - round(_STRETCH * rate)), 0)
    stretch = band[:, begin:begin + round(_STRETCH * rate)]
    _, right = np.linalg.eigh(stretch @ stretch.T)          # the channels as they move together
    return dominant_frequency(right[:, -1] @ stretch, 1 / rate, low)


def _steps(samples, size):
    """Effective values (c,) of what the converter rounds away, in frames of ``size`` samples: a signal below its step
    looks more quiet than it is."""
    change = abs(np.diff(samples))
    step = np.min(change, axis=1, where=change > 1e-9 * change.max(axis=1, keepdims=True), initial=np.inf)
    return np.where(np.isfinite(step), step, 0.0) * np.sqrt(6 / 12 / size)


def _floor(amplitude):
    """Effective values (c,) of the quietest stretch before amplitudes (c, k) get loud, of all frames as quiet."""
    power = abs(amplitude) ** 2
    scale = np.maximum(np.median(power, axis=1), 1e-300)
    together = np.mean(power / scale[:, None], axis=0)
    loud = int(np.argmax(together >= _LOUD**2 * together.max()))
    before = power[:, :max(loud, _BLOCK)]
    sums = np.cumsum(np.pad(before, ((0, 0), (1, 0))), axis=1)
    means = (sums[:, _BLOCK:] - sums[:, :-_BLOCK]) / _BLOCK
    at = int(np.argmin(np.mean(means / scale[:, None], axis=0)))
    quiet = before[:, np.mean(before / np.maximum(means[:, at], 1e-300)[:, None], axis=0) < 4.0]
    return np.sqrt(np.maximum(quiet.mean(axis=1) if quiet.shape[1] >= _BLOCK else means[:, at], 1e-300))
