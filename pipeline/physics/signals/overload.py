"""Overload: samples of a vibrating signal that stand at the end of the range of its instrument.

The largest values of a signal that swings freely are few, and hardly two alike. An amplifier or a converter that is
overloaded holds its last value, whatever its scale: whole tops are flat, and far more samples stand there than next to
it. Levels of what is loud are then lower bounds, and harmonics that no brake made are added to its tones.
"""

from dataclasses import dataclass

import numpy as np

#: samples on end that make a flat top; samples at the end over those next to it; width of what is next to it, over the
#: size of the signal, and over its steps
_FLAT, _MORE, _NEXT, _STEPS = 3, 4.0, 1e-3, 1.5
#: tops that are too short to be flat count from so many on, where so many values differ beside them: else it is a tone
#: that repeats itself from sample to sample
_SHORT, _UNLIKE = 20, 8
#: what lies nearer to the middle of all samples than this share of the range is rest
_REST = 0.2
#: bits of integers whose two ends tell them apart, and how well
_BITS, _ALIKE = (8, 12, 16), 1e-6
#: samples that are looked at for the middle and for the steps
_SOME = 1 << 16


@dataclass(frozen=True)
class Overload:
    """``limit``: largest absolute value, in the unit of the signal; ``low``, ``high``: whether its negative and its
    positive end are reached; ``share`` of the samples there; ``blocks`` (k,): how many in each block of ``size``."""

    limit: float
    low: bool
    high: bool
    share: float
    blocks: np.ndarray
    size: int

    def during(self, begin, end, rate):
        """Whether samples stand there between ``begin`` and ``end`` in s after the first, at ``rate`` in Hz."""
        first, last = (int(time * rate) // self.size for time in (begin, end))
        return bool(self.blocks[max(first, 0):last + 1].any())


def overload(parts, size=1024):
    """Overload of a signal, None of one that nothing cuts off.

    ``parts``: function that yields its samples (n,) in order, part by part; it is called twice. ``size``: samples of a
    block.
    """
    lowest, highest, some = np.inf, -np.inf, []
    for part in parts():
        lowest, highest = min(lowest, float(part.min())), max(highest, float(part.max()))
        some.append(np.array(part[::max(len(part) // _SOME, 1)], float))
    some = np.concatenate(some)
    middle, step = float(np.median(some)), _step(some)
    if highest == lowest:
        return None
    ends = [_End(end, max(_NEXT * abs(end - middle), _STEPS * step)) for end in (lowest, highest)]
    counts = []
    for part in parts():
        counts.append(np.add.reduceat(sum(end.see(part) for end in ends), np.arange(0, len(part), size)))
    whole = _whole_range(lowest, highest) and all(end.at > 1 for end in ends)
    low, high = (bool((whole or end.held()) and abs(end.value - middle) > _REST * (highest - lowest)) for end in ends)
    if not (low or high):
        return None
    at = sum(end.at for end, reached in zip(ends, (low, high), strict=True) if reached)
    return Overload(max(abs(end.value) for end, reached in zip(ends, (low, high), strict=True) if reached), low, high,
                    float(at / ends[0].seen), np.concatenate(counts), size)


def _step(samples):
    """Smallest distance of two unlike samples."""
    levels = np.unique(samples)
    return float(np.diff(levels).min()) if len(levels) > 1 else 0.0


def _whole_range(lowest, highest):
    """Whether the ends of a signal are those of integers, whatever their scale: one more step below 0 than above."""
    return lowest < 0.0 < highest and any(
        abs(highest / -lowest * 2.0 ** (bits - 1) / (2.0 ** (bits - 1) - 1) - 1.0) < _ALIKE for bits in _BITS)


class _End:
    """Counts the samples at one end of a signal, next to it, on end, and what is beside them."""

    def __init__(self, value, width):
        self.value, self._width = value, width
        self.at = self.seen = self._next = self._flat = 0
        self._beside = set()

    def see(self, part):
        """(n,) whether the samples of a part stand at the end."""
        at = part == self.value
        self.seen += len(part)
        self.at += np.count_nonzero(at)
        self._next += np.count_nonzero((abs(part - self.value) <= self._width) & ~at)
        self._flat += np.count_nonzero(np.convolve(at, np.ones(_FLAT, int), "valid") == _FLAT) if at.any() else 0
        if len(self._beside) <= _UNLIKE:
            self._beside |= set(np.round(part[1:][at[:-1] & ~at[1:]][:_SOME] / self._width).tolist())
        return at.astype(int)

    def held(self):
        """Whether the signal was held there."""
        short = self.at >= _SHORT and len(self._beside) > _UNLIKE
        return (self._flat > 0 or short) and self.at >= _MORE * self._next
