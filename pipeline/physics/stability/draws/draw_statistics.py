"""Draws of a scattered system, and what they say: rates with intervals, frequency bands, first-order sensitivities."""

import numpy as np
import scipy

#: fewest draws of a bin of the first-order index, and most bins
_PER_BIN, _MOST_BINS = 20, 20
_RESAMPLES = 200
#: standard deviations to each side of 95 % of a normal distribution
_SIDES = scipy.special.ndtri(0.975)
#: least probability that a score stands for
_LEAST = 1e-9
#: fewest draws of each coefficient of a regression
_PER_COEFFICIENT = 5


def even_scores(count, sources, seed):
    """(count, sources) scores, each source standard normal: quasi-random draws, which fill the space more evenly than
    independent ones (A. B. Owen's scrambling of Sobol's sequence, J. Complexity 14 (1998) 466). The first of more draws
    are those of fewer."""
    if not count or not sources:
        return np.empty((count, sources))
    sequence = scipy.stats.qmc.Sobol(sources, scramble=True, rng=np.random.default_rng(seed))
    share = sequence.random_base2(max(count - 1, 1).bit_length())[:count]
    return scipy.special.ndtri(np.clip(share, _LEAST, 1 - _LEAST))


def explained(scores, hits):
    """Share of the variance of ``hits`` (n,) that is linear in ``scores`` (n, s), adjusted for the number of sources.

    Draws of ``even_scores`` do not leave that share of a rate to chance; it is that of n / (1 - share) independent
    draws, or closer. 0 for few draws, or hits that do not vary.
    """
    hits, (count, sources) = np.asarray(hits, float), np.shape(scores)
    if count < _PER_COEFFICIENT * (sources + 1) or not np.ptp(hits) > 0:
        return 0.0
    terms = np.column_stack((np.ones(count), scores))
    left = hits - terms @ np.linalg.lstsq(terms, hits, rcond=None)[0]
    return max(1 - (left @ left / (count - sources - 1)) / hits.var(ddof=1), 0.0)


def rate_interval(hits, count, share=0.0):
    """(low, high) of the 95 % interval of a rate (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209); ``share`` of its
    variance as of ``explained``."""
    if not count:
        return 0.0, 1.0
    rate, alike = hits / count, count / (1 - share)
    middle, half = (rate + _SIDES**2 / (2 * alike)) / (1 + _SIDES**2 / alike), _half_width(rate, alike)
    return max(float(middle - half), 0.0), min(float(middle + half), 1.0)


def _half_width(rate, count):
    return _SIDES * np.sqrt(rate * (1 - rate) / count + (_SIDES / (2 * count)) ** 2) / (1 + _SIDES**2 / count)


def draws_needed(hits, count, within, share=0.0):
    """Least number of draws, no less than the ``count`` (above 0) that had so many ``hits``, at which half the width of
    the 95 % interval of the same rate is no more than ``within`` (above 0); ``share`` as of ``rate_interval``."""
    more = np.arange(count, count + int((_SIDES / within) ** 2) + 2)
    return int(more[np.argmax(_half_width(hits / count, more / (1 - share)) <= within)])


def rate_change(before, after, paired):
    """(change, (low, high)) of a rate: that of hits ``after`` (m,) less that of hits ``before`` (n,), 95 % interval.

    ``paired``: the draws of both are the same ones, m = n. Squares of the distances to the ends of the Wilson intervals
    add up, less what paired hits have in common (R. G. Newcombe, Stat. Med. 17 (1998) 873 and 2635, method 10).
    """
    first, second = (np.asarray(hits, bool) for hits in (before, after))
    if not len(first) or not len(second):
        return 0.0, (-1.0, 1.0)
    rates = first.mean(), second.mean()
    (low, high), (other_low, other_high) = (rate_interval(hits.sum(), len(hits)) for hits in (first, second))
    common = _correlation(first, second) if paired else 0.0
    change, ends = rates[1] - rates[0], []
    for own, other in ((rates[1] - other_low, high - rates[0]), (other_high - rates[1], rates[0] - low)):
        ends.append(np.sqrt(max(own**2 - 2 * common * own * other + other**2, 0.0)))
    return float(change), (float(change - ends[0]), float(change + ends[1]))


def _correlation(first, second):
    """Correlation of paired hits, a positive one with the correction for continuity."""
    count, both = len(first), np.sum(first & second)
    neither, one, other = np.sum(~first & ~second), np.sum(first & ~second), np.sum(~first & second)
    sizes = float(first.sum()) * float((~first).sum()) * float(second.sum()) * float((~second).sum())
    excess = float(both) * float(neither) - float(one) * float(other)
    excess = max(excess - count / 2, 0.0) if excess > 0 else excess
    return excess / np.sqrt(sizes) if sizes else 0.0


def third_octaves(low, high):
    """Middles (b,) Hz of the 1/3 octave bands that hold ``low`` to ``high`` Hz: 1 kHz times 10^(n/10) (IEC 61260)."""
    first, last = (int(np.round(10 * np.log10(f / 1e3))) for f in (low, high))
    return 1e3 * 10 ** (np.arange(first, last + 1) / 10)


def band_of(frequency, middles):
    """Index (k,) of the band of each ``frequency`` (k,) Hz among ``middles`` (b,) of ``third_octaves``."""
    return np.round(10 * np.log10(np.asarray(frequency) / middles[0])).astype(int)


def among_bands(root, middles):
    """Index (k,) of the band of each ``root`` (k,) 1/s among ``middles`` (b,); of those beyond, the outermost."""
    return np.clip(band_of(abs(np.asarray(root)) / (2 * np.pi), middles), 0, len(middles) - 1)


def squealing(root, draw, operating, shape, squeal_from):
    """``shape`` (draw, operating point): whether one of the unstable roots (k,) 1/s lies there and is no lower than
    ``squeal_from`` Hz; ``draw`` (k,) and ``operating`` (k,) say where each is."""
    hits, high = np.zeros(shape, bool), abs(root) >= 2 * np.pi * squeal_from
    hits[draw[high], operating[high]] = True
    return hits


def first_order(values, outcome, seed):
    """(index (s,), standard error (s,), rank correlation (s,)) of ``outcome`` (n,) over sources ``values`` (n, s).

    The first-order Sobol index Var(E[y | x]) / Var(y) from given draws: y averaged in bins of equally many x, freed of
    the bias by the number of bins (adjusted R^2 of the bins); its error by bootstrap (Plischke, Borgonovo & Smith, Eur.
    J. Oper. Res. 226 (2013) 536). All 0 for an outcome that does not vary.
    """
    values, outcome = np.asarray(values, float), np.asarray(outcome, float)
    count, sources = values.shape
    if count < 2 * _PER_BIN or not np.ptp(outcome) > 0:
        return np.zeros((3, sources))
    rng = np.random.default_rng(seed)
    picks = rng.integers(0, count, (_RESAMPLES, count))
    result = np.zeros((3, sources))
    for k, x in enumerate(values.T):
        if np.ptp(x) > 0:
            again = [_binned(x[pick], outcome[pick]) for pick in picks]
            result[:, k] = _binned(x, outcome), np.std(again), scipy.stats.spearmanr(x, outcome).statistic
    return result


def _binned(x, y):
    """Adjusted share of the variance of y between bins of x; not below 0."""
    bins = min(len(x) // _PER_BIN, _MOST_BINS)
    parts = np.array_split(y[np.argsort(x, kind="stable")], bins)
    within, total = sum(((part - part.mean()) ** 2).sum() for part in parts), ((y - y.mean()) ** 2).sum()
    return max(1 - (len(x) - 1) / (len(x) - bins) * within / total, 0.0) if total > 0 else 0.0
