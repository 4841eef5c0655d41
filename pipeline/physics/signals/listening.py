"""Vibration and sound to listen to: 16-bit samples at a rate that every loudspeaker plays."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import scipy

#: sampling rate [Hz], longest sound [s], and how long it fades in and out [s]
RATE, LONGEST, _FADE = 48000.0, 3.0, 0.01
#: share of full scale that the largest sample takes; largest sample
_PEAK, _INTEGER = 0.9, 32767
#: tones from this share of the rate on are left out
_HIGHEST = 0.45


@dataclass(frozen=True)
class Sound:
    """samples : (sample,) 16-bit integers at RATE; full_scale : what 32767 stands for [unit of the signal]."""

    samples: np.ndarray
    full_scale: float


def excerpt(signal, rate):
    """Sound of the first LONGEST s of a ``signal`` (n,) at ``rate`` in Hz, without its mean."""
    part = np.asarray(signal, float)[:int(LONGEST * rate)]
    ratio = Fraction(RATE / rate).limit_denominator(2000)
    return _of(scipy.signal.resample_poly(part - part.mean(), ratio.numerator, ratio.denominator))


def audible(frequency):
    """(tone,) whether tones of ``frequency`` (tone,) in Hz are low enough for the rate."""
    return np.asarray(frequency) < _HIGHEST * RATE


def held(frequency, root_mean_square, duration=2.0):
    """Sound of steady tones (tone,): ``frequency`` in Hz and ``root_mean_square`` in any unit, for ``duration`` s.

    Raises ValueError where none is low enough for the rate.
    """
    time, kept = np.arange(round(duration * RATE)) / RATE, audible(frequency)
    tones = [np.sqrt(2.0) * strength * np.sin(2.0 * np.pi * f * time)
             for f, strength in zip(np.asarray(frequency)[kept], np.asarray(root_mean_square)[kept], strict=True)]
    if not tones:
        raise ValueError(f"expected a tone below {_HIGHEST * RATE:g} Hz, found none")
    return _of(np.sum(tones, axis=0))


def _of(signal):
    """Sound of a signal (n,) at RATE, faded at its ends."""
    count = min(round(_FADE * RATE), len(signal) // 2)
    fade = 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / max(count, 1))
    faded = signal * np.concatenate([fade, np.ones(len(signal) - 2 * count), fade[::-1]])
    full_scale = float(np.abs(faded).max()) / _PEAK or 1.0
    return Sound(np.rint(_INTEGER * faded / full_scale).astype(np.int16), full_scale)
