"""Poles of free vibration from records: sums of growing and decaying sines, c channels with the same poles.

    y_c(t) = Re sum_k a_ck exp(p_k t) + noise,     p = growth rate + i angular frequency

A record is shifted to 0 Hz band by band, filtered and thinned; every band is a sum of few exponentials, found by the
matrix pencil (Y. Hua, T. K. Sarkar, IEEE Trans. ASSP 38 (1990) 814) and refined by least squares (Gauss-Newton, the
amplitudes eliminated), whose Jacobian gives the standard deviations. Where a record grows it is divided by its growth
first, so that its end, where saturation begins, counts no more than its begin.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: width of a band in Hz, taps of its filter per rate / width, most poles in a band
_WIDTH, _TAPS, _MOST = 800.0, 6, 14
#: parameter of the filters' Kaiser window: 140 dB down where thinning folds
_KAISER = 14.0
#: singular values of noise stay below this times their median
_ABOVE_NOISE = 4.0
#: a pole counts where its standard deviation is below this share of its frequency
_KNOWN = 2e-3
#: growth or decay over the length of the filter of a band, beside what grows, beyond which little of a motion is left,
#: in powers of e
_FASTEST = 2.0
_ITERATIONS = 12
#: how close to the sum of two others, of which one grows, a pole is a combination tone of them, as a share of its root
_TONE = 1e-3
#: the same where both decay, in standard deviations
_AGREES = 3.0
#: how much later a record begins to be asked again, in lengths of the filter of a band
_LATER = 1 / 3
#: poles that begin fainter than this share of the loudest in every channel are distortion that grew from nothing
_FAINT = 5e-3
#: longest window of the pencil in samples
_LONGEST_PENCIL = 120


@dataclass(frozen=True)
class Poles:
    """``root`` (p,) rad/s, by rising frequency; ``std`` (p,) rad/s of its real and of its imaginary part; ``shape``
    (p, c): amplitudes of the channels."""

    root: np.ndarray
    std: np.ndarray
    shape: np.ndarray

    def of(self, index):
        """The poles ``index``."""
        return Poles(self.root[index], self.std[index], self.shape[index])


def poles(samples, rate, low, high, count=None):
    """Poles between ``low`` and ``high`` Hz of samples (c, n) at ``rate`` Hz, of the first ``count`` samples alone.

    Raises ConfigError for a band beyond the sampling and for records too short to tell poles of one band apart.
    """
    if not 0 < low < high < 0.5 * rate:
        raise ConfigError("poles: band", f"0 < low < high < {0.5 * rate:g} Hz", f"{low:g} to {high:g} Hz")
    edges = _edges(low, high)
    bands = [_band(samples[:, :count], rate, *both) for both in zip(edges[:-1], edges[1:], strict=True)]
    whole = Poles(*(np.concatenate(parts) for parts in zip(*((f.root, f.std, f.shape) for f in bands), strict=True)))
    whole = whole.of(np.argsort(whole.root.imag))
    return whole.of(_loudness(whole.shape) > _FAINT)


def steady_poles(samples, rate, low, high, count=None):
    """The ``poles`` that the record shows also where it begins later, none known better than the two agree.

    What fades within the filter of a band stands on few samples, beside others that fade faster and are not told.
    Records too short to begin later show what they show.
    """
    shown = samples[:, :count]
    identified = poles(shown, rate, low, high)
    late = round(_LATER * _TAPS * rate / np.diff(_edges(low, high))[0])
    try:
        later = poles(shown[:, min(late, shown.shape[1] - 1):], rate, low, high)
    except ConfigError:
        return identified
    pairs = matched(identified, later)
    kept, again = identified.of([i for i, _ in pairs]), later.of([j for _, j in pairs])
    return replace(kept, std=np.maximum(kept.std, abs(kept.root - again.root) / 2))


def _edges(low, high):
    """Edges (bands + 1,) in Hz of bands of even width."""
    return np.linspace(low, high, max(1, round((high - low) / _WIDTH)) + 1)


def _loudness(shape):
    """Largest share (p,) of the loudest pole of a channel that each pole of amplitudes (p, c) begins with."""
    size = abs(shape)
    return np.max(size / np.maximum(size.max(axis=0, initial=0.0), 1e-300), axis=1, initial=0.0)


def before_saturation(samples, rate, share=0.12, interval=2e-3):
    """Number of samples after the begin of (c, n) until the running effective value of a growing channel last passes
    ``share`` of its largest; all of them where none outgrows its tap (the first tenth) by more than 1 / ``share``."""
    size = max(1, round(interval * rate))
    blocks = samples[:, :samples.shape[1] // size * size].reshape(len(samples), -1, size)
    level = np.sqrt(np.mean(blocks**2, axis=2))
    first = samples.shape[1]
    for row in level:
        limit = share * row.max()
        if row[:max(1, len(row) // 10)].max() < limit:
            first = min(first, size * int(np.flatnonzero(row[:row.argmax()] < limit)[-1] + 1))
    return first


def likeness(first, second):
    """Modal assurance criterion (p, q) of shapes (p, c) and (q, c); 0 for a shape of zeros."""
    size = np.outer(np.sum(abs(first) ** 2, axis=1), np.sum(abs(second) ** 2, axis=1))
    return abs(first.conj() @ second.T) ** 2 / np.maximum(size, 1e-300)


def matched(first, second, within=0.008, alike=0.8):
    """[(i, j)] of two Poles that are the same: frequencies within the share ``within``, likeness above ``alike``."""
    apart = abs(np.subtract.outer(first.root.imag, second.root.imag)) / first.root.imag[:, None]
    same = likeness(first.shape, second.shape)
    cost = np.where((apart < within) & (same > alike), apart / within + (1 - same), 1e3)
    pairs = zip(*scipy.optimize.linear_sum_assignment(cost), strict=True)
    return [(int(i), int(j)) for i, j in pairs if cost[i, j] < 1e3]


def confirmed(first, second):
    """Mean of the Poles seen in two records; others are dropped.

    Its standard deviation is that of the mean, or half the difference where the two differ by more than theirs.
    """
    pairs = matched(first, second)
    one, other = first.of([i for i, _ in pairs]), second.of([j for _, j in pairs])
    weight = 1 / one.std**2, 1 / other.std**2
    total = weight[0] + weight[1]
    turned = np.sum(one.shape.conj() * other.shape, axis=1)     # shapes brought to one size and phase
    turned = turned / np.maximum(np.sum(abs(other.shape) ** 2, axis=1), 1e-300)
    return Poles((weight[0] * one.root + weight[1] * other.root) / total,
                 np.maximum(1 / np.sqrt(total), abs(one.root - other.root) / 2),
                 one.shape + turned.conj()[:, None] * other.shape)


def fundamental(found):
    """The Poles without combination tones: sums p_i + p_j and p_i + p_j*, which a law that is not linear makes of two.

    With one that grows, amplitudes are no longer small. Of two that decay, a fainter pole is the tone where it agrees
    with their sum in frequency and decay, as well as these are known.
    """
    i, j = np.triu_indices(len(found.root))
    tone = np.concatenate((found.root[i] + found.root[j], found.root[i] + found.root[j].conj()))
    tone = np.where(tone.imag < 0, tone.conj(), tone)
    grows, std = (found.root.real[i] > 0) | (found.root.real[j] > 0), np.hypot(found.std[i], found.std[j])
    loud = _loudness(found.shape)
    fainter = np.less.outer(loud, np.tile(np.minimum(loud[i], loud[j]), 2))
    apart = abs(np.subtract.outer(found.root, tone))
    same = fainter & (apart <= _AGREES * np.hypot.outer(found.std, np.tile(std, 2)))
    near = apart <= _TONE * abs(found.root)[:, None]
    return found.of(~np.where(np.tile(grows, 2), near, same).any(axis=1))


def _band(samples, rate, low, high):
    """Poles of one band."""
    width = high - low
    thin = max(1, int(rate / (2.4 * width)))
    taps = int(_TAPS * rate / width) | 1
    middle = np.pi * (low + high)
    time = np.arange(samples.shape[1]) / rate
    low_pass = scipy.signal.firwin(taps, width, window=("kaiser", _KAISER), fs=rate)
    shifted = scipy.signal.lfilter(low_pass, [1.0], samples * np.exp(-1j * middle * time))
    signal = shifted[:, taps:][:, ::thin]
    if signal.shape[1] < 12:
        raise ConfigError("poles", f"records of at least {(taps + 12 * thin) / rate:.3g} s", f"{time[-1]:.3g} s",
                          "tap more gently, or record longer")
    interval = thin / rate
    growth = _growth(signal, interval)          # what saturates is in proportion to the level: it must not outweigh
    signal = signal * np.exp(-growth * interval * np.arange(signal.shape[1]))
    scale = np.sqrt(np.mean(abs(signal) ** 2, axis=1))
    seen = scale > 0
    root = _pencil(signal[seen] / scale[seen, None], interval)
    if not len(root):
        return Poles(root, np.empty(0), np.empty((0, len(samples)), complex))
    for _ in range(2):                          # once more, weighted with the noise that the first round left
        root, amplitude, left, std = _refined(signal[seen] / scale[seen, None], interval, root)
        scale[seen] *= np.maximum(left, 1e-12)
    shape = np.zeros((len(root), len(samples)), complex)
    shape[:, seen] = amplitude * (scale[seen] / np.maximum(left, 1e-12))
    told = Poles(root + growth + 1j * middle, std, shape)
    inside = abs(root.imag) <= 0.5 * 2 * np.pi * width
    fast = abs(root.real) * taps / rate > _FASTEST
    return told.of(inside & ~fast & (std < _KNOWN * told.root.imag))


def _growth(signal, interval):
    """Rate [1/s] at which complex signals (c, n) outgrow their first tenth, 0 where they do not."""
    power = np.mean(abs(signal) ** 2 / np.maximum(np.mean(abs(signal) ** 2, axis=1, keepdims=True), 1e-300), axis=0)
    size = max(1, len(power) // 10)
    first, last = power[:size].mean(), power[-size:].mean()
    return 0.5 * float(np.log(last / first)) / (interval * (len(power) - size)) if last > first > 0 else 0.0


def _pencil(signal, interval):
    """Roots (p,) of the exponentials in complex signals (c, n), by the matrix pencil."""
    count = signal.shape[1]
    length = min(count // 3, _LONGEST_PENCIL)
    rows = np.array([signal[:, k:count - length + k].ravel() for k in range(length + 1)])
    square, left = np.linalg.eigh(rows @ rows.conj().T)
    size, left = np.sqrt(np.maximum(square[::-1], 0.0)), left[:, ::-1]
    order = int(np.clip(np.sum(size > _ABOVE_NOISE * np.median(size)), 1, min(_MOST, length - 1)))
    ratio = np.linalg.eigvals(np.linalg.lstsq(left[:-1, :order], left[1:, :order], rcond=None)[0])
    return np.log(ratio[abs(ratio) > 1e-6]) / interval


def _refined(signal, interval, root):
    """(root, amplitude (p, c), residual (c,), std (p,)) by Gauss-Newton from ``root``."""
    time = interval * np.arange(signal.shape[1])
    best = _fitted(signal, time, root)
    for _ in range(_ITERATIONS):
        step = np.linalg.pinv(best[3].conj().T @ best[3], hermitian=True) @ (best[3].conj().T @ best[4])
        longest = max(abs(step).max() / (2 * np.pi * 5.0), 1.0)
        for shorter in (1.0, 0.25, 0.05):
            moved = _fitted(signal, time, best[0] + shorter * step / longest)
            if moved[2] < best[2]:
                break
        else:
            break
        gained, best = best[2] - moved[2], moved
        if gained < 1e-9 * best[2]:
            break
    root, amplitude, _, jacobian, residual = best
    square = np.sum(abs(residual) ** 2) / max(residual.size - jacobian.shape[1] - amplitude.size, 1)
    spread = np.real(np.diag(np.linalg.pinv(jacobian.conj().T @ jacobian, hermitian=True)))
    left = np.sqrt(np.mean(abs(residual.reshape(signal.shape)) ** 2, axis=1))
    return root, amplitude, left, np.sqrt(square * np.maximum(spread, 0.0) / 2)


def _fitted(signal, time, root):
    """(root, amplitude (p, c), sum of squares, Jacobian (c n, p), residual (c n,)) with the amplitudes fitted."""
    waves = np.exp(np.clip(np.outer(time, root.real), -50, 50) + 1j * np.outer(time, root.imag))
    size = np.linalg.norm(waves, axis=0)
    basis, triangle = np.linalg.qr(waves / size)
    amplitude = np.linalg.lstsq(triangle, basis.conj().T @ signal.T, rcond=1e-12)[0] / size[:, None]
    residual = signal.T - waves @ amplitude
    slope = time[:, None] * waves
    slope = slope - basis @ (basis.conj().T @ slope)
    jacobian = np.einsum("tp,pc->ctp", slope, amplitude).reshape(-1, len(root))
    return root, amplitude, float(np.sum(abs(residual) ** 2)), jacobian, residual.T.ravel()
