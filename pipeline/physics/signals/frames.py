"""Overlapping Hann frames of a signal, transformed block by block: a record of any length takes the memory of one."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.spectra import a_weighting

#: samples of the frames that are transformed at once, and what their number is a multiple of
_AT_ONCE, _LANES = 1 << 19, 8


@dataclass(frozen=True)
class Frames:
    """Frames of one signal.

    time : (frame,) middle of each frame [s]
    hop : time from frame to frame [s]
    duration : of the signal [s]
    frequency : (line,) [Hz]
    transform : first frame, frame after the last -> (frame, line) root mean square of a tone on that line [unit of the
        signal]
    at_once : frames of a block
    """

    time: np.ndarray
    hop: float
    duration: float
    frequency: np.ndarray
    transform: Callable
    at_once: int

    def scan(self, *watchers):
        """Show all frames to each of the ``watchers``, in order: ``see(first frame of a block, its spectra)``."""
        for first in range(0, len(self.time), self.at_once):
            spectra = self.transform(first, min(first + self.at_once, len(self.time)))
            for watcher in watchers:
                watcher.see(first, spectra)

    def inside(self, band):
        """(line,) which lines lie in a band (lowest, highest) [Hz]."""
        return (self.frequency >= band[0]) & (self.frequency <= band[1])


def frames(signal, rate, detector, kept=float):
    """Frames of a signal (sample,), or what gives slices of it, taken at ``rate`` [Hz] for a Detector.

    ``kept``: type of the spectra, float32 for long signals. Raises ConfigError for a signal shorter than a frame or a
    band beyond half the rate.
    """
    size = round(detector.window * rate)
    if len(signal) < size:
        raise ConfigError("squeal detector", f"a signal of at least {detector.window:g} s", f"{len(signal) / rate:g} s",
                          "shorten the window or lengthen the signal")
    if detector.band[1] > rate / 2:
        raise ConfigError("squeal detector", f"a band below half the sampling rate, {rate / 2:g} Hz",
                          f"{detector.band[1]:g} Hz", "lower the band or sample faster")
    hop = max(1, round(size * (1 - detector.overlap)))
    hann = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(size) / size)
    frequency = np.fft.rfftfreq(size, 1 / rate)
    scale = np.sqrt(2) / hann.sum() * (a_weighting(frequency) if detector.weighted else 1.0)
    middle = (np.arange((len(signal) - size) // hop + 1) * hop + size / 2) / rate
    return Frames(middle, hop / rate, len(signal) / rate, frequency, partial(_spectra, signal, hop, hann, scale, kept),
                  max(_AT_ONCE // size // _LANES, 1) * _LANES)


def _spectra(signal, hop, window, scale, kept, first, last):
    samples = np.asarray(signal[first * hop:(last - 1) * hop + len(window)], float)
    pieces = sliding_window_view(samples, len(window))[::hop]
    return (np.abs(scipy.fft.rfft(pieces * window)) * scale).astype(kept)
