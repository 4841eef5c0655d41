"""Mode lock-in: what kind of spectrum two rubbing bodies settle into, after Allgaier et al. (1999), section 2.

- classical: one base frequency, that of one of the two bodies, and its harmonics;
- intermediate: one base frequency between those of both bodies;
- multiple: a base frequency, its harmonics, and side bands about them;
- dual base: two base frequencies that are no multiples of one another, and their harmonics;
- other: one base frequency that is neither that of a body nor between two;
- none: the motion dies, or has no tone.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError

NONE, CLASSICAL, INTERMEDIATE, MULTIPLE, DUAL, OTHER = range(6)
KINDS = ("none", "classical", "intermediate", "multiple", "dual base", "other")
#: a line stands out by this much (dB) above the median of its surroundings, a multiple of the base by that much
_PROMINENCE, _MULTIPLE_PROMINENCE = 20.0, 10.0
#: surroundings, in lines of the spectrum to either side
_SURROUNDINGS = 60
#: a line further than this share of the base frequency from it is no side band
_SIDE_BAND = 0.25
_FEWEST_PERIODS = 8


@dataclass(frozen=True)
class LockIn:
    """``kind`` (index into KINDS), ``base`` frequency in Hz, ``second`` base or side-band distance in Hz (0 = none).

    ``harmonics`` counts base and multiples without a gap, ``levels`` (n,) dB of all of them re the base.
    """

    kind: int
    base: float
    second: float
    harmonics: int
    levels: np.ndarray


def lock_in(signal, rate, first, second, *, near=0.03, rival=20.0, dynamic_range=40.0, highest=12e3,
            lowest=200.0, count=8):
    """LockIn of a ``signal`` (m,), sampled at ``rate`` Hz, of bodies with modes at ``first`` (f,), ``second`` (g,) Hz.

    Of both bodies the mode nearest the base counts. ``near``: relative distance up to which the base is that of a body;
    ``rival`` (dB): lines further below the strongest are neither side bands nor a second base; ``dynamic_range`` (dB)
    that of multiples; bases are sought from ``lowest`` to ``highest`` Hz. Raises ConfigError for a signal of fewer than
    8 periods of the lowest frequency.
    """
    if len(signal) / rate < _FEWEST_PERIODS / lowest:
        raise ConfigError("lock-in", f"a signal of at least {_FEWEST_PERIODS / lowest:.3g} s",
                          f"{len(signal) / rate:.3g} s", "lengthen the window")
    frequency, level = _spectrum(signal, rate)
    line, strength = _lines(frequency, level, lowest, min(highest, 0.45 * rate), rival)
    if not len(line):
        return LockIn(NONE, 0.0, 0.0, 0, np.full(count, -np.inf))
    base = _base(line, strength)
    levels = harmonic_levels(signal, rate, base, count, dynamic_range)
    harmonics = int(np.argmin(np.append(np.isfinite(levels), False)))
    width = max(3 * rate / len(signal), 0.25 * near * base)
    distance = line - np.maximum(np.round(line / base), 1) * base
    foreign = np.abs(distance) > width
    mirrored = _mirrored(distance[foreign & (np.abs(distance) < _SIDE_BAND * base)], width)
    if mirrored:
        return LockIn(MULTIPLE, base, mirrored, harmonics, levels)
    other = _other_base(line[foreign], base, width)
    if other:
        return LockIn(DUAL, base, other, harmonics, levels)
    return LockIn(_one_base(base, first, second, near), base, 0.0, harmonics, levels)


def harmonic_levels(signal, rate, base, count, dynamic_range):
    """Level (count,) in dB of the multiples of ``base`` (Hz) re the first; -inf below the range or without a line."""
    frequency, level = _spectrum(signal, rate)
    levels, first = np.full(count, -np.inf), None
    for k in range(min(count, int(0.45 * rate / base))):
        middle, half = int(round((k + 1) * base / frequency[1])), max(3, int(round(0.004 * base / frequency[1])))
        peak = level[middle - half:middle + half + 1].max()
        floor = np.median(level[max(middle - _SURROUNDINGS, 0):middle + _SURROUNDINGS])
        first = peak if first is None else first
        if peak > floor + _MULTIPLE_PROMINENCE and peak > first - dynamic_range:
            levels[k] = peak - first
    return levels


def _one_base(base, first, second, near):
    """Kind of a spectrum with one base frequency."""
    closest = [float(modes[np.argmin(np.abs(modes - base))]) for modes in map(np.atleast_1d, (first, second))]
    if min(abs(base / f - 1) for f in closest) <= near:
        return CLASSICAL
    return INTERMEDIATE if min(closest) < base < max(closest) else OTHER


def _spectrum(signal, rate):
    """Frequencies (Hz) and levels (dB, any reference; silence at -400) of a Blackman window."""
    window = np.blackman(len(signal))
    middle = window @ signal / window.sum()
    amplitude = np.abs(np.fft.rfft(window * (signal - middle)))
    return np.fft.rfftfreq(len(signal), 1 / rate), 20 * np.log10(np.maximum(amplitude, 1e-20))


def _lines(frequency, level, lowest, highest, below):
    """Frequencies (Hz) and levels (dB) of the lines at most ``below`` dB under the strongest, ascending."""
    kept = (frequency >= lowest) & (frequency <= highest)
    if level[kept].max() <= -300:
        return np.empty(0), np.empty(0)
    top = np.flatnonzero(kept[1:-1] & (level[1:-1] >= level[:-2]) & (level[1:-1] > level[2:])
                         & (level[1:-1] > level[kept].max() - below)) + 1
    floor = np.array([np.median(level[max(k - _SURROUNDINGS, 0):k + _SURROUNDINGS]) for k in top])
    top = top[level[top] > floor + _PROMINENCE]
    shift = np.array([_vertex(level[k - 1:k + 2]) for k in top])
    return (top + shift) * frequency[1], level[top]


def _vertex(three):
    """Place of the vertex of the parabola through three levels, from the middle one."""
    bend = three[0] - 2 * three[1] + three[2]
    return 0.5 * (three[0] - three[2]) / bend if bend else 0.0


def _base(line, level):
    """The strongest line, or the line of which it is a multiple."""
    strongest = line[np.argmax(level)]
    for order in (4, 3, 2):
        candidate = line[np.abs(line * order / strongest - 1) < 0.003]
        if len(candidate):
            return float(strongest / order)
    return float(strongest)


def _mirrored(distance, width):
    """Smallest distance of side bands on both sides of a multiple, 0 where there are none."""
    for d in np.sort(distance[distance > 0]):
        if np.any(np.abs(distance + d) <= width):
            return float(d)
    return 0.0


def _other_base(line, base, width):
    """A second base frequency: the lowest foreign line that is no combination k base / 2 of the first."""
    for f in np.sort(line):
        half = np.round(2 * f / base)
        if abs(f - half * base / 2) > width:
            return float(f)
    return 0.0
