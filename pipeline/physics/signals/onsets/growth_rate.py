"""Growth rate and frequency of a squeal from its onset, with their errors, and their mean over several stops.

Between the noise floor and a small fraction of the saturated amplitude a squeal is one unstable mode,

    y_c(t) = Re a_c exp(p t) + noise,     p = growth rate + i angular frequency.

The amplitudes in Hann frames are fitted by least squares, whitened by the correlation that overlapping frames give to
white noise. The fit includes what saturation takes first, a (1 - b |a|^2) exp(p t) with a complex b, whatever the law
(J. T. Stuart, J. Fluid Mech. 9 (1960) 353). Where the upper amplitudes still change p beyond noise, the
window ends earlier, or twice that change is taken as a further error.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.onsets.growth_trace import frame, frame_length, hop, traced

#: least growth in a window in powers of e, and fewest frames and periods
_GROWN, _FRAMES, _PERIODS = 1.5, 6, 10
#: level over the noise floor from which a window begins, and powers of e below its end, as fainter frames tell nothing
_ABOVE, _REACH = 4.0, 5.0
#: rounds of the fit; error of p over what leaving out the upper half of the amplitudes changes
_ROUNDS, _REST = 40, 2.0
#: halvings of the interval in which the spread of stops lies
_HALVINGS = 60
#: how often the upper end of a window is halved, to see whether growth is free there with a smaller error
_NARROWER = 4
#: changes within so many standard deviations are noise
_BENT = 3.0


@dataclass(frozen=True)
class Growth:
    """Free growth between ``begin`` and ``end`` s: ``root`` p in rad/s, ``std`` of either part (noise and bend of the
    logarithm together), ``bend`` its share of that, ``shape`` (c,) complex amplitudes at ``end``, ``grown`` in powers
    of e, ``saturates`` whether the record shows the end of the growth."""

    root: complex
    std: float
    bend: float
    shape: np.ndarray
    begin: float
    end: float
    grown: float
    saturates: bool


@dataclass(frozen=True)
class Stops:
    """Mean ``root`` rad/s of several growths, its ``std`` of either part, ``spread`` of single stops beyond their own
    errors, ``shape`` (c,) of unit size, ``count`` of stops."""

    root: complex
    std: float
    spread: float
    shape: np.ndarray
    count: int


def growth(samples, rate, low, high, share=0.2):
    """Growth of the squeal in samples (c, n) at ``rate`` Hz, between ``low`` and ``high`` Hz, up to the fraction
    ``share`` of its saturated amplitude, or up to the smaller one whose error is least.

    Raises ConfigError where no window lies between noise floor and saturation, or one too short to be judged.
    """
    trace = traced(samples, rate, low, high)
    for _ in range(2):                      # frames as long as the growth allows: those of the first look are short
        begin, end = _window(trace, share)
        first = _fitted(trace, slice(begin, end))
        trace = traced(samples, rate, low, high, frame_length(first.root.real))
    windows = [_judged(trace, share)]
    for _ in range(_NARROWER):
        share = share / 2
        try:
            windows.append(_judged(trace, share))
        except ConfigError:                 # no window that narrow
            break
    return min(windows, key=lambda result: result.std)


def mean(growths, spread=0.0):
    """Stops of [Growth] at one operating point, of which single ones spread by ``spread`` rad/s in either part beyond
    their own errors."""
    root, own = np.array([g.root for g in growths]), np.array([g.std for g in growths])
    weight = 1 / (own**2 + spread**2)
    shapes = np.array([g.shape / np.linalg.norm(g.shape) for g in growths])
    turned = np.array([np.exp(-1j * np.angle(shapes[0].conj() @ shape)) for shape in shapes])
    shape = (weight * turned) @ shapes
    return Stops(complex(weight @ root / weight.sum()), float(weight.sum() ** -0.5), float(spread),
                 shape / np.linalg.norm(shape), len(root))


def spread_of(points):
    """Standard deviation in rad/s by which single stops spread beyond their own errors, from [[Growth]] of several
    operating points together, as few stops at each tell little: the larger one of growth rate and angular frequency; 0
    where no point has two stops.
    """
    groups = [(np.array([g.root for g in point]), np.array([g.std for g in point])) for point in points
              if len(point) > 1]
    parts = ([(part(root), own) for root, own in groups] for part in (np.real, np.imag))
    return max(map(_spread, parts)) if groups else 0.0


def _spread(groups):
    """Spread of numbers [(values (m,), their own errors (m,))] about the means of their groups: so large that their
    deviations are as large as errors and spread together (R. C. Paule, J. Mandel, J. Res. Nat. Bur. Standards 87 (1982)
    377)."""
    def excess(square):
        total = 0.0
        for value, own in groups:
            weight = 1 / (own**2 + square)
            total += weight @ (value - weight @ value / weight.sum()) ** 2 - (len(value) - 1)
        return total

    if excess(0.0) <= 0:
        return 0.0
    low, high = 0.0, sum(np.ptp(value) ** 2 for value, _ in groups)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if excess(middle) > 0 else (low, middle)
    return float(np.sqrt(high))


@dataclass(frozen=True)
class _Fit:
    root: complex
    std: float
    amplitude: np.ndarray


def _judged(trace, share):
    """Growth of a Trace up to the fraction ``share`` of its saturated amplitude."""
    begin, end = _window(trace, share)
    whole, level = _fitted(trace, slice(begin, end)), trace.level
    lower = begin + int(np.searchsorted(np.maximum.accumulate(level[begin:end]), level[end - 1] / 2))
    bend = _bend(whole, _fitted(trace, slice(begin, lower))) if lower - begin >= _FRAMES else 0.0
    loud = trace.time[end:][level[end:] >= 0.9 * level.max()]
    saturates = bool(loud.size and (trace.time[-1] - loud[0]) * whole.root.real > 1)
    return Growth(whole.root, float(np.hypot(whole.std, bend)), bend, whole.amplitude, float(trace.time[begin]),
                  float(trace.time[end - 1]), float(np.log(level[end - 1] / level[begin])), saturates)


def _window(trace, share):
    """(first, after the last) frame of the free growth; ConfigError where there is none to judge."""
    level = trace.level
    limit = share * trace.largest
    if limit < _ABOVE * np.exp(_GROWN):
        needed = _ABOVE * np.exp(_GROWN) / share
        raise ConfigError("onset", f"a squeal that outgrows the noise floor {needed:.0f} times",
                          f"{trace.largest:.3g} times at {trace.frequency:.4g} Hz",
                          "record from before the squeal begins, with less noise")
    end = int(np.argmax(level >= limit))
    below = np.flatnonzero(level[:end] < max(_ABOVE, limit * np.exp(-_REACH)))
    begin = int(below[-1] + 1) if below.size else 0
    grown = np.log(level[end - 1] / level[begin]) if end > begin else 0.0
    periods = (trace.time[end - 1] - trace.time[begin]) * trace.frequency if end > begin else 0.0
    if not below.size:
        raise ConfigError("onset", "a record that begins in quiet", f"one {level[0]:.3g} times above its quietest"
                          " stretch", "record from before the squeal begins")
    if end - begin < _FRAMES or grown < _GROWN or periods < _PERIODS:
        raise ConfigError("onset", f"{_FRAMES} frames, {_PERIODS} periods and a growth by e^{_GROWN:g} between noise"
                          " floor and saturation", f"{end - begin} frames, {periods:.0f} periods and e^{grown:.2g}",
                          "less noise, or a smaller disturbance at the begin")
    return begin, end


def _fitted(trace, frames):
    """_Fit of the frames of a Trace by one exponential that begins to saturate: Gauss-Newton, amplitudes eliminated."""
    time = trace.time[frames]
    whiten = _whitening(len(time), trace.size)
    data = whiten @ (trace.amplitude[:, frames] / trace.floor[:, None]).T
    since = time - time[-1]
    rate, bent = np.polyfit(since, np.log(trace.level[frames]), 1)[0] + 0j, 0j
    for _ in range(_ROUNDS):
        free = np.exp(rate * since)
        beside = abs(free) ** 2                             # what saturation takes, in proportion to the power
        wave = whiten @ (free * (1 - bent * beside))
        amplitude = wave.conj() @ data / np.vdot(wave, wave).real
        left = data - np.outer(wave, amplitude)
        slope = whiten @ np.column_stack((since * free * (1 - bent * beside), -free * beside))
        slope = slope - np.outer(wave, wave.conj() @ slope) / np.vdot(wave, wave).real
        square = slope.conj().T @ slope * np.vdot(amplitude, amplitude).real
        step = np.linalg.solve(square, slope.conj().T @ left @ amplitude.conj())
        rate, bent = rate + step[0], bent + step[1]
        if abs(step[0]) < 1e-9 * 2 * np.pi * trace.frequency:
            break
    else:
        raise ConfigError("onset", f"an exponential within {_ROUNDS} rounds", f"a step of {abs(step[0]):.3g} 1/s")
    noise = np.sum(abs(left) ** 2) / max(left.size - left.shape[1] - 2, 1)
    variance = noise * np.linalg.inv(square)[0, 0].real / 2
    turned = np.exp(2j * np.pi * trace.frequency * time[-1])
    return _Fit(rate + 2j * np.pi * trace.frequency, float(np.sqrt(variance)), amplitude * trace.floor * turned)


def _whitening(count, size):
    """(count, count) inverse root of the correlation of white noise in overlapping frames of ``size`` samples."""
    window, step = frame(size), hop(size)
    lags = np.array([window[:size - k * step] @ window[k * step:] if k * step < size else 0.0 for k in range(count)])
    between = abs(np.subtract.outer(np.arange(count), np.arange(count)))
    return np.linalg.inv(np.linalg.cholesky(lags[between] / lags[0]))


def _bend(whole, lower):
    """Error in rad/s by which a fit of the lower amplitudes differs from that of the whole window, beyond noise."""
    apart = lower.root - whole.root
    noise = _BENT**2 * max(lower.std**2 - whole.std**2, 0.0)
    return _REST * float(np.sqrt(max(max(apart.real**2, apart.imag**2) - noise, 0.0)))
