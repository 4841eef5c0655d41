"""Frequency responses from records of force and motion, and what stands for them where nobody measured the force.

- Lasting forces: H1 = S_xf S_ff^-1 over Hann segments, half overlapped (Bendat & Piersol, Random Data, 4th ed. 2010,
  ch. 6 and 7). Noise of the motions averages out; noise of the forces makes H1 too small, and the coherence tells.
- Blows: each is cut out up to the next one, its force is zero beside its pulse, and both signals are multiplied by
  exp(-r t) from the blow on, which takes H at iw + r: all decay rates are larger by exactly r.
- Motions alone: correlation functions with the references at positive lags, times exp(-r t). Under a wide-band force
  they decay as the structure does freely (James, Carne & Lauffer, Int. J. Anal. Exp. Modal Anal. 10 (1995) 260).
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.spectra import power_spectrum

#: share of its begin to which a decaying motion is brought at the end of its window
_END = 1e-3
#: force over its largest blow that counts as a blow, over its own peak that is still its pulse, and over which a second
#: one makes it a blow struck twice
_STRUCK, _PULSE, _TWICE = 0.1, 0.02, 0.1
#: shortest window over the typical distance of blows, below which one is cut off by the end of the record
_WHOLE = 0.5
#: widths of a pulse that are kept before and after it
_BEFORE, _AFTER = 2, 3
#: equal samples at the end of a channel's range that are a clipped peak
_CLIPPED = 3
#: share of the record in which a force of blows acts, at most
_RARELY = 0.02
#: Hann segments over which a record without a stated resolution is averaged, at least
_AVERAGES = 16
#: lengths of the correlations that a record of motions alone holds, at least
_LONGER = 10
#: share of the power of a response with another phase below which it has one phase alone
_ONE_PHASE = 1e-9
#: part of the band over which its size is smoothed, inverse widths of the band next to 0 s that do not count, and by
#: how much more power comes on one side of it than on the other where that is clear
_BROAD, _NEAR, _CLEARLY = 16, 3, 2.0


@dataclass(frozen=True)
class Estimated:
    """``response`` (n, r, f) of n motions to r forces or references at ``frequency`` (f,) Hz.

    ``coherence`` (n, f), multiple, of motions with the forces; None where no force was measured. ``averages``: segments
    or blows. ``decay``: what the windows add to every decay rate, 1/s. ``left_out`` ((time in s, why), ...): blows.
    """

    frequency: np.ndarray
    response: np.ndarray
    coherence: np.ndarray | None
    averages: int
    decay: float = 0.0
    left_out: tuple = ()


def of_blows_alone(force):
    """Whether a ``force`` (m,) is one of single blows: it acts for a small part of the record."""
    force = abs(force - np.median(force))
    return bool(np.mean(force > _STRUCK * force.max()) < _RARELY) if force.any() else False


def from_lasting_forces(force, motion, rate, resolution=None):
    """Estimated from ``force`` (r, m) and ``motion`` (n, m), sampled at ``rate`` [Hz], lines ``resolution`` [Hz] apart.

    Raises ConfigError for fewer segments than forces, or forces that are one.
    """
    count = force.shape[1]
    size = 2 * count // (_AVERAGES + 1) if resolution is None else round(rate / resolution)
    averages = 2 * count // max(size, 1) - 1
    if size < 2 or averages < max(2, len(force)):
        raise ConfigError("frequency response: resolution", f"{max(2, len(force))} or more segments",
                          f"{max(averages, 0)} of {size / rate:.3g} s in {count / rate:.3g} s",
                          "state a coarser resolution")
    frequency, auto_force = _spectra(force, force, rate, size)
    _, cross = _spectra(motion, force, rate, size)
    _, power = power_spectrum(motion, rate, rate / size)
    response, coherence = _h1(auto_force, cross, power)
    return Estimated(frequency, response, coherence, averages)


def _spectra(first, second, rate, size):
    """Frequency (f,) and S (f, n, r) of all pairs of ``first`` (n, m) with ``second`` (r, m): conj(second) first."""
    frequency, found = scipy.signal.csd(second[None], first[:, None], rate, "hann", size)
    return frequency, np.moveaxis(found, -1, 0)


def _h1(auto, cross, power):
    """Responses (n, r, f) and multiple coherence (n, f) of S_ff (f, r, r), S_xf (f, n, r), S_xx (n, f)."""
    condition = np.linalg.cond(auto[1:] if len(auto) > 1 else auto)
    if not np.isfinite(condition).any() or np.median(condition) > 1e10:
        raise ConfigError("frequency response: forces", "forces that differ from each other",
                          "one and the same, or none", "name one of them")
    ridge = 1e-14 * np.trace(auto, axis1=1, axis2=2).real.max() * np.eye(auto.shape[1])
    response = np.linalg.solve(np.swapaxes(auto + ridge, 1, 2), np.swapaxes(cross, 1, 2))
    explained = np.einsum("frn,fnr->nf", response, cross.conj()).real
    return np.moveaxis(response, (0, 1, 2), (2, 1, 0)), np.clip(explained / np.maximum(power, 1e-300), 0.0, 1.0)


def from_blows(force, motion, rate, rebound=0.1, size=None, decay=None):
    """Estimated from single blows of a ``force`` (m,) and ``motion`` (n, m), sampled at ``rate`` [Hz].

    Of each blow ``size`` samples, by default up to the next one, under a window of ``decay`` [1/s]. Blows struck twice
    within ``rebound`` s, clipped or cut off by the end of the record are left out. ConfigError where none is left.
    """
    force, motion = force - np.median(force), motion - np.median(motion, axis=1, keepdims=True)
    pulses, left_out = _pulses(force, motion, rate, rebound) if force.any() else ([], [])
    if not pulses:
        told = "; ".join(f"{time:.4g} s: {why}" for time, why in left_out) or "no force"
        raise ConfigError("frequency response: blows", "one usable blow at least", told,
                          "repeat the blows, or cut the record into runs")
    size = min(size or len(force), *(following - begin for begin, _, following in pulses))
    blows = np.array([_pulse(force, begin, end, size) for begin, end, _ in pulses])
    motions = np.array([motion[:, begin:begin + size] for begin, _, _ in pulses])
    decay = _decay(motions, rate) if decay is None else decay
    window = np.exp(-decay * np.arange(size) / rate)
    struck, moved = np.fft.rfft(blows * window), np.fft.rfft(motions * window)
    power = np.sum(abs(struck) ** 2, axis=0)
    cross = np.einsum("bnf,bf->nf", moved, struck.conj())
    response = cross / np.maximum(power, 1e-300)
    coherence = abs(cross) ** 2 / np.maximum(power * np.sum(abs(moved) ** 2, axis=0), 1e-300)
    return Estimated(np.fft.rfftfreq(size, 1 / rate), response[:, None], coherence if len(pulses) > 1 else None,
                     len(pulses), decay, tuple(left_out))


def _pulses(force, motion, rate, rebound):
    """([(begin, end, begin of the following)] in samples of usable blows, [(time in s, why)] of the others)."""
    size, apart = abs(force), round(rebound * rate)
    above = np.flatnonzero(size > _STRUCK * size.max())
    first = above[np.flatnonzero(np.diff(above, prepend=-apart - 2) > apart)]
    found = [_extent(size, start, apart) for start in first]
    begins = [max(begin - _BEFORE * max(end - begin, 2), 0) for begin, end, _ in found]
    nexts = [*begins[1:], len(force)]
    typical = np.median(np.diff(begins)) if len(begins) > 1 else 0
    peaks = [abs(row).max() for row in (force, *motion)]
    kept, left_out = [], []
    for (_, end, twice), begin, following in zip(found, begins, nexts, strict=True):
        rows = (force[begin:following], *motion[:, begin:following])
        if twice:
            why = "struck twice"
        elif any(_clipped(row, peak) for row, peak in zip(rows, peaks, strict=True)):
            why = "clipped"
        elif following - begin < _WHOLE * typical:
            why = "cut off by the end of the record" if following == len(force) else "the next one came too soon"
        else:
            kept.append((begin, end, following))
            continue
        left_out.append((begin / rate, why))
    return kept, left_out


def _extent(size, start, apart):
    """(begin, end, whether struck twice) of the pulse of a force of this ``size`` (m,) whose rise passes ``start``."""
    first = max(start - apart, 0)
    part = size[first:start + apart]
    peak = start - first + int(part[start - first:].argmax())
    below = np.flatnonzero(part <= _PULSE * part[peak])
    begin = below[below < peak].max(initial=-1) + 1
    end = below[below > peak].min(initial=len(part))
    beside = np.concatenate((part[:begin], part[end:]))
    return first + begin, first + end, bool(beside.max(initial=0.0) > _TWICE * part[peak])


def _clipped(row, peak):
    """Whether a signal stays at the end of its range."""
    at_end = abs(row) >= peak * (1 - 1e-12)
    return peak > 0 and bool(np.any(np.convolve(at_end, np.ones(_CLIPPED, int), "valid") == _CLIPPED))


def _pulse(force, begin, end, size):
    """The force (size,) of a blow: zero beside its pulse."""
    cut = force[begin:begin + size].copy()
    cut[(end - begin) + _AFTER * max(end - begin, 2):] = 0.0
    return cut


def _decay(motions, rate):
    """Rate 1/s of the window that brings motions (b, n, m) to a small share at their ends, where they do not come."""
    size, power = motions.shape[-1], np.mean(motions**2, axis=(0, 1))
    most = power[:size // 4].max() if size >= 4 else power.max()
    left = np.sqrt(np.mean(power[-max(size // 20, 1):]) / max(most, 1e-300))
    return float(max(np.log(max(left, 1e-300) / _END), 0.0) * rate / size)


def from_motions(motion, references, rate, resolution=None):
    """Estimated from ``motion`` (n, m) alone: its correlations with the rows ``references`` [index].

    Sampled at ``rate`` [Hz]; lags up to 1 / ``resolution`` [Hz], by default and at most (ConfigError) a tenth of it.
    """
    count, resolution = motion.shape[1], resolution or _LONGER * rate / motion.shape[1]
    size = round(rate / resolution)
    if size < 2 or count < _LONGER * size:
        raise ConfigError("frequency response: resolution", f"ten times {1 / resolution:.3g} s or more",
                          f"{count / rate:.3g} s", "state a coarser resolution, or record for longer")
    motion = motion - motion.mean(axis=1, keepdims=True)
    length = scipy.fft.next_fast_len(count + size)
    spectrum = np.fft.rfft(motion, length)
    decay = float(np.log(1 / _END) * rate / size)
    window = np.exp(-decay * np.arange(size) / rate) / (count - np.arange(size))
    window[0] *= 0.5
    response = np.array([np.fft.rfft(np.fft.irfft(spectrum * spectrum[ref].conj(), length)[:, :size] * window) / rate
                         for ref in references])
    return Estimated(np.fft.rfftfreq(size, 1 / rate), np.swapaxes(response, 0, 1), None, count // size, decay)


def sense_of_phase(response):
    """(n,) of ``response`` (n, f) at even frequencies: 1 where it follows its force, -1 where it would precede it
    (phases of the opposite sign), 0 where it cannot be told, NaN where all values have one phase, as sizes alone have.

    Told by the inverse transform over the band, each response over its smoothed size: what comes before the force and
    what comes after it. Beside 0 s, where the ends of the band show, nothing counts.
    """
    response = np.asarray(response, complex)
    power = np.sum(abs(response) ** 2, axis=1)
    one_phase = abs(np.sum(response**2, axis=1)) >= (1.0 - _ONE_PHASE) * power
    count = response.shape[1]
    size = scipy.ndimage.uniform_filter1d(abs(response), max(count // _BROAD, 3))
    pulse = abs(np.fft.ifft(response / np.maximum(size, 1e-300) * np.hanning(count))) ** 2
    half = (count + 1) // 2
    after, before = pulse[:, _NEAR:half].sum(axis=1), pulse[:, count - half + 1:count - _NEAR + 1].sum(axis=1)
    sense = (after > _CLEARLY * before).astype(float) - (before > _CLEARLY * after)
    return np.where(one_phase & (power > 0.0), np.nan, sense)
