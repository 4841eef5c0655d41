"""Order tracking: vibration that follows the revolutions of a shaft. Order 1 is once per revolution.

The speed is integrated to the angle, the signal is read at equal angles, and its Hann spectra over the angle tell the
orders. Source: K. R. Fyfe and E. D. S. Munck, Mech. Syst. Signal Process. 11 (1997) 187, doi 10.1006/mssp.1996.0056.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view

#: samples per period of the highest frequency: cubic splines err there by 0.4 % of the amplitude
_SAMPLED = 5.0

#: share of the height of a tacho's pulses that its signal must pass beyond their middle
_HYSTERESIS = 0.15
#: intervals of pulses on either side with which one is compared, and how many times it is longer where a pulse is
#: missing, or shorter where one is too many
_BESIDE, _LONG, _SHORT = 3, 1.6, 0.4
#: gaps of a toothed wheel that tell that it has them, and share of them that must be as far apart
_GAPS, _ALIKE = 3, 0.8
#: blocks that are transformed at once
_AT_ONCE = 256


@dataclass(frozen=True)
class Shaft:
    """A shaft. time : (n,) [s]; speed : (n,) [rad/s], without direction; turns : (n,) revolutions since its begin;
    remark : what was assumed of its pulses, '' of nothing."""

    time: np.ndarray
    speed: np.ndarray
    turns: np.ndarray
    remark: str = ""


@dataclass(frozen=True)
class Smooth:
    """A signal without what lies above the highest frequency of interest.

    time : (sample,) [s]
    samples : (sample,) [unit of the signal]
    known : (sample,) whether nothing was missing about it
    """

    time: np.ndarray
    samples: np.ndarray
    known: np.ndarray


@dataclass(frozen=True)
class Orders:
    """Spectra over the angle, block by block.

    time, speed : (block,) middle [s] and mean speed [rad/s]
    order : (line,)
    amplitude : (block, line) of a sine on that line [unit of the signal]
    """

    time: np.ndarray
    speed: np.ndarray
    order: np.ndarray
    amplitude: np.ndarray


def shaft_of(speed, rate, begin):
    """Shaft of its ``speed`` (n,) in rad/s at ``rate`` in Hz from ``begin`` in s; missing samples (NaN) are bridged."""
    known = np.isfinite(speed)
    size = np.abs(np.interp(np.arange(len(speed)), np.flatnonzero(known), speed[known]))
    steps = (size[1:] + size[:-1]) / (4.0 * np.pi * rate)
    return Shaft(begin + np.arange(len(size)) / rate, size, np.concatenate([[0.0], np.cumsum(steps)]))


def shaft_of_pulses(samples, rate, begin, pulses):
    """Shaft of a tacho (n,) at ``rate`` in Hz from ``begin`` in s that gives so many ``pulses`` a revolution, evenly.

    A pulse is where the signal rises through its middle, after it was low. Where an interval is twice as long as those
    on both sides, or more times, pulses are missing, as of a wheel without some of its teeth, and are counted. None
    where fewer than three pulses come.
    """
    low, high = np.nanpercentile(samples, [0.1, 99.9])
    middle, state = (low + high) / 2, np.zeros(len(samples), int)
    state[samples > middle + _HYSTERESIS * (high - low)] = 1
    state[samples < middle - _HYSTERESIS * (high - low)] = -1
    told = np.flatnonzero(state)
    rises = told[1:][(state[told[1:]] == 1) & (state[told[:-1]] == -1)]
    falls = told[:-1][(state[told[1:]] == 1) & (state[told[:-1]] == -1)]
    if high == low or len(rises) < 3:
        return None
    share = (middle - samples[falls]) / (samples[rises] - samples[falls])
    time = begin + (falls + share * (rises - falls)) / rate
    steps, short = _steps(np.diff(time))
    pulses, remark = _teeth(steps, pulses)
    if short:
        remark += f"{'; ' if remark else ''}{short} pulses come too soon after another, and are counted: noise?"
    turns = np.concatenate([[0], np.cumsum(steps)]) / pulses
    return Shaft(time, 2.0 * np.pi * np.gradient(turns, time), turns, remark)


def _steps(interval):
    """((n,) pulses that pass in each ``interval`` (n,), number of those that are far too short)."""
    steps, inner = np.ones(len(interval), int), interval[1:-1]
    if not len(inner):
        return steps, 0
    about = sliding_window_view(np.pad(interval, _BESIDE, constant_values=np.nan), _BESIDE)
    before, after = (np.nanmedian(about[k:k + len(inner)], axis=1) for k in (1, _BESIDE + 2))
    steps[1:-1] = np.where(inner > _LONG * np.maximum(before, after), np.rint(2 * inner / (before + after)), 1)
    return steps, int(np.sum(inner < _SHORT * np.minimum(before, after)))


def _teeth(steps, pulses):
    """(pulses of a whole revolution, remark) of a tacho of which the case says that it gives ``pulses``."""
    gaps = np.flatnonzero(steps > 1)
    if not len(gaps):
        return pulses, ""
    apart, missing = np.diff(np.cumsum(steps)[gaps]), int(np.median(steps[gaps])) - 1
    every, often = int(np.median(apart)) if len(apart) else 0, np.mean(apart == np.median(apart)) if len(apart) else 0.0
    if len(gaps) >= _GAPS and often >= _ALIKE and pulses in (every, every - missing):
        other = "" if pulses == every else f", and a revolution has {every} pulses, not {pulses}"
        return every, (f"a wheel of {every} teeth of which {missing} {'is' if missing == 1 else 'are'} missing: the gap"
                       f" is bridged{other}")
    told = f"{int(np.sum(steps[gaps] - 1))} pulses are missing in {len(gaps)} gaps, which are bridged"
    if len(gaps) >= _GAPS and often >= _ALIKE:
        told += f"; as gaps come every {every} pulses, this may be a wheel with a gap, and orders.pulses {every}"
    return pulses, told


def smooth(samples, rate, begin, highest):
    """Smooth of ``samples`` (n,), NaN where missing, at ``rate`` in Hz, without what is far above ``highest``."""
    down = max(int(rate / (_SAMPLED * highest)), 1)
    known = np.isfinite(samples)
    mean = samples[known].mean()
    reduced = scipy.signal.resample_poly(np.where(known, samples - mean, 0.0), 1, down)
    lost = np.add.reduceat(~known, np.arange(0, len(known), down)) > 0
    time = begin + np.arange(len(reduced)) * down / rate
    return Smooth(time, reduced + mean, ~scipy.ndimage.binary_dilation(lost, iterations=10))


def track(signal, shaft, highest, revolutions, slowest, overlap=0.75):
    """Orders up to ``highest`` of a Smooth signal, in blocks of ``revolutions``.

    Blocks in which the shaft turns slower than ``slowest`` [rad/s] or samples are missing are left out. None where no
    block is left.
    """
    read = scipy.interpolate.CubicSpline(signal.time, signal.samples)
    parts = [_blocks(signal, read, shaft, stretch, highest, revolutions, slowest, overlap)
             for stretch in _turning(signal, shaft, slowest)]
    parts = [part for part in parts if part is not None]
    if not parts:
        return None
    time, speed, amplitude = (np.concatenate([part[k] for part in parts]) for k in range(3))
    return Orders(time, speed, np.arange(amplitude.shape[1]) / revolutions, amplitude)


def _turning(signal, shaft, slowest):
    """Slices of the samples of a Shaft, within the signal, that are ``slowest`` or faster."""
    fast = (shaft.speed >= slowest) & (shaft.time >= signal.time[0]) & (shaft.time <= signal.time[-1])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], fast, [False]]).astype(int))).reshape(-1, 2)
    return [slice(first, last) for first, last in edges if last - first > 1]


def _blocks(signal, read, shaft, stretch, highest, revolutions, slowest, overlap):
    """(time (block,), speed (block,), amplitude (block, line)) of one stretch, or None of one that is too short."""
    time, speed, turns = shaft.time[stretch], shaft.speed[stretch], shaft.turns[stretch]
    interval = signal.time[1] - signal.time[0]
    density = int(np.ceil(max(2.0 * np.pi / (slowest * interval), 4.0 * highest)))     # no frequency is folded down
    size = density * revolutions
    at = turns[0] + np.arange(int((turns[-1] - turns[0]) * density) + 1) / density
    if len(at) < size:
        return None
    instant = scipy.interpolate.CubicHermiteSpline(turns, time, 2.0 * np.pi / speed)(at)
    first = np.arange(0, len(at) - size + 1, max(round(size * (1.0 - overlap)), 1))
    last = first + size - 1
    lost = np.concatenate([[0], np.cumsum(~signal.known)])
    begin, end = (np.searchsorted(signal.time, instant[k]) for k in (first, last))
    whole = lost[end] == lost[begin]
    if not whole.any():
        return None
    spectra = _amplitudes(sliding_window_view(read(instant), size)[first[whole]], round(highest * revolutions) + 1)
    lasted = instant[last] - instant[first]
    return ((instant[first] + lasted / 2)[whole], (2.0 * np.pi * (size - 1) / density / lasted)[whole], spectra)


def _amplitudes(pieces, lines):
    """(block, line) amplitudes of ``lines`` of the Hann spectra of blocks (block, n), without their straight lines."""
    size = pieces.shape[1]
    hann, ramp = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(size) / size), np.linspace(-1.0, 1.0, size)
    spectra = np.empty((len(pieces), lines))
    for first in range(0, len(pieces), _AT_ONCE):
        part = pieces[first:first + _AT_ONCE]
        part = part - part.mean(axis=1, keepdims=True)
        part -= np.outer(part @ ramp / (ramp @ ramp), ramp)
        spectra[first:first + _AT_ONCE] = 2.0 * np.abs(scipy.fft.rfft(part * hann)[:, :lines]) / hann.sum()
    return spectra


def over_speed(speed, values, edges):
    """Root mean square (bin, ...) of ``values`` (n, ...) by ``speed`` (n,), 0 where there are none, and counts (bin,).

    ``edges`` (bin + 1,) of the bins, in the unit of the speed.
    """
    index = np.searchsorted(edges, speed, side="right") - 1
    index = np.where(speed == edges[-1], len(edges) - 2, index)
    inside = (index >= 0) & (index < len(edges) - 1)
    count = np.bincount(index[inside], minlength=len(edges) - 1)
    total = np.zeros((len(edges) - 1, *values.shape[1:]))
    np.add.at(total, index[inside], np.square(values[inside], dtype=float))
    return np.sqrt(total / np.maximum(count, 1).reshape(-1, *[1] * (values.ndim - 1))), count


def campbell(signal, shaft, highest, window, edges, overlap=0.9):
    """(frequency (line,) up to ``highest`` in Hz, amplitude (bin, line), counts (bin,)): amplitude over speed.

    Hann frames of ``window`` s count in the bin of their mean speed; ``edges`` (bin + 1,) [rad/s]. A frame without all
    of its samples, or that reaches beyond the record of the speed, is left out.
    """
    rate = 1.0 / (signal.time[1] - signal.time[0])
    size = min(round(window * rate), len(signal.time))
    first = np.arange(0, len(signal.time) - size + 1, max(round(size * (1.0 - overlap)), 1))
    begin, end = signal.time[first], signal.time[first + size - 1]
    lost = np.concatenate([[0], np.cumsum(~signal.known)])
    whole = (lost[first + size] == lost[first]) & (begin >= shaft.time[0]) & (end <= shaft.time[-1])
    turned = np.interp(end, shaft.time, shaft.turns) - np.interp(begin, shaft.time, shaft.turns)
    speed = 2.0 * np.pi * turned / (end - begin)
    frequency = np.fft.rfftfreq(size, 1.0 / rate)
    lines = np.count_nonzero(frequency <= highest)
    spectra = _amplitudes(sliding_window_view(signal.samples, size)[first[whole]], lines)
    return frequency[:lines], *over_speed(speed[whole], spectra, edges)
