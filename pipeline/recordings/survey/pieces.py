"""How one long record is cut into runs: at blows, by what repeats, or evenly. Proposals for the user to confirm."""

import numpy as np
import scipy

#: pieces of an even cut, most pieces, fewest samples of one, most samples of one
_EVEN, _MOST, _FEWEST, _LONGEST = 4, 6, 64, 8192
#: least autocorrelation of what repeats; rise of the envelope at a blow, and its share of the largest
_REPEATS, _RISE, _LOUD = 0.98, 3.0, 0.2


def pieces(values, free):
    """([(first, after last)], how) of a record of samples (n,); ``free``: nothing acts on the rig, as after blows."""
    values = np.nan_to_num(np.asarray(values, float) - np.nanmean(values))
    blows = _blows(values) if free else []
    if len(blows) > 1:
        ends = [*blows[1:], len(values)]
        return _bounded([(a, b) for a, b in zip(blows, ends, strict=True)], "one after each blow")
    if free:
        return [(0, len(values))], "whole"
    period = _period(values)
    if period:
        count = len(values) // period
        each = period * max(1, int(np.ceil(count / _MOST)))
        return _bounded([(k * each, (k + 1) * each) for k in range(len(values) // each)],
                        f"by what repeats every {period} samples")
    edges = np.linspace(0, len(values), _EVEN + 1).astype(int)
    spans = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
    return _bounded(spans, "equal parts") if len(values) >= _EVEN * _FEWEST else ([(0, len(values))], "whole")


def _bounded(spans, how):
    """Spans of a length that can be handled, the first of those that are too many."""
    long = any(b - a > _LONGEST for a, b in spans)
    kept = [(a, min(b, a + _LONGEST)) for a, b in spans[:_MOST] if b - a >= _FEWEST]
    return kept, how + (f", the first {_LONGEST} samples of each" if long else "")


def _period(values):
    """Samples after which the record repeats, None where it does not at least three times."""
    n, padded = len(values), scipy.fft.next_fast_len(2 * len(values))
    power = np.abs(np.fft.rfft(values, padded)) ** 2
    likeness = np.fft.irfft(power, padded)[:n]
    if not likeness[0] > 0:
        return None
    likeness = likeness / likeness[0] * (n / np.maximum(n - np.arange(n), 1))
    below = np.flatnonzero(likeness[:n // 3] < 0.5)
    if not len(below):
        return None
    first = int(below[0])
    lag = first + int(np.argmax(likeness[first:n // 3])) if n // 3 > first else 0
    return lag if lag >= _FEWEST and likeness[lag] > _REPEATS else None


def _blows(values):
    """First samples of the pieces behind blows: where the envelope rises by _RISE within a block."""
    size = max(len(values) // 200, 4)
    blocks = np.abs(values[:len(values) // size * size]).reshape(-1, size).max(axis=1)
    loud = _LOUD * blocks.max()
    starts = [k for k in range(len(blocks)) if blocks[k] > loud and (k == 0 or blocks[k] > _RISE * blocks[k - 1])]
    return [int(k * size + np.abs(values[k * size:(k + 1) * size]).argmax()) for k in starts]
