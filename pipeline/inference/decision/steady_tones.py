"""Steady tones in what a fit leaves: hum of the measurement, a source that is not declared, or a sustained vibration.

A periodogram of noise is exponentially distributed about its density, the mean over k channels and runs as
Gamma(k) / k. Its ordinates are compared with those about them, so that noise of any colour, and a broad resonance, hide
no tone and make none. A line counts where chance would show one as high, anywhere in the spectrum, once in a thousand
fits.
"""

from typing import NamedTuple

import numpy as np
import scipy

from pipeline.inference.fitting.tone_starts import FINER, spectrum

#: p-value of a line, over all ordinates together
_CHANCE = 1e-3
#: ordinates, in units of the resolution, between two lines, and on either side of one that tell the density about it
_APART, _FAR = 2, 14
#: lines that are told, strongest first
_MOST = 3
#: by how much of the resolution a multiple of the first line may be off it
_MULTIPLE = 0.3


class Tone(NamedTuple):
    """``frequency`` [Hz]; ``level``: power over that of the noise about it; ``channels`` in which it stands out."""

    frequency: float
    level: float
    channels: tuple


def steady_tones(fit):
    """[Tone] up to three of a Fit in the order of their levels, none of features."""
    whole = spectrum(fit)
    if whole is None:
        return []
    excess = _excess(whole)
    significant = _by_chance(excess, whole) < _CHANCE / max(len(excess) // FINER, 1)    # all that the length resolves
    peaks, _ = scipy.signal.find_peaks(np.concatenate(([0.0], np.where(significant, excess, 0.0), [0.0])),
                                       distance=_APART * FINER)
    peaks = peaks[np.argsort(-excess[peaks - 1])[:_MOST]] - 1
    own = _of_channels(fit) if len(peaks) else {}
    return [Tone(float(whole.frequency[k]), float(excess[k]), tuple(
        name for name, seen in own.items() if _shows(*seen, whole.frequency[k]))) for k in peaks]


def told(fit):
    """The same as a sentence, empty where there is none."""
    tones = steady_tones(fit)
    if not tones:
        return ""
    lowest, rest = min(tones), sorted(tones)[1:]
    width = 1 / max(run.samples.shape[1] / run.rate for run in fit.runs if run.rate)
    others = [f"{t.frequency:.4g} Hz" + _as_multiple(t.frequency, lowest.frequency, width) for t in rest]
    channels = ", ".join(dict.fromkeys(name for t in tones for name in t.channels))
    return (f"a steady tone at {lowest.frequency:.4g} Hz" + (f", and at {' and '.join(others)}," if others else "")
            + f" stands out of what is left{channels and f' in {channels}'}: hum of the measurement, a source that is"
            " not declared, or a vibration that sustains itself; a record at rest tells hum")


def _as_multiple(frequency, lowest, width):
    multiple = round(frequency / lowest)
    return f" ({multiple} times that)" if abs(frequency - multiple * lowest) < _MULTIPLE * multiple * width else ""


def _of_channels(fit):
    """{channel: (Spectrum, excess)} of the channels whose samples have an order."""
    names = dict.fromkeys(name for run in fit.runs for name in run.channels)
    parts = {name: part for name in names if (part := spectrum(fit, name)) is not None}
    return {name: (part, _excess(part)) for name, part in parts.items()}


def _excess(spectrum):
    """Power (f,) over the density about each ordinate: the median of those near it, corrected to a mean."""
    about = scipy.ndimage.median_filter(spectrum.power, 2 * _FAR * FINER + 1, mode="mirror")
    middle = scipy.stats.gamma.median(spectrum.count) / spectrum.count
    return spectrum.power / np.maximum(about / middle, np.finfo(float).tiny)


def _by_chance(excess, spectrum):
    """How often noise shows an ordinate as high as ``excess`` (f,) or one number."""
    return scipy.stats.gamma.sf(spectrum.count * excess, spectrum.count)


def _shows(spectrum, excess, frequency):
    """Whether a line at ``frequency`` [Hz] stands out of the spectrum of one channel."""
    near = np.abs(spectrum.frequency - frequency) <= FINER * (spectrum.frequency[1] - spectrum.frequency[0])
    return near.any() and bool(_by_chance(excess[near].max(), spectrum) < _CHANCE)
