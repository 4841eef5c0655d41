"""How much of a whitened residual counts: effective samples, weights of runs, and what is certainly not noise."""

import numpy as np

#: the first few correlations, and standard deviations beyond which each of them counts
_FIRST, _FAINT = 3, 2.0


def effective_share(noise, white, power=2):
    """N_eff / N of a whitened residual (m,), for sums of its squares.

    N_eff = N / (1 + 2 sum_k (1 - k/N) rho_k^2), from var(sum r^2) of a correlated Gaussian series (Bartlett, J. R.
    Stat. Soc. B 8 (1946) 27); correlations below the universal threshold sqrt(2 ln N / N), widened by
    the same factor (their own spread), count as none. Channels add.

    ``power`` 1, with |rho_k|: for sums of the residual along a motion, whatever its frequency; the density of noise is
    1 + 2 sum_k rho_k cos(k w) times that of white noise. There the first few correlations count from two of their
    standard deviations on: weak autocorrelation appears at the shortest lags.
    """
    if not noise.ordered:
        return 1.0
    parts = [part for part in noise.by_channel(white) if len(part)]
    if not parts:
        return 1.0
    return sum(_effective_count(part, power) for part in parts) / sum(len(part) for part in parts)


def tempering(noises, whites):
    """Weights (runs,) of the runs' log-likelihoods: N_eff/N along a motion, less where the residual exceeds its noise.

    ``whites`` are the residuals of the best model at hand; what it leaves counts as noise of unknown origin.
    """
    return np.array([effective_share(noise, white, 1) / max(1.0, np.mean(white**2) if len(white) else 1.0)
                     for noise, white in zip(noises, whites, strict=True)])


def doubt(count, uncertainty):
    """Squared error beyond that of ``count`` samples of noise which noise may have: its scatter, and that of its power.

    ``uncertainty``: relative one of the power; two standard deviations of chi^2.
    """
    return uncertainty * count + 2 * np.sqrt(2 * count)


def coherent_energy(noise, white, level=1.0, chance=1e-3):
    """Energy of a whitened residual (m,) in frequencies that noise of power ``level`` does not explain.

    The sum of periodogram ordinates beyond the largest that noise shows with probability 1 - ``chance`` in any of
    them (each is exponential), less their expectation. Robust to a wrong noise level, and to noise whose samples are
    correlated with the next ones by rho: its density is at most (1 + |rho|) / (1 - |rho|) times that of white noise.
    Samples without order: squares.
    """
    parts = noise.by_channel(white) if noise.ordered else [white]
    total = sum(len(p) for p in parts)
    if not noise.ordered:
        bound, power, levels = 2 * np.log(2 * max(total, 1) / chance), white**2, level
    else:
        power = [np.abs(np.fft.rfft(p)[1:(len(p) + 1) // 2]) ** 2 / max(len(p), 1) for p in parts]
        levels = np.concatenate([np.full(len(part), level * _density(p)) for part, p in zip(power, parts, strict=True)])
        power = np.concatenate(power)
        bound = np.log(max(len(power), 1) / chance)
    coherent = np.where(power > levels * bound, power - levels, 0.0)
    return float(coherent.sum() * (2 if noise.ordered else 1))


def _density(series):
    """Largest density of noise that is correlated as a series is with its next samples, over that of white noise."""
    size = series @ series
    rho = min(abs(series[1:] @ series[:-1]) / size, 0.5) if size > 0 else 0.0
    return (1 + rho) / (1 - rho) if rho**2 * len(series) > _FAINT**2 else 1.0


def _effective_count(series, power):
    length = len(series)
    spectrum = np.abs(np.fft.rfft(series, 2 * length)) ** 2
    covariance = np.fft.irfft(spectrum)[:length]
    if not covariance[0] > 0:
        return length
    size, spread, fade = np.abs(covariance[1:] / covariance[0]), 1.0, 1 - np.arange(1, length) / length
    for _ in range(2):
        kept = np.where(size**2 < spread * 2 * np.log(length) / length, 0.0, size)
        spread = 1 + 2 * np.sum(fade * kept**2)
    if power == 1:
        first = slice(0, _FIRST)
        kept[first] = np.where(size[first] ** 2 * length > _FAINT**2 * spread, size[first], 0.0)
    return length / (1 + 2 * np.sum(fade * kept**power))
