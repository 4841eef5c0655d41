"""The error budget: noise of a run, whitening, and the floor that no model can pass.

Noise is described by its autocovariance R_0 ... R_p per channel, solver error is added to it, and the prediction-error
filter of that order (Yule-Walker) whitens residuals: w_t = sum_k a_k r_(t-k) / s. Order 0 is white noise.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: order of the whitening filter where noise is not given as white
ORDER = 8


@dataclass(frozen=True)
class Noise:
    """Whitening of one run: ``filter`` (c, p + 1), already divided by the innovation's standard deviation.

    ``weight`` (c, n) divides further (noise that changes along the run); ``usable`` (c, n): samples whose whole filter
    lies on valid ones; ``std`` (c,) total standard deviation; ``ordered``: whether samples follow one another in time.
    """

    filter: np.ndarray
    weight: np.ndarray
    usable: np.ndarray
    std: np.ndarray
    ordered: bool

    @property
    def count(self):
        """Number of whitened samples."""
        return int(self.usable.sum())

    def whiten(self, residual):
        """(..., c, n) -> (..., m): channel after channel, unusable samples left out."""
        white = self.filter[:, :1] * residual
        for lag in range(1, self.filter.shape[1]):
            white[..., lag:] += self.filter[:, lag, None] * residual[..., :-lag]
        return (white / self.weight)[..., self.usable]

    @property
    def length(self):
        """Number of samples of which some channel is usable."""
        return int(self.usable.any(axis=0).sum())

    def horizon(self, share, fewest):
        """Number of samples from the begin of the run that hold this ``share`` of its usable ones, or ``fewest``."""
        counted = np.flatnonzero(self.usable.any(axis=0))
        if not len(counted):
            return self.usable.shape[1]
        return int(counted[min(max(int(share * len(counted)), fewest), len(counted)) - 1]) + 1

    def scaled(self, factor):
        """Noise ``factor`` times as large."""
        return replace(self, filter=self.filter / factor, std=self.std * factor)

    def until(self, kept):
        """The noise of the run cut to its first ``kept`` samples."""
        return replace(self, weight=self.weight[:, :kept], usable=self.usable[:, :kept])

    def beyond(self, first):
        """The noise of the samples from number ``first`` on alone."""
        return replace(self, usable=self.usable & (np.arange(self.usable.shape[1]) >= first))

    def by_channel(self, white):
        """The channels (m_c,) of a whitened residual (m,)."""
        return np.split(white, np.cumsum(self.usable.sum(axis=1))[:-1])

    def over_time(self, white):
        """A whitened residual (m,) where it belongs, (c, n), 0 where samples are not usable."""
        whole = np.zeros(self.usable.shape)
        whole[self.usable] = white
        return whole


def autocovariance(signal, valid, order):
    """R_0 ... R_order (c, order + 1) of (c, n) signals about zero; missing samples are left out."""
    clean, weight = np.where(valid, signal, 0.0), valid.astype(float)
    length = signal.shape[1]
    sums = [((clean[:, k:] * clean[:, :length - k]).sum(axis=1), (weight[:, k:] * weight[:, :length - k]).sum(axis=1))
            for k in range(order + 1)]
    pairs = np.array([n for _, n in sums]).T
    return np.array([s for s, _ in sums]).T / np.maximum(pairs[:, :1], 1)


def from_repeats(runs, order=ORDER):
    """Autocovariance (c, order + 1) of noise from runs (at least two, alike in shape) that repeat one another."""
    if len(runs) < 2 or len({run.samples.shape for run in runs}) > 1:
        raise ConfigError("noise from repeats", "two or more runs of the same length and channels",
                          ", ".join(f"{run.name} {run.samples.shape}" for run in runs))
    valid = np.all([run.valid for run in runs], axis=0)
    spread = [run.samples for run in runs] - np.mean([run.samples for run in runs], axis=0)
    return np.mean([autocovariance(s, valid, order) for s in spread], axis=0) * len(runs) / (len(runs) - 1)


def from_high_band(run, above):
    """Autocovariance (c, 1) of white noise whose density is that of the samples beyond ``above`` [Hz].

    Each channel is read in the longest stretch in which it lacks no sample.
    """
    if run.rate is None or not 0 < above < 0.5 * run.rate:
        raise ConfigError(f"run {run.name}: noise band", "a frequency below half the sample rate", f"{above:g} Hz")
    return np.array([[_beyond(run, k, above)] for k in range(len(run.channels))])


def _beyond(run, k, above):
    """Power of white noise of the density that channel ``k`` has beyond ``above`` [Hz]."""
    begin, end = _longest(run.valid[k])
    if (end - begin) * (0.5 * run.rate - above) < run.rate:
        raise ConfigError(f"run {run.name}: {run.channels[k]}",
                          f"samples without a gap to tell noise beyond {above:g} Hz", f"{end - begin} at most",
                          "give the noise, or repeats of the run")
    frequency, density = scipy.signal.periodogram(run.samples[k, begin:end], run.rate, "hann")
    return density[frequency > above].mean() * 0.5 * run.rate


def _longest(valid):
    """(begin, end) of the longest stretch of a mask (n,) that holds."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], valid.astype(int), [0])))).reshape(-1, 2)
    return max(edges.tolist(), key=lambda stretch: stretch[1] - stretch[0], default=(0, 0))


def from_density(density, rate, order=ORDER):
    """Autocovariance (c, order + 1) of a one-sided density (c, f) on the even grid from 0 to rate / 2."""
    covariance = np.fft.irfft(0.5 * np.asarray(density, float), axis=1) * rate
    return covariance[:, :order + 1]


def whitening(run, covariance, solver_error=None, weight=None):
    """Noise of ``run`` from autocovariance (c, p + 1), with that of a known solver error (c, n) added to it.

    ``weight`` (c, n): standard deviation relative to the covariance's. Raises ConfigError for noise of zero power.
    """
    covariance = np.array(covariance, dtype=float)
    if solver_error is not None:
        covariance = covariance + autocovariance(solver_error, run.valid, covariance.shape[1] - 1)
    if not (covariance[:, 0] > 0).all():
        raise ConfigError(f"run {run.name}: noise", "a positive power on every channel", "none",
                          "give the noise, repeats, or the resolution of the sensor")
    filters = np.array([_prediction_error_filter(channel) for channel in covariance])
    usable = run.valid.copy()
    for lag in range(1, covariance.shape[1]):
        usable[:, lag:] &= run.valid[:, :-lag]
        usable[:, :lag] = False
    weight = np.ones(run.samples.shape) if weight is None else np.asarray(weight, float)
    return Noise(filters, weight, usable, np.sqrt(covariance[:, 0] * np.mean(weight**2, axis=1)), run.rate is not None)


def budget(problem, solver_error=None, above=None, order=ORDER):
    """{run name: Noise}. Each run by the first that it has: given noise, repeats, the band above ``above`` [Hz], and
    last the repeats of other runs, whose noise then counts as its own.

    ``solver_error`` {run name: (c, n)}: what halving step and mesh changed in the prediction.
    """
    return {run.name: _noise_of(run, problem, (solver_error or {}).get(run.name), above, order) for run in problem.runs}


def normalised_error(run, residual):
    """NRMSE of (c, n): root mean over channels with samples of mean square residual over the channel's variance; 0
    where no channel has any."""
    return _normalised(run, _masked_mean(residual**2, run.valid))


def floor(run, noise):
    """The NRMSE that the true model would reach: noise alone."""
    return _normalised(run, noise.std**2)


def _normalised(run, power):
    variance = _variance(run)
    seen = run.valid.any(axis=1) & (variance > np.finfo(float).tiny)       # a channel of zeros has no size
    return float(np.sqrt(np.mean(power[seen] / variance[seen]))) if seen.any() else 0.0


def _variance(run):
    mean = _masked_mean(run.samples, run.valid)
    variance = _masked_mean((run.samples - mean[:, None]) ** 2, run.valid)
    return np.where(variance > 0, variance, np.maximum(mean**2, np.finfo(float).tiny))


def _masked_mean(values, valid):
    return (values * valid).sum(axis=1) / np.maximum(valid.sum(axis=1), 1)


def _prediction_error_filter(covariance):
    if len(covariance) == 1:
        return np.array([1 / np.sqrt(covariance[0])])
    column = covariance[:-1] * (1 + 1e-12 * (np.arange(len(covariance) - 1) == 0))
    predictor = scipy.linalg.solve_toeplitz(column, covariance[1:])
    innovation = covariance[0] - predictor @ covariance[1:]
    return np.concatenate(([1.0], -predictor)) / np.sqrt(innovation)


def _noise_of(run, problem, solver_error, above, order):
    if run.noise_std is not None:
        std = np.asarray(run.noise_std, float)
        if std.ndim == 2:
            return whitening(run, np.mean(std**2, axis=1, keepdims=True), solver_error,
                             std / np.sqrt(np.mean(std**2, axis=1, keepdims=True)))
        return whitening(run, std[:, None] ** 2 if solver_error is None else _padded(std**2, order), solver_error)
    if run.noise_psd is not None:
        return whitening(run, from_density(run.noise_psd, run.rate, order), solver_error)
    alike = [other for other in problem.runs if other.point == run.point and other.samples.shape == run.samples.shape
             and not (run.unlike or other.unlike)]
    if len(alike) > 1:
        return whitening(run, from_repeats(alike, order if run.rate else 0), solver_error)
    repeated = _repeated_elsewhere(problem, run)
    if above is None and repeated:
        order = order if run.rate else 0
        return whitening(run, np.mean([from_repeats(runs, order) for runs in repeated], axis=0), solver_error)
    if above is None:
        raise ConfigError(f"run {run.name}: noise", "a given noise, a repeat of any run, or a band of noise alone",
                          "none", "record a repeat or set the frequency above which there is only noise")
    return whitening(run, _padded(from_high_band(run, above)[:, 0], 0 if solver_error is None else order), solver_error)


def _repeated_elsewhere(problem, run):
    """[runs of one point] of other points that were repeated with the same channels at the same rate."""
    points = {}
    for other in problem.runs:
        if (other.channels, other.rate) == (run.channels, run.rate) and not other.unlike:
            points.setdefault((other.point, other.samples.shape), []).append(other)
    return [runs for runs in points.values() if len(runs) > 1]


def _padded(variance, order):
    return np.concatenate((variance[:, None], np.zeros((len(variance), order))), axis=1)
