"""Squeal events in a signal, simulated or recorded: tones above a level, followed through time.

Overlapping Hann frames give the tones of each instant; tones near each other in frequency from
frame to frame are one event. A signal may hold many events, one after the other or at once.
Events that are whole multiples of a lower tone, in the band or below it, say so (``harmonics``).
"""

from dataclasses import dataclass, field

import numpy as np
import scipy

from pipeline.physics.signals.harmonic_ladder import comb, ladders
from pipeline.physics.signals.spectra import level

#: how much lower a tone midway between two lines of a Hann spectrum looks [dB], rounded up
_BETWEEN_LINES = 1.5
#: lines on either side of a tone, and those next to it that are its own, of which the median is the noise about it
_ABOUT, _OWN = 20, 3


@dataclass(frozen=True)
class Detector:
    """What counts as squeal.

    band : lowest and highest frequency [Hz]
    threshold : level that a tone must reach [dB re ``reference``]
    reference : reference value of the level, root mean square [unit of the signal]
    window : length of a frame [s]; tones closer than four of its inverse are not told apart
    overlap : share of a frame that the next one repeats
    prominence : height of a tone above the valleys of the spectrum beside it [dB]
    range : a tone weaker than the strongest of its frame by more than this is a side lobe [dB]
    drift : largest change of frequency from frame to frame [Hz]
    gap : longest interruption inside one event [s]
    shortest : shortest event [s]
    lowest_fundamental : tones from here to the band, too, may have harmonics in it [Hz]; they must pass the same
        threshold, prominence and range, and are no events
    accuracy : largest error of a frequency between the lines, as a share of their distance. Exact for one steady
        tone; a tone 30 dB stronger eight lines away moves it by up to 0.05. Modulated tones err more and are then
        missed as harmonics, frame by frame
    chance : largest share of unrelated tones that may pass as harmonics of one fundamental (see ``harmonics``)
    told : share of the frames of a harmonic that must tell its order. A modulated one is missed in many; a tone of no
        relation that wanders matches in about ``chance`` of them, a steady one in all or in none
    weighted : A-weighting of all levels (IEC 61672-1)
    above : height of a tone above the median of the lines about it [dB]; 0 asks for none. Of noise alone a line is
        rarely that high, where ``prominence`` over its valleys is met by chance
    comb : so many equidistant tones are one series, even if its fundamental is not heard; 0 asks for none
    """

    band: tuple
    threshold: float
    reference: float
    window: float
    overlap: float
    prominence: float
    range: float
    drift: float
    gap: float
    shortest: float
    lowest_fundamental: float
    accuracy: float
    chance: float
    told: float
    weighted: bool = False
    above: float = 0.0
    comb: int = 0


@dataclass(frozen=True)
class Event:
    """One squeal event.

    frequency : mean [Hz]
    level : largest [dB]
    start, duration : [s]
    fundamental : mean frequency of the tone of which it is a multiple [Hz]; of an own tone, its own
    order : the multiple, in more than the share ``told`` of its frames; 1 = a tone of its own
    course : (3, frame) time [s], frequency [Hz] and level [dB] from frame to frame
    """

    frequency: float
    level: float
    start: float
    duration: float
    fundamental: float
    order: int
    course: np.ndarray = field(compare=False, repr=False)


@dataclass(eq=False)
class _Track:
    """An event that grows: frames, frequencies, levels, orders and fundamentals so far."""

    frame: list
    frequency: list
    level: list
    order: list
    fundamental: list


class Loudest:
    """Watches Frames for the strongest tone of the band in any frame."""

    def __init__(self, found, detector):
        self._found, self._detector, self._most, self._tone = found, detector, -np.inf, None

    def see(self, _, spectra):
        """The next block of spectra (frame, line)."""
        inside = np.where(self._found.inside(self._detector.band), spectra, 0)
        if inside.max() > self._most:
            frame, line = np.unravel_index(inside.argmax(), inside.shape)
            self._most, self._tone = inside[frame, line], _refine(spectra[frame], self._found, np.array([line]))

    def result(self):
        """(level [dB], frequency [Hz])."""
        (frequency,), (root_mean_square,) = self._tone
        return float(level(root_mean_square**2, self._detector.reference)), float(frequency)


class Search:
    """Watches Frames for events; what grows at the end of a block goes on in the next."""

    def __init__(self, found, detector):
        self._found, self._detector, self._growing, self._ended = found, detector, [], []
        self._least = detector.reference * 10.0 ** ((detector.threshold - _BETWEEN_LINES) / 20.0)
        self._searched = found.inside((min(detector.lowest_fundamental, detector.band[0]), detector.band[1]))

    def see(self, first, spectra):
        """The next block of spectra (frame, line), from the frame ``first`` on."""
        time, longest = self._found.time, self._detector.gap + self._found.hop * 1.5
        for k in np.flatnonzero(spectra[:, self._searched].max(axis=1, initial=0.0) >= self._least):
            frame = first + k
            late = [t for t in self._growing if time[frame] - time[t.frame[-1]] > longest]
            self._ended += late
            self._growing = [t for t in self._growing if t not in late]
            _extend(self._growing, frame, *_related_tones(spectra[k], self._found, self._detector), self._detector)

    def result(self):
        """[Event], in order of their begin."""
        events = [_event(track, self._found, self._detector) for track in self._ended + self._growing]
        return sorted((e for e in events if e.duration >= self._detector.shortest),
                      key=lambda e: (e.start, e.frequency))


def loudest(found, detector):
    """Level [dB] and frequency [Hz] of the strongest tone of the band in any of the Frames."""
    watcher = Loudest(found, detector)
    found.scan(watcher)
    return watcher.result()


def detect(found, detector):
    """Events of the Frames, in order of their begin.

    Begin and end are where the tone passes the threshold, to half a hop. A frame that covers only
    part of a tone shows part of its amplitude (half of it, -6 dB, with the begin in its middle), so
    that a sudden tone seems to begin before its true begin by up to half a window if it is more
    than 6 dB above the threshold, and after it if less.
    """
    watcher = Search(found, detector)
    found.scan(watcher)
    return watcher.result()


def _related_tones(spectrum, found, detector):
    """Frequencies, levels, orders and fundamentals of the tones of the band in the spectrum (line,) of one frame of
    Frames, strongest first."""
    (frequency, levels), (below, _) = _tones(spectrum, found, detector)
    below = below[below >= detector.lowest_fundamental]
    accuracy = detector.accuracy * found.frequency[1]
    order, fundamental = ladders(np.concatenate([frequency, below]), accuracy, detector.chance)
    if detector.comb:
        order, fundamental = comb(np.concatenate([frequency, below]), order, fundamental, accuracy, detector.comb)
    return frequency, levels, order[:len(frequency)], fundamental[:len(frequency)]


def _tones(spectrum, found, detector):
    """(Frequencies, levels) of the tones of one frame, strongest first: those of the band, and those below it."""
    levels = level(spectrum**2, detector.reference)
    lines = scipy.signal.find_peaks(levels, detector.threshold - _BETWEEN_LINES, prominence=detector.prominence)[0]
    bands = [found.inside(band) for band in (detector.band, (detector.lowest_fundamental, detector.band[0]))]
    lines = lines[(bands[0] | bands[1])[lines]]
    if detector.above:
        lines = lines[levels[lines] >= _about(levels, lines) + detector.above]
    frequency, root_mean_square = _refine(spectrum, found, lines)
    levels = level(root_mean_square**2, detector.reference)
    return [_strongest(frequency[inside[lines]], levels[inside[lines]], detector) for inside in bands]


def _strongest(frequency, levels, detector):
    """Tones that reach the threshold and are within the range of the strongest, strongest first."""
    lowest = max(detector.threshold, levels.max(initial=-np.inf) - detector.range)
    order = [i for i in np.argsort(-levels, kind="stable") if levels[i] >= lowest]
    return frequency[order], levels[order]


def _about(levels, lines):
    """Median level (n,) in dB of the lines about each of ``lines`` (n,), without those that are its own."""
    away = np.r_[-_ABOUT:-_OWN, _OWN + 1:_ABOUT + 1]
    return np.median(levels[np.clip(lines[:, None] + away, 0, len(levels) - 1)], axis=1)


def _refine(spectrum, found, lines):
    """Frequency and root mean square of tones between the lines of a Hann spectrum: exact for one steady tone."""
    last = len(found.frequency) - 1
    lower, upper = spectrum[np.maximum(lines - 1, 0)], spectrum[np.minimum(lines + 1, last)]
    side = np.where(upper >= lower, 1, -1)
    ratio = np.maximum(upper, lower) / np.maximum(spectrum[lines], np.finfo(float).tiny)
    shift = np.clip((2 * ratio - 1) / (ratio + 1), 0, 0.5)
    spacing = found.frequency[1]
    return found.frequency[lines] + side * shift * spacing, spectrum[lines] * (1 - shift**2) / np.sinc(shift)


def _extend(growing, frame, frequency, levels, orders, fundamentals, detector):
    """Give each tone to the nearest event that lived before this frame, or begin a new one."""
    waiting = list(growing)
    for f, strength, order, fundamental in zip(frequency, levels, orders, fundamentals, strict=True):
        nearest = min(waiting, key=lambda t: abs(t.frequency[-1] - f), default=None)
        if nearest is not None and abs(nearest.frequency[-1] - f) <= detector.drift:
            waiting.remove(nearest)
        else:
            nearest = _Track([], [], [], [], [])
            growing.append(nearest)
        nearest.frame.append(frame)
        nearest.frequency.append(f)
        nearest.level.append(strength)
        nearest.order.append(order)
        nearest.fundamental.append(fundamental)


def _event(track, found, detector):
    """An event reaches half a hop beyond its frames, or to the ends of the signal."""
    first, last = track.frame[0], track.frame[-1]
    start = 0.0 if first == 0 else found.time[first] - found.hop / 2
    end = found.duration if last == len(found.time) - 1 else found.time[last] + found.hop / 2
    power = 10**(np.array(track.level) / 10)
    frequency = float(np.average(track.frequency, weights=power))
    course = np.array([found.time[track.frame], track.frequency, track.level])
    return Event(frequency, max(track.level), start, end - start, *_origin(track, frequency, power, detector), course)


def _origin(track, frequency, power, detector):
    """(fundamental, order) of an event: the order above 1 that most frames tell, if enough do, else its own tone."""
    orders = np.array(track.order)
    order = int(np.bincount(orders[orders > 1], minlength=2).argmax())
    matching = orders == order
    if order < 2 or matching.mean() <= detector.told:
        return frequency, 1
    return float(np.average(np.array(track.fundamental)[matching], weights=power[matching])), order
