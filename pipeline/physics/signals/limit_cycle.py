"""What a self-excited motion ends in: growth while it is small, amplitude, whether it has settled, harmonics."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.oscillation import FEWEST_PERIODS, dominant_frequency, growth_rate

#: parts into which the window is cut to see whether it has settled, and periods that each must hold
PARTS, PERIODS_PER_PART = 4, 5
#: growth is fitted where the envelope lies between these shares of the final amplitude
_LOW, _HIGH = 1e-3, 0.3
#: spread of a signal, as a share of its size, that is rounding
_ROUNDING = 1e-12
#: halved until the smallest share that leaves room for a fit
_DYNAMIC = 3.0


@dataclass(frozen=True)
class Cycle:
    """Of one signal: ``frequency`` Hz; ``amplitude`` sqrt(2) times its effective value in the window; ``drift`` the
    spread of the amplitudes of the parts of the window over their mean; ``settled``; ``growth`` 1/s of the small
    motion before and its standard error, 0 and 0 where none was seen (``grew``)."""

    frequency: float
    amplitude: float
    drift: float
    settled: bool
    growth: float
    growth_std: float
    grew: bool


def cycle(signal, step, window, tolerance, lowest=0.0):
    """Cycle of ``signal`` (m,), sampled every ``step`` s, of which the last ``window`` s are judged.

    It has settled when the amplitudes of four parts of the window differ by at most ``tolerance`` of their mean. Raises
    ConfigError where the window is longer than the signal or too short to tell.
    """
    size = round(window / step)
    if not 4 * PARTS <= size <= len(signal):
        raise ConfigError("limit cycle: window", f"{4 * PARTS} to {len(signal)} samples of {step:.3g} s",
                          f"{window:.3g} s")
    late = signal[-size:] - np.mean(signal[-size:])
    if np.ptp(late) <= _ROUNDING * abs(signal[-size:]).max():
        return Cycle(0.0, 0.0, 0.0, True, 0.0, 0.0, False)
    frequency = dominant_frequency(late, step, lowest)
    parts = np.array([_effective_amplitude(part) for part in np.array_split(late, PARTS)])
    drift = float(np.ptp(parts) / parts.mean())
    long_enough = window * frequency >= PARTS * PERIODS_PER_PART
    growth = _growth(signal - np.mean(late), step, frequency, parts.mean())
    return Cycle(frequency, float(parts.mean()), drift, bool(long_enough and drift <= tolerance),
                 *(growth or (0.0, 0.0)), growth is not None)


def _effective_amplitude(part):
    """sqrt(2) times the effective value under a Hann window, which part periods at the ends do not disturb."""
    weight = np.hanning(len(part))
    middle = weight @ part / weight.sum()
    return np.sqrt(2 * (weight @ (part - middle) ** 2) / weight.sum())


def _growth(signal, step, frequency, amplitude):
    """(rate, standard error) of the rise of the envelope to its final amplitude, or None where it did not rise."""
    period = max(round(1 / (frequency * step)), 1)
    count = len(signal) // period
    peaks = abs(signal[:count * period]).reshape(count, period).max(axis=1)
    reached = np.flatnonzero(peaks >= _HIGH * amplitude)
    if not reached.size:
        return None
    last = reached[0]
    first = max(np.flatnonzero(peaks[:last + 1] <= _LOW * amplitude).max(initial=0), 0)
    if last - first < FEWEST_PERIODS or peaks[last] < _DYNAMIC * peaks[first]:
        return None
    return growth_rate(signal[first * period:(last + 1) * period], step, frequency)


def harmonic_levels(signal, rate, base, count):
    """Amplitudes (count,) of ``signal`` (m,) at base, 2 base, ... Hz under a Hann window; 0 above half the rate."""
    window, time = np.hanning(len(signal)), np.arange(len(signal)) / rate
    middle = window @ signal / window.sum()
    order = np.arange(1, count + 1)
    levels = [2 * abs((window * (signal - middle)) @ np.exp(-2j * np.pi * k * base * time)) / window.sum()
              if k * base < rate / 2 else 0.0 for k in order]
    return np.array(levels)
