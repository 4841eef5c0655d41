"""How much of a whitened residual counts: effective samples, weights of runs, and what is certainly not noise."""

import numpy as np


def effective_share(noise, white, power=2):
    """N_eff / N of a whitened residual (m,), for sums of its squares.

    N_eff = N / (1 + 2 sum_k (1 - k/N) rho_k^2), from var(sum r^2) of a correlated Gaussian series (Bartlett, J. R.
    Stat. Soc. B 8 (1946) 27); correlations below the universal threshold sqrt(2 ln N / N), widened by
    the same factor (their own spread), count as none. Channels add.

    ``power`` 1, with |rho_k|: for sums of the residual along a motion, whatever its frequency; the density of noise is
    1 + 2 sum_k rho_k cos(k w) times that of white noise.
    """
    if not noise.ordered:
        return 1.0
    parts = [part for part in noise.by_channel(white) if len(part)]
    return sum(_effective_count(part, power) for part in parts) / sum(len(part) for part in parts)


def tempering(noises, whites):
    """Weights (runs,) of the runs' log-likelihoods: N_eff/N along a motion, less where the residual exceeds its noise.

    ``whites`` are the residuals of the best model at hand; what it leaves counts as noise of unknown origin.
    """
    return np.array([effective_share(noise, white, 1) / max(1.0, np.mean(white**2))
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
    return length / (1 + 2 * np.sum(fade * kept**power))
