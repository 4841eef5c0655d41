"""How much of a whitened residual counts: effective samples, weights of runs, and what is certainly not noise."""

import numpy as np


def effective_share(noise, white):
    """N_eff / N of a whitened residual (m,), for sums of its squares.

    N_eff = N / (1 + 2 sum_k (1 - k/N) rho_k^2), from var(sum r^2) of a correlated Gaussian series (Bartlett, J. R.
    Stat. Soc. B 8 (1946) 27); correlations below the universal threshold sqrt(2 ln N / N), widened by
    the same factor (their own spread), count as none. Channels add.
    """
    if not noise.ordered:
        return 1.0
    parts = [part for part in noise.by_channel(white) if len(part)]
    return sum(_effective_count(part) for part in parts) / sum(len(part) for part in parts)


def tempering(noises, whites):
    """Weights (runs,) of the runs' log-likelihoods: N_eff/N, less where the residual exceeds its noise.

    ``whites`` are the residuals of the best model at hand; what it leaves counts as noise of unknown origin.
    """
    return np.array([effective_share(noise, white) / max(1.0, np.mean(white**2))
                     for noise, white in zip(noises, whites, strict=True)])


def coherent_energy(noise, white, level=1.0, chance=1e-3):
    """Energy of a whitened residual (m,) in frequencies that noise of power ``level`` does not explain.

    The sum of periodogram ordinates beyond the largest that white noise shows with probability 1 - ``chance`` in any of
    them (each is exponential), less their expectation. Robust to a wrong noise level; samples without order: squares.
    """
    parts = noise.by_channel(white) if noise.ordered else [white]
    total = sum(len(p) for p in parts)
    if not noise.ordered:
        bound, power = 2 * np.log(2 * max(total, 1) / chance), white**2
    else:
        power = np.concatenate([np.abs(np.fft.rfft(p)[1:(len(p) + 1) // 2]) ** 2 / max(len(p), 1) for p in parts])
        bound = np.log(max(len(power), 1) / chance)
    found = power[power > level * bound] - level
    return float(found.sum() * (2 if noise.ordered else 1))


def _effective_count(series):
    length = len(series)
    spectrum = np.abs(np.fft.rfft(series, 2 * length)) ** 2
    covariance = np.fft.irfft(spectrum)[:length]
    if not covariance[0] > 0:
        return length
    square, spread = (covariance[1:] / covariance[0]) ** 2, 1.0
    for _ in range(2):
        kept = np.where(square < spread * 2 * np.log(length) / length, 0.0, square)
        spread = 1 + 2 * np.sum((1 - np.arange(1, length) / length) * kept)
    return length / spread
