"""Whether a record squeals, and the features of its saturated part, stretch by stretch.

A squeal in saturation is never compared by waveform: two motions that start 1e-9 apart differ by a third after a tenth
of a second. What its stretches have in common is compared: frequency, levels, harmonics, means.
"""

import numpy as np

from pipeline.physics.signals.limit_cycle import harmonic_levels
from pipeline.physics.signals.oscillation import dominant_frequency

QUIET, GROWING, SATURATED = "quiet", "growing", "saturated"
#: how much louder than its faintest stretch a record ends that grows, and one that has outgrown what started it
_LOUDER, _OUTGROWN = 1.5, 3.0
#: share of the fastest growth below which growth has ended, and stretches at the end over which it is taken
_ENDED, _LAST = 0.25, 3
#: share of its level at the end from which on a motion is saturated
_FULL = 0.7
_HARMONICS = (2, 3)
#: parts of the first stretch, the first of which tells what started the motion
_PARTS = 8


def state(samples, size):
    """QUIET, GROWING or SATURATED, of motions (c, n) cut into stretches of ``size`` samples."""
    level = levels(samples, size)
    if len(level) <= _LAST:
        return QUIET
    rate = np.diff(np.log(np.maximum(level, 1e-300)))
    first = levels(samples[:, :size], max(size // _PARTS, 1))       # what grows fast is loud before a stretch is over
    faintest = min(level.min(), level[0] * first[0] / np.sqrt(np.mean(first**2)))
    if level[-1] < _LOUDER * faintest:
        return QUIET
    fastest = max(rate.max(), np.log(level[0] / max(faintest, 1e-300)))
    ended = level[-1] >= _OUTGROWN * faintest and rate[-_LAST:].mean() < _ENDED * fastest
    return SATURATED if ended else GROWING


def levels(samples, size):
    """Level (k,) of stretches of ``size`` samples: root mean square over channels (c, n), each over its largest."""
    parts = _stretches(samples, size)
    effective = np.sqrt(np.mean((parts - parts.mean(axis=2, keepdims=True)) ** 2, axis=2))
    return np.sqrt(np.mean((effective / np.maximum(effective.max(axis=1, keepdims=True), 1e-300)) ** 2, axis=0))


def saturated(samples, size):
    """Indices (k,) of the stretches at the end that are saturated: about as loud as the last."""
    level = levels(samples, size)
    faint = np.flatnonzero(level < _FULL * level[-1])
    return np.arange(faint.max(initial=-1) + 1, len(level))


def motion_features(samples, rate, size, kept, lowest):
    """{feature: (k,)} of one motion (n,) over the stretches ``kept`` (k,): ``frequency`` Hz above ``lowest``, ``level``
    (effective value), harmonics in dB over the fundamental."""
    parts = _stretches(np.asarray(samples)[None], size)[0][kept]
    base = np.array([dominant_frequency(part, 1 / rate, lowest) for part in parts])
    tones = np.array([harmonic_levels(part, rate, f, max(_HARMONICS)) for part, f in zip(parts, base, strict=True)])
    decibel = 20 * np.log10(np.maximum(tones, 1e-300) / np.maximum(tones[:, :1], 1e-300))
    return {"frequency": base, "level": parts.std(axis=1),
            **{f"level of {n} f over f": decibel[:, n - 1] for n in _HARMONICS if (n * base < rate / 2).all()}}


def means(samples, size, kept):
    """Means (k,) of samples (n,) over the stretches ``kept`` (k,)."""
    return _stretches(np.asarray(samples, float)[None], size)[0][kept].mean(axis=1)


def agree(first, second, tolerance):
    """Whether two sets of values have means that lie within ``tolerance`` standard deviations of both together."""
    spread = np.hypot(np.std(first), np.std(second))
    return bool(abs(np.mean(first) - np.mean(second)) <= tolerance * spread)


def _stretches(samples, size):
    """(c, k, size) of samples (c, n); what is left over at the begin is dropped."""
    samples = np.asarray(samples, float)
    count = samples.shape[1] // size
    return samples[:, samples.shape[1] - count * size:].reshape(len(samples), count, size)
