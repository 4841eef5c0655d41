"""Squeal events in a signal, simulated or recorded: tones above a level, followed through time.

Overlapping Hann frames give the tones of each instant; tones near each other in frequency from
frame to frame are one event. A signal may hold many events, one after the other or at once.
Events that are whole multiples of a lower tone, in the band or below it, say so (``harmonics``).
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.harmonic_ladder import ladders
from pipeline.physics.signals.spectra import level

#: how much lower a tone midway between two lines of a Hann spectrum looks [dB], rounded up
_BETWEEN_LINES = 1.5


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


@dataclass(frozen=True)
class Frames:
    """Overlapping Hann frames of one signal.

    time : (frame,) middle of each frame [s]
    hop : time from frame to frame [s]
    duration : of the signal [s]
    frequency : (line,) [Hz]
    spectrum : (frame, line) root mean square of a tone on that line [unit of the signal]
    """

    time: np.ndarray
    hop: float
    duration: float
    frequency: np.ndarray
    spectrum: np.ndarray


@dataclass(frozen=True)
class Event:
    """One squeal event.

    frequency : mean [Hz]
    level : largest [dB]
    start, duration : [s]
    fundamental : mean frequency of the tone of which it is a multiple [Hz]; of an own tone, its own
    order : the multiple, in more than the share ``told`` of its frames; 1 = a tone of its own
    """

    frequency: float
    level: float
    start: float
    duration: float
    fundamental: float
    order: int


@dataclass(eq=False)
class _Track:
    """An event that grows: frames, frequencies, levels, orders and fundamentals so far."""

    frame: list
    frequency: list
    level: list
    order: list
    fundamental: list


def frames(signal, rate, detector):
    """Frames of a signal (sample,) taken at ``rate`` [Hz].

    Raises ConfigError for a signal shorter than a frame or a band beyond half the rate.
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
    piece = sliding_window_view(signal, size)[::hop] * hann
    spectrum = np.abs(np.fft.rfft(piece)) * (np.sqrt(2) / hann.sum())
    middle = (np.arange(len(piece)) * hop + size / 2) / rate
    return Frames(middle, hop / rate, len(signal) / rate, np.fft.rfftfreq(size, 1 / rate), spectrum)


def loudest(spectrum, detector):
    """Level [dB] and frequency [Hz] of the strongest tone of the band in any frame."""
    inside = _inside(spectrum, detector.band)
    frame, line = np.unravel_index(np.where(inside, spectrum.spectrum, 0).argmax(), spectrum.spectrum.shape)
    frequency, root_mean_square = _refine(spectrum, frame, np.array([line]))
    return float(level(root_mean_square[0]**2, detector.reference)), float(frequency[0])


def detect(found, detector):
    """Events of the frames, in order of their begin.

    Begin and end are where the tone passes the threshold, to half a hop. A frame that covers only
    part of a tone shows part of its amplitude (half of it, -6 dB, with the begin in its middle), so
    that a sudden tone seems to begin before its true begin by up to half a window if it is more
    than 6 dB above the threshold, and after it if less.
    """
    growing, ended = [], []
    for frame in range(len(found.time)):
        late = [t for t in growing if found.time[frame] - found.time[t.frame[-1]] > detector.gap + found.hop * 1.5]
        ended += late
        growing = [t for t in growing if t not in late]
        _extend(growing, frame, *_related_tones(found, frame, detector), detector)
    events = [_event(track, found, detector) for track in ended + growing]
    return sorted((e for e in events if e.duration >= detector.shortest), key=lambda e: (e.start, e.frequency))


def _inside(found, band):
    return (found.frequency >= band[0]) & (found.frequency <= band[1])


def _related_tones(found, frame, detector):
    """Frequencies, levels, orders and fundamentals of the tones of the band in one frame, strongest first."""
    frequency, levels = _tones(found, frame, detector, detector.band)
    below, _ = _tones(found, frame, detector, (detector.lowest_fundamental, detector.band[0]))
    below = below[below >= detector.lowest_fundamental]
    order, fundamental = ladders(np.concatenate([frequency, below]), detector.accuracy * found.frequency[1],
                                 detector.chance)
    return frequency, levels, order[:len(frequency)], fundamental[:len(frequency)]


def _tones(spectrum, frame, detector, band):
    """Frequencies and levels of the tones of one frame in a band (lowest, highest) [Hz], strongest first."""
    levels = level(spectrum.spectrum[frame]**2, detector.reference)
    lines = scipy.signal.find_peaks(levels, detector.threshold - _BETWEEN_LINES, prominence=detector.prominence)[0]
    lines = lines[_inside(spectrum, band)[lines]]
    frequency, root_mean_square = _refine(spectrum, frame, lines)
    levels = level(root_mean_square**2, detector.reference)
    lowest = max(detector.threshold, levels.max(initial=-np.inf) - detector.range)
    order = [i for i in np.argsort(-levels, kind="stable") if levels[i] >= lowest]
    return frequency[order], levels[order]


def _refine(spectra, frame, lines):
    """Frequency and root mean square of tones between the lines of a Hann spectrum: exact for one steady tone."""
    spectrum, last = spectra.spectrum[frame], len(spectra.frequency) - 1
    lower, upper = spectrum[np.maximum(lines - 1, 0)], spectrum[np.minimum(lines + 1, last)]
    side = np.where(upper >= lower, 1, -1)
    ratio = np.maximum(upper, lower) / np.maximum(spectrum[lines], np.finfo(float).tiny)
    shift = np.clip((2 * ratio - 1) / (ratio + 1), 0, 0.5)
    spacing = spectra.frequency[1]
    return spectra.frequency[lines] + side * shift * spacing, spectrum[lines] * (1 - shift**2) / np.sinc(shift)


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


def _event(track, spectrum, detector):
    """An event reaches half a hop beyond its frames, or to the ends of the signal."""
    first, last = track.frame[0], track.frame[-1]
    start = 0.0 if first == 0 else spectrum.time[first] - spectrum.hop / 2
    end = spectrum.duration if last == len(spectrum.time) - 1 else spectrum.time[last] + spectrum.hop / 2
    power = 10**(np.array(track.level) / 10)
    frequency = float(np.average(track.frequency, weights=power))
    return Event(frequency, max(track.level), start, end - start, *_origin(track, frequency, power, detector))


def _origin(track, frequency, power, detector):
    """(fundamental, order) of an event: the order above 1 that most frames tell, if enough do, else its own tone."""
    orders = np.array(track.order)
    order = int(np.bincount(orders[orders > 1], minlength=2).argmax())
    matching = orders == order
    if order < 2 or matching.mean() <= detector.told:
        return frequency, 1
    return float(np.average(np.array(track.fundamental)[matching], weights=power[matching])), order
