"""Intermittent vibration: how long it lasts, how long it pauses, and which lines it has."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.spectra import power_spectrum

#: half-width of a line, and of the band about it that tells its floor, as shares of the fundamental
_LINE, _FLOOR = 0.03, 0.25


@dataclass(frozen=True)
class Bursts:
    """``share`` of the time that vibrates; mean length of a burst and of a pause between bursts, s (0 where none)."""

    share: float
    burst: float
    pause: float


def bursts(signal, interval, frame, threshold):
    """Bursts of ``signal`` (m,), sampled every ``interval`` s, judged in frames of ``frame`` s.

    A frame vibrates where its effective value (mean removed) exceeds ``threshold`` times the largest one. Bursts and
    pauses that the ends cut off count as long as they are seen. Raises ConfigError for fewer than four frames.
    """
    size = max(1, round(frame / interval))
    count = len(signal) // size
    if count < 4:
        raise ConfigError("bursts: frame", f"at most a quarter of the signal, {len(signal) * interval / 4:.3g} s",
                          f"{frame:.3g} s")
    effective = signal[:count * size].reshape(count, size).std(axis=1)
    if not effective.any():
        return Bursts(0.0, 0.0, count * size * interval)
    vibrates = effective > threshold * effective.max()
    edges = np.flatnonzero(np.diff(vibrates)) + 1
    lengths = np.diff(np.r_[0, edges, count]) * size * interval
    begins = vibrates[np.r_[0, edges]]
    return Bursts(float(vibrates.mean()), *(float(lengths[begins == kind].mean()) if np.any(begins == kind) else 0.0
                                            for kind in (True, False)))


def harmonic_lines(signal, interval, resolution, lowest, orders):
    """(fundamental Hz, level, height) of the strongest line above ``lowest`` Hz and of its multiples 1..``orders``.

    ``level`` (orders,) dB re the fundamental; ``height`` (orders,) dB above the median of the spectrum beside the line.
    Welch spectrum with lines ``resolution`` Hz apart; orders beyond the spectrum get -inf and 0.
    """
    frequency, density = power_spectrum(np.asarray(signal, float), 1 / interval, resolution)
    density = density + np.finfo(float).tiny
    above = frequency >= lowest
    fundamental = frequency[above][np.argmax(density[above])]
    level, height = np.full(orders, -np.inf), np.zeros(orders)
    for order in range(1, orders + 1):
        apart = abs(frequency - order * fundamental)
        near, beside = apart <= _LINE * fundamental, apart <= _FLOOR * fundamental
        if order * fundamental <= frequency[-1]:
            level[order - 1] = 10 * np.log10(density[near].max() / density[above].max())
            height[order - 1] = 10 * np.log10(density[near].max() / np.median(density[beside]))
    return float(fundamental), level, height
