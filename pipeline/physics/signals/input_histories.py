"""Histories of inputs and drives: shapes over time with peak 1, and recorded samples brought to equal intervals."""

import numpy as np

from pipeline.contract.errors import ConfigError


def harmonic(time, frequency, phase=0.0):
    """sin(2 pi frequency t + phase); ``frequency`` Hz, ``phase`` rad."""
    return np.sin(2 * np.pi * frequency * time + phase)


def chirp(time, first, last, duration):
    """Sine whose frequency (Hz) runs linearly from ``first`` to ``last`` over ``duration`` s, then stays."""
    swept = np.minimum(time, duration)
    turns = first * swept + (last - first) * swept**2 / (2 * duration) + last * (time - swept)
    return np.sin(2 * np.pi * turns)


def step(time, begin, rise=0.0):
    """0 before ``begin`` s, 1 after ``rise`` s more, linear between."""
    return np.clip((time - begin) / rise, 0.0, 1.0) if rise > 0 else (time >= begin).astype(float)


def resampled(time, instants, values, where):
    """``values`` at ``instants`` (s, rising), read linearly at ``time``; ConfigError at ``where`` for samples that end
    before ``time`` does, do not rise, or are not finite."""
    if len(instants) < 2 or np.any(np.diff(instants) <= 0) or not np.isfinite(values).all():
        raise ConfigError(where, "two or more finite samples at rising times", f"{len(instants)} samples",
                          "mend the file")
    if instants[0] > time[0] or instants[-1] < time[-1] * (1 - 1e-9):
        raise ConfigError(where, f"samples from {time[0]:g} to {time[-1]:g} s",
                          f"{instants[0]:g} to {instants[-1]:g} s", "shorten histories.duration, or shift the samples")
    return np.interp(time, instants, values)
