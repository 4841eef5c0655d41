"""Noise events of a recorded brake: squeal, its harmonics, tones that sweep, low tones, and noise without a tone.

The tones are those of ``squeal_detector``; here they get their begin, length and name.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.signals.spectra import level
from pipeline.physics.signals.squeal_detector import Search

SQUEAL, HARMONIC, SWEEP, SERIES, BROADBAND = "squeal", "harmonic", "sweep", "series", "broadband"
#: harmonics that an overloaded instrument makes of a tone
CLIPPING = "clipping"
#: names of steady tones below the squeal band, and the frequency [Hz] up to which each goes
LOW = ((100.0, "judder"), (500.0, "groan"), (np.inf, "moan"))
#: where a tone begins and ends: so far below the median level of its course [dB]. A frame of which half lies in a
#: sudden tone shows half of its amplitude
_HALF = 6.0
#: share by which the frequency of a steady tone may vary, and how much more in a second
_STEADY, _GLIDE = 0.005, 0.015
#: parts at either end of a course whose frequency does not count, and equivalent noise bandwidth of Hann frames [lines]
_ENDS, _BANDWIDTH = 0.1, 1.5
#: how far below its threshold a tone is followed [dB], so that it is one event if its level varies about that
_BELOW = 10.0
#: how much fainter moving tones may be that make a steady one part of theirs [dB], and instants that are asked
_AS_LOUD, _GRID = 15.0, 50
#: multiples of a tone that clipping makes, the n-th at most 1/n of it but for what the weighting differs [dB], and
#: their largest distance from it, n times, in lines
_MULTIPLES, _WEIGHTED, _OFF = 25, 9.0, 0.1
#: strongest lines of a frame that do not count as noise without a tone
_TONES = 12


@dataclass(frozen=True)
class NoiseEvent:
    """One event: ``frequency`` in Hz, ``lowest`` and ``highest`` of its course, largest ``level`` in dB, ``start``
    and ``duration`` in s, ``fundamental`` in Hz and ``order`` as of ``squeal_detector.Event``, and what it is."""

    kind: str
    frequency: float
    lowest: float
    highest: float
    level: float
    start: float
    duration: float
    fundamental: float
    order: int


class Tonal:
    """Watches Frames for tones.

    A tone whose frequency varies by more than the share ``wander``, a short one by more than half a percent, is a
    sweep, not squeal; ``low``: tones below the squeal band, named by their frequency.
    """

    def __init__(self, found, detector, wander, low=False):
        self._hop, self._detector, self._named = found.hop, detector, (detector.window, wander, low)
        self._search = Search(found, replace(detector, threshold=detector.threshold - _BELOW))
        self.see = self._search.see

    def result(self):
        """[NoiseEvent], by begin."""
        events = [_named(event, self._hop, *self._named) for event in self._search.result()]
        moving = [event for event in events if event.kind == SWEEP]
        told = [replace(event, kind=SERIES) if event.kind not in (SWEEP, HARMONIC) and _among(event, moving) else event
                for event in events]
        return [event for event in told
                if event.duration >= self._detector.shortest and event.level >= self._detector.threshold]


def tonal(found, detector, wander, low=False):
    """[NoiseEvent] of the tones in Frames, by begin; see ``Tonal``."""
    watcher = Tonal(found, detector, wander, low)
    found.scan(watcher)
    return watcher.result()


def _among(event, moving):
    """Whether most of an event passes while tones as loud, to some dB, move: part of a creak that stands still."""
    end, covered = event.start + event.duration, np.zeros(_GRID, bool)
    time = event.start + event.duration * (np.arange(_GRID) + 0.5) / _GRID
    for other in moving:
        if other.start < end and other.start + other.duration > event.start and other.level > event.level - _AS_LOUD:
            covered |= (time >= other.start) & (time <= other.start + other.duration)
    return covered.mean() > 0.5


def clipped(events, overload, rate, spacing):
    """[NoiseEvent] with those named that clipping made of others: multiples of a louder tone while samples of the
    record stand at the end of its range, folded down where they pass half the ``rate`` [Hz].

    ``overload``: Overload of the record, or None; ``spacing`` [Hz] of the lines. Cut at both ends, multiples are odd.
    """
    if overload is None:
        return events
    orders = np.arange(3, _MULTIPLES + 1, 2) if overload.low and overload.high else np.arange(2, _MULTIPLES + 1)
    loud = [event for event in events if event.kind not in (BROADBAND, SWEEP)
            and overload.during(event.start, event.start + event.duration, rate)]

    def made(event, of):
        apart = abs(event.frequency - abs((orders * of.frequency + rate / 2) % rate - rate / 2))
        most = of.level - 20.0 * np.log10(orders) + _WEIGHTED
        together = event.start < of.start + of.duration and of.start < event.start + event.duration
        return together and event.level < of.level and np.any(
            (apart < _OFF * spacing * orders) & (event.level < most))

    return [replace(event, kind=CLIPPING) if event in loud and any(made(event, of) for of in loud if of is not event)
            else event for event in events]


class Broadband:
    """Watches Frames for stretches in which the band is as loud as the threshold without its strongest lines, and for
    the median level of the band."""

    def __init__(self, found, detector):
        self._found, self._detector, self._inside = found, detector, found.inside(detector.band)
        self._whole, self._levels, self._middles = [], [], []

    def see(self, _, spectra):
        """The next block of spectra (frame, line)."""
        power, frequency = np.square(spectra[:, self._inside], dtype=float), self._found.frequency[self._inside]
        self._whole.append(power.sum(axis=1))
        if power.shape[1] > 4 * _TONES:
            np.put_along_axis(power, np.argpartition(power, -_TONES, axis=1)[:, -_TONES:], 0.0, axis=1)
        else:                   # too few lines to leave some out: noise by their median
            power[:] = np.median(power, axis=1, keepdims=True) / np.log(2.0)
        noise = power.sum(axis=1)
        self._levels.append(level(noise / _BANDWIDTH, self._detector.reference))
        self._middles.append(np.divide(power @ frequency, noise, out=np.zeros(len(noise)), where=noise > 0.0))

    def background(self):
        """Median level of the band [dB]."""
        return float(level(np.median(np.concatenate(self._whole)) / _BANDWIDTH, self._detector.reference))

    def result(self):
        """[NoiseEvent], by begin."""
        levels, middles = np.concatenate(self._levels), np.concatenate(self._middles)
        found, detector = self._found, self._detector
        loud = np.flatnonzero(np.diff(np.r_[False, levels >= detector.threshold, False].astype(int))).reshape(-1, 2)
        stretches = [(first, last) for first, last in loud if (last - first) * found.hop >= detector.shortest]
        return [NoiseEvent(BROADBAND, float(middles[a:b].mean()), detector.band[0], detector.band[1],
                           float(levels[a:b].max()), float(found.time[a] - found.hop / 2), float((b - a) * found.hop),
                           float(middles[a:b].mean()), 1) for a, b in stretches]


def broadband(found, detector):
    """[NoiseEvent] of the noise without a tone in Frames, by begin; see ``Broadband``."""
    watcher = Broadband(found, detector)
    found.scan(watcher)
    return watcher.result()


def _named(event, hop, window, wander, low):
    _, frequency, levels = event.course
    start, end = _ends(event, hop, window)
    ends = int(_ENDS * len(frequency))
    steady = slice(ends, len(frequency) - ends)
    lowest, highest = float(frequency[steady].min()), float(frequency[steady].max())
    if highest - lowest > min(_STEADY + _GLIDE * (end - start), wander) * event.frequency:
        kind = SWEEP
    elif event.order > 1:
        kind = HARMONIC
    else:
        kind = next(name for top, name in LOW if event.frequency < top) if low else SQUEAL
    mean = float(np.average(frequency[steady], weights=10.0 ** (levels[steady] / 10.0)))
    return NoiseEvent(kind, mean, lowest, highest, event.level, start, end - start, event.fundamental,
                      event.order)


def _ends(event, hop, window):
    """(begin, end) in s of an event, by the frames at its ends that cover it in half or so; else as it was seen."""
    time, _, levels = event.course
    whole = np.median(levels)
    passed = np.flatnonzero(levels >= whole - _HALF)
    begin, end = event.start, event.start + event.duration
    if abs(levels[passed[0]] - whole + _HALF) < _HALF and event.start > 0.0:
        begin = time[passed[0]] + window * (0.5 - _covered(levels[passed[0]] - whole))
    if abs(levels[passed[-1]] - whole + _HALF) < _HALF:
        end = time[passed[-1]] - window * (0.5 - _covered(levels[passed[-1]] - whole))
    return float(begin), float(max(end, begin + hop))


def _covered(decibel):
    """Share of a Hann frame that a tone covers from one end, which shows its amplitude so many dB too low."""
    share = np.linspace(0.0, 1.0, 501)
    return np.interp(10.0 ** (min(decibel, 0.0) / 20.0), share - np.sin(2 * np.pi * share) / (2 * np.pi), share)
