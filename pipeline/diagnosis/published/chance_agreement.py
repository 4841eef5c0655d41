"""How much the agreement of two lists of lines says: assignment, and how often lines at random would agree as well."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract import ConfigError

DRAWS = 20000


@dataclass(frozen=True)
class Match:
    """Of measured lines against those of a model.

    ``matched``: measured lines within their tolerance of a model line, which several may share; ``p_value``: how often
    as many lines at random in the band match as well; ``gain``: ln of the density of the measured lines under the
    model over that of lines anywhere in the band.
    """

    matched: int
    p_value: float
    gain: float


def assigned(measured, model):
    """Index (n,) into ``model`` [Hz] of the partner of each ``measured`` line [Hz], each model line at most once.

    Smallest sum of logarithmic frequency ratios; -1 without a partner (fewer model lines than measured ones).
    """
    measured, model = np.asarray(measured, float), np.asarray(model, float)
    partner = np.full(len(measured), -1)
    rows, columns = scipy.optimize.linear_sum_assignment(np.abs(np.log(measured[:, None] / model)))
    partner[rows] = columns
    return partner


def chance(share, count):
    """Probability that at least one of ``count`` independent lines at random falls on a ``share`` of the band."""
    return 1 - (1 - min(share, 1.0)) ** count


def covered(model, tolerance, band):
    """Share of ``band`` (low, high) within ``tolerance`` of one of the ``model`` lines; all in one unit."""
    low, high = band
    edges = np.sort(np.asarray(model, float))
    begin, end = np.clip(edges - tolerance, low, high), np.clip(edges + tolerance, low, high)
    begin = np.maximum(begin, np.concatenate(([low], np.maximum.accumulate(end)[:-1]))) if len(edges) else begin
    return float(np.maximum(end - begin, 0.0).sum() / (high - low))


def match(measured, tolerance, model, band, draws=DRAWS, seed=0):
    """Match of ``measured`` lines (n,) with ``tolerance`` (n,) against ``model`` lines (k,) in ``band``, Hz.

    The density under the model: each measured line belongs to any line of the model alike, with a normal error of half
    its tolerance; that of random lines is even over the band.
    """
    low, high = band
    measured, tolerance = np.asarray(measured, float), np.asarray(tolerance, float)
    if not low < high or np.any((measured < low) | (measured > high)):
        raise ConfigError("line match: band", "a band that holds the measured lines", f"{low:g} to {high:g} Hz")
    model = np.asarray(model, float)
    model = model[(model > low - tolerance.max()) & (model < high + tolerance.max())]
    if not len(model):
        return Match(0, 1.0, -np.inf)
    drawn = np.random.default_rng(seed).uniform(low, high, (draws, len(measured)))
    matched = _matched(measured[None], tolerance, model)[0]
    reached = np.count_nonzero(_matched(drawn, tolerance, model) >= matched)
    std = tolerance / 2
    density = np.exp(-0.5 * ((measured[:, None] - model) / std[:, None]) ** 2).mean(axis=1) / (std * np.sqrt(2 * np.pi))
    gain = float(np.sum(np.log(np.maximum(density, np.finfo(float).tiny) * (high - low))))
    return Match(int(matched), float((1 + reached) / (1 + draws)), gain)


def _matched(lines, tolerance, model):
    """Number (d,) of the lines (d, n) within tolerance of the nearest model line."""
    ordered = np.sort(model)
    index = np.searchsorted(ordered, lines)
    left = np.abs(lines - ordered[np.maximum(index - 1, 0)])
    right = np.abs(ordered[np.minimum(index, len(ordered) - 1)] - lines)
    return np.count_nonzero(np.minimum(left, right) <= tolerance, axis=1)
