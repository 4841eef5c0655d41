"""Where effects that sound or resonate begin their fits: at the frequencies that stand out of what the null leaves.

What modulates a motion leaves the sums and differences of its frequency and those of the motion. Over frequency the fit
of a tone, or of a hidden resonance that hardly decays, has one narrow valley among many, as wide as a run is short;
amplitude and phase follow from two predictions a quarter of a turn apart, as the tone is linear in its cosine and sine,
those of a resonance from one.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy

from pipeline.inference.fitting.fit_state import from_prior_mean, orthogonal, whitened
from pipeline.inference.priors import LATENT_LIMIT
from pipeline.inference.regular import solved

#: frequencies that are tried, and how many of them a fit begins at
_TRIED, _BEGUN = 4, 2
#: ordinates of a spectrum for each that its length resolves
FINER = 4
#: peaks of the motion that a modulation is looked for beside, and frequencies of it that are tried at most
_BESIDE, _MODULATIONS = 3, 32
#: amplitude of the two predictions, in scales of its prior
_SMALL = 0.02


class Tone(NamedTuple):
    """Indices of the amplitude, frequency and phase among the parameters of an effect; no phase of a resonance. Its
    amplitude is a pure number where it ``modulates`` what is there."""

    amplitude: int
    frequency: int
    phase: int | None
    modulates: bool = False


def tone_of(candidate):
    """The Tone of a candidate's parameters, or None where it has none: one size, one frequency, one phase at most."""
    shapes = {candidate.parameters[k].unit: k for k in candidate.shaping}
    if len(candidate.sizes) != 1 or "Hz" not in shapes:
        return None
    amplitude = candidate.sizes[0]
    modulates = "rad" in shapes and candidate.parameters[amplitude].unit == "1"
    return Tone(amplitude, shapes["Hz"], shapes.get("rad"), modulates)


class Spectrum(NamedTuple):
    """Mean ``power`` (f,) of ``count`` whitened residuals over ``frequency`` (f,) [Hz], four ordinates to each resolved
    one."""

    frequency: np.ndarray
    power: np.ndarray
    count: int


def spectrum(fit, channel=""):
    """Spectrum of what a Fit leaves over all runs, of one ``channel`` or of all; None where samples have no order."""
    ordered = [(run.rate, part)
               for run, noise, white in zip(fit.runs, fit.noises, fit.residuals, strict=True)
               if noise.ordered and run.rate
               for name, part in zip(run.channels, noise.over_time(white), strict=True) if channel in ("", name)]
    if not ordered:
        return None
    length = max(len(part) / rate for rate, part in ordered)
    grid = np.arange(1, int(FINER * length * min(rate for rate, _ in ordered) / 2)) / (FINER * length)
    return Spectrum(grid, sum(_power(part, rate, grid) for rate, part in ordered) / len(ordered), len(ordered))


def standing_out(fit, count=_TRIED):
    """Frequencies (up to ``count``,) in Hz of the largest peaks in the spectrum of what a Fit leaves, over all runs,
    between its ordinates by a parabola."""
    return _peaks(spectrum(fit), count)


def _peaks(found, count):
    """The same of a Spectrum, or of None."""
    if found is None:
        return np.empty(0)
    grid, padded = found.frequency, np.concatenate(([0.0], found.power, [0.0]))
    peaks, _ = scipy.signal.find_peaks(padded, distance=FINER)
    peaks = peaks[np.argsort(-padded[peaks])[:count]]
    before, at, after = (padded[peaks + k] for k in (-1, 0, 1))
    return grid[peaks - 1] + (grid[1] - grid[0]) * 0.5 * (after - before) / np.maximum(2 * at - before - after, 1e-300)


def modulations(fit):
    """Frequencies (f,) in Hz at which what a Fit leaves may be the motion, modulated: sums and differences of their
    peaks, once each."""
    whole = replace(fit, residuals=tuple(noise.whiten(np.where(run.valid, run.samples, 0.0))
                                         for run, noise in zip(fit.runs, fit.noises, strict=True)))
    found = spectrum(fit)
    left, moved = _peaks(found, _TRIED), standing_out(whole, _BESIDE)
    if not (len(left) and len(moved)):
        return np.empty(0)
    width, longest = FINER * (found.frequency[1] - found.frequency[0]), found.frequency[-1]
    apart = np.concatenate([abs(left[:, None] - moved).ravel(), (left[:, None] + moved).ravel()])
    kept = []
    for frequency in apart:
        if width <= frequency <= longest and all(abs(frequency - other) > width / 2 for other in kept):
            kept.append(frequency)
    return np.array(kept[:_MODULATIONS])


def _power(part, rate, grid):
    size = 1 << int(np.ceil(np.log2(FINER * len(part))))
    return np.interp(grid, np.fft.rfftfreq(size, 1 / rate), np.abs(np.fft.rfft(part, size)) ** 2 / len(part))


def starts(problem, fit, candidate):
    """Latent values [(n + k,)], nominal ones first, of a tonal candidate at the frequencies that explain most of what a
    Fit leaves. The nominal values, and how runs begin, have made up for the tone as well as they can: they give way.
    """
    tone = tone_of(candidate)
    if tone is None:
        return []
    hypothesis, jacobian = problem.nominal.joined(candidate), np.concatenate(fit.jacobians)
    back = solved(jacobian.T @ jacobian + np.eye(len(fit.latent)), jacobian.T)
    base, start = np.concatenate(fit.residuals), np.concatenate(from_prior_mean(fit))
    ranked = []
    for frequency in modulations(fit) if tone.modulates else standing_out(fit):
        phases = (0.0,) if tone.phase is None else (0.0, np.pi / 2)
        waves = [_latent(candidate, tone, _SMALL, frequency, phase) for phase in phases]
        shown = [whitened(problem, fit.noises, hypothesis, np.concatenate((fit.latent, w)), fit.runs)[0] for w in waves]
        if any(seen is None for seen in shown):
            continue
        change = np.array([base - np.concatenate(seen) for seen in shown]).T
        clean = orthogonal(change, jacobian)
        parts = np.linalg.lstsq(change.T @ clean, clean.T @ start)[0]
        if tone.phase is None and parts[0] <= 0:        # no resonance of a negative size
            continue
        phase = np.arctan2(*parts[::-1]) if len(parts) > 1 else 0.0
        sounding = _latent(candidate, tone, _SMALL * np.linalg.norm(parts), frequency, phase)
        given_way = np.clip(back @ (start - change @ parts), -LATENT_LIMIT, LATENT_LIMIT)
        ranked.append((parts @ (clean.T @ start), np.concatenate((given_way, np.clip(sounding, -2, 2)))))
    return [latent for _, latent in sorted(ranked, key=lambda f: -f[0])[:_BEGUN]]


def _latent(candidate, tone, size, frequency, phase):
    """Latent values (k,) of a tone whose amplitude is ``size`` prior scales."""
    parameters, latent = candidate.parameters, np.zeros(len(candidate.parameters))
    for k, value in zip(tone[:3], (parameters[tone.amplitude].null + size * parameters[tone.amplitude].prior.scale,
                               frequency, phase), strict=True):
        if k is not None:
            latent[k] = parameters[k].prior.latent(value)
    return latent
