"""By how much two clocks differ: the offset at which two channels that show the same fit best."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.recordings.samples import with_gaps

#: most samples of a channel that are correlated; longer ones are averaged over longer intervals
_MOST = 1 << 21
#: rate in Hz of envelopes, least number of their samples
_SLOW, _FEW = 1000.0, 16
#: least correlation, and share of the largest that another offset may reach: beyond it both fit
_ALIKE, _OTHER = 0.5, 0.9
#: share of the shorter channel, and of the most power of either within it, that must overlap
_OVERLAP, _POWER = 0.2, 0.25
#: share of the largest correlation down to which offsets beside it belong to it
_LOBE = 0.7


@dataclass(frozen=True)
class Offset:
    """``offset`` in s that a clock is behind another, its standard deviation ``std``, and the ``correlation`` there;
    ``envelope``: of the envelopes of the signals."""

    offset: float
    std: float
    correlation: float
    envelope: bool


def offset_between(first, second, where):
    """Offset in s to add to the times of the Channel ``second`` so that it shows what ``first`` shows when it does.

    Largest correlation, over all offsets, of what both show where they overlap, at the lower of both rates: of the
    signals, and where these do not tell, of their envelopes; the place between samples is that of a parabola. Standard
    deviation: of the least squares fit of one to the other, and of an even distribution over one interval. Raises
    ConfigError, with ``where``, for channels that have too little in common, and for two offsets that fit alike.
    """
    rate = min(float(first.rate), float(second.rate), _MOST / max(_length(first), _length(second)))
    samples = [with_gaps(one) for one in (first, second)]
    found = _found(first, second, samples, rate, False)
    if isinstance(found, str):
        slow = min(rate, _SLOW)
        other = _found(first, second, [np.square(x - np.nanmean(x)) for x in samples], slow, True) if min(
            _length(first), _length(second)) * slow >= _FEW else found
        if isinstance(other, str):
            raise ConfigError(where, "two channels that show the same once, such as a knock or a pulse", found,
                              "name others under 'common', or state offset: SECONDS")
        return other
    return found


def _length(channel):
    return len(channel.samples) / float(channel.rate)


def _found(first, second, samples, rate, envelope):
    """The Offset of two signals, or why there is none in words."""
    a, b = (_averaged(x, float(one.rate), rate) for one, x in zip((first, second), samples, strict=True))
    if envelope:
        a, b = np.sqrt(a), np.sqrt(b)
    correlation, share, lag = _correlation(a, b)
    size, weighed = np.abs(correlation), np.abs(correlation) * share
    best, other = _climbed(size, int(weighed.argmax())), _beside(weighed, int(weighed.argmax()))
    if size[best] < _ALIKE:
        return f"a correlation of {size[best]:.2g}"
    begins = [float(one.begin) + 0.5 / rate - 0.5 / float(one.rate) for one in (first, second)]

    def offset(k):
        return float(begins[0] - begins[1] + (lag[k] + _vertex(size, k)) / rate)

    if weighed[other] > _OTHER * weighed.max():
        return f"two offsets that fit alike, {offset(best):.6g} s and {offset(other):.6g} s"
    return Offset(offset(best), _std(a, b, int(lag[best]), rate), float(correlation[best]), envelope)


def _averaged(samples, rate, lower):
    """Means (n,) of samples (sample,) at ``rate`` Hz over intervals of a ``lower`` rate, NaN where most are missing."""
    if lower > rate * (1 - 1e-9):
        return samples
    total = np.concatenate([[0.0], np.cumsum(np.nan_to_num(samples))])
    known = np.concatenate([[0.0], np.cumsum(np.isfinite(samples))])
    edge = np.arange(int(len(samples) * lower / rate) + 1) * rate / lower
    whole = np.arange(len(total))
    part, count = (np.diff(np.interp(edge, whole, x)) for x in (total, known))
    return np.where(count > 0.5 * rate / lower, part / np.maximum(count, 1e-9), np.nan)


def _correlation(a, b):
    """(correlation coefficients (lag,) of what overlaps, 0 where that is too little; share of the power of both that it
    holds, of the most at any lag; lags) of two signals with gaps.

    Padfield (2012), Masked object registration in the Fourier domain, IEEE Trans. Image Process. 21, 2706-2718.
    """
    known = [np.isfinite(x) for x in (a, b)]
    a, b = (np.where(k, x - np.nanmean(x), 0.0) for x, k in zip((a, b), known, strict=True))
    size = scipy.fft.next_fast_len(len(a) + len(b) - 1, real=True)
    of_a, of_b = ([scipy.fft.rfft(s, size) for s in (k.astype(float), x, x * x)]
                  for x, k in zip((a, b), known, strict=True))

    def summed(i, j):
        whole = scipy.fft.irfft(of_a[i] * of_b[j].conj(), size)
        return np.concatenate([whole[size - len(b) + 1:], whole[:len(a)]])

    count, sum_a, sum_b = np.maximum(np.rint(summed(0, 0)), 1.0), summed(1, 0), summed(0, 1)
    power = [np.maximum(summed(2, 0) - sum_a**2 / count, 0.0), np.maximum(summed(0, 2) - sum_b**2 / count, 0.0)]
    enough, share = count >= max(_OVERLAP * min(k.sum() for k in known), 3), 1.0
    for one in power:
        most = np.max(one, where=count >= 3, initial=1e-300)
        enough, share = enough & (one > _POWER * most), share * np.minimum(one / most, 1.0)
    shared = summed(1, 1) - sum_a * sum_b / count
    found = np.where(enough, shared / np.sqrt(np.where(enough, power[0] * power[1], 1.0)), 0.0)
    return found, np.sqrt(share), np.arange(1 - len(b), len(a))


def _climbed(size, k):
    """Index of the largest correlation that is reached uphill from the one at ``k``."""
    while 0 < k < len(size) - 1 and size[k] < (higher := max(size[k - 1], size[k + 1])):
        k += 1 if size[k + 1] == higher else -1
    return k


def _beside(size, best):
    """Index of the largest correlation beside the lobe of the best one."""
    low = np.flatnonzero(size < _LOBE * size[best])
    left, right = (int(low[low < best][-1]) if (low < best).any() else 0,
                   int(low[low > best][0]) if (low > best).any() else len(size))
    rest = size.copy()
    rest[left:right] = 0.0
    return int(rest.argmax())


def _vertex(size, k):
    """Place of the vertex of a parabola through three correlations, in lags from the middle one."""
    if not 0 < k < len(size) - 1 or not size[k - 1] or not size[k + 1]:
        return 0.0
    bend = size[k - 1] - 2 * size[k] + size[k + 1]
    return float(np.clip(0.5 * (size[k - 1] - size[k + 1]) / bend, -0.5, 0.5)) if bend < 0 else 0.0


def _std(a, b, lag, rate):
    """Standard deviation in s of an offset: of the fit of one signal to the other, and of one interval."""
    begin, end = max(lag, 0), min(len(a), lag + len(b))
    a, b = a[begin:end], b[begin - lag:end - lag]
    kept = np.isfinite(a) & np.isfinite(b)
    slope = np.gradient(a) if len(a) > 1 else np.zeros(len(a))
    columns = np.column_stack([a, np.ones(len(a)), slope])[kept & np.isfinite(slope)]
    b = b[kept & np.isfinite(slope)]
    fit, *_ = np.linalg.lstsq(columns, b, rcond=None)
    left = np.sum((b - columns @ fit) ** 2) / max(len(b) - 3, 1)
    moved = np.sum((fit[0] * columns[:, 2]) ** 2)
    return float(np.sqrt(left / max(moved, 1e-300) + 1.0 / 12.0) / rate)
