"""Under which conditions something sounds: their course over time, and bins of two of them with share and level."""

from dataclasses import dataclass

import numpy as np

#: steps of bins, times a power of ten
_STEPS = np.array([1.0, 2.0, 5.0, 10.0])


@dataclass(frozen=True)
class Conditions:
    """Conditions over time.

    measured : {name: [(samples (n,), NaN where missing, rate [Hz], begin [s])]}, the first that knows an instant counts
    stated : {name: (time (n,) [s], values (n,))}, where nothing was measured
    """

    measured: dict
    stated: dict

    def mean(self, name, start, duration):
        """Mean of a condition over a stretch of time in s; None where it is not known."""
        for samples, rate, begin in self.measured.get(name, ()):
            first, last = (int(np.floor((t - begin) * rate)) for t in (start, start + duration))
            inside = samples[max(first, 0):max(last, first + 1, 0)]
            if np.isfinite(inside).any():
                return float(np.nanmean(inside))
        return float(np.interp(start + duration / 2, *self.stated[name])) if name in self.stated else None

    def at(self, name, time):
        """(n,) values of a condition at the instants ``time`` (n,) in s; NaN where it is not known."""
        values = np.interp(time, *self.stated[name]) if name in self.stated else np.full(len(time), np.nan)
        for samples, rate, begin in reversed(self.measured.get(name, ())):
            index = np.rint((time - begin) * rate).astype(int)
            inside = (index >= 0) & (index < len(samples))
            known = np.where(inside, samples[np.clip(index, 0, len(samples) - 1)], np.nan)
            values = np.where(np.isfinite(known), known, values)
        return values


@dataclass(frozen=True)
class Occurrence:
    """By bins of two conditions, all (i, j): ``time`` and ``sounding`` in s, largest ``level`` in dB (0 of none)."""

    time: np.ndarray
    sounding: np.ndarray
    level: np.ndarray

    def __add__(self, other):
        return Occurrence(self.time + other.time, self.sounding + other.sounding, np.maximum(self.level, other.level))


def even_edges(values, most, origin=0.0):
    """Edges (n + 1,) of at most ``most`` bins that hold all ``values``: multiples of a round step from ``origin``."""
    low, high = float(np.min(values)) - origin, float(np.max(values)) - origin
    span = max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-12) / most
    power = 10.0 ** np.floor(np.log10(span))
    for step in np.concatenate([_STEPS, 10.0 * _STEPS[1:]]) * power:
        first, last = np.floor(low / step * (1.0 + 1e-12)), np.floor(high / step) + 1.0
        if last - first <= most:
            break
    return origin + step * np.arange(first, last + 1.0)


def occurrence(first, second, level, interval, edges):
    """Occurrence at instants ``interval`` s apart, with conditions ``first`` and ``second`` (n,), NaN where not known.

    ``level`` (n,) in dB: of what sounds at each instant, -inf where nothing does; ``edges``: of the bins of either.
    """
    i, j = (np.searchsorted(edge, values, side="right") - 1
            for edge, values in zip(edges, (first, second), strict=True))
    shape = tuple(len(edge) - 1 for edge in edges)
    inside = (i >= 0) & (i < shape[0]) & (j >= 0) & (j < shape[1]) & np.isfinite(first) & np.isfinite(second)
    at = np.ravel_multi_index((i[inside], j[inside]), shape)
    sounding = np.isfinite(level[inside])
    loudest = np.full(shape[0] * shape[1], -np.inf)
    np.maximum.at(loudest, at, level[inside])
    count, loud = (np.bincount(at[chosen], minlength=len(loudest)).reshape(shape) for chosen in (slice(None), sounding))
    return Occurrence(count * interval, loud * interval, np.where(np.isfinite(loudest), loudest, 0.0).reshape(shape))
