"""Unknown physics: a smoothed latent force, and what it depends on.

The force is a Gaussian process with Matern-3/2 covariance s^2 (1 + |t|/l) exp(-|t|/l), seen with white noise; as a
two-state linear system its posterior follows from a Kalman filter and Rauch-Tung-Striebel smoother in one pass each
(Hartikainen & Sarkka, IEEE MLSP 2010). What it depends on is tested against circular shifts of the force, which keep
its own correlation.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.optimize import minimize

from pipeline.contract.errors import ConvergenceError

DRAWS = 999


@dataclass(frozen=True)
class LatentForce:
    """``mean``, ``std`` (n,) of the force; ``size``, ``length`` [s] of its covariance; ``noise`` of the record."""

    mean: np.ndarray
    std: np.ndarray
    size: float
    length: float
    noise: float
    log_likelihood: float


def smooth(residual, rate, size, length, noise, valid=None):
    """LatentForce of a residual force (n,) at ``rate`` [Hz], hyperparameters given; missing samples are bridged."""
    valid = np.ones(len(residual), bool) if valid is None else valid
    mean, variance, log = _smoothed(np.asarray(residual, float), valid, 1 / rate, size, length, noise)
    return LatentForce(mean, np.sqrt(np.maximum(variance, 0.0)), size, length, noise, log)


def latent_force(residual, rate, valid=None):
    """LatentForce with the hyperparameters of the largest likelihood. Raises ConvergenceError where none is found."""
    residual = np.asarray(residual, float)
    valid = np.ones(len(residual), bool) if valid is None else valid
    spread = residual[valid].std()
    if not spread > 0:
        raise ConvergenceError("latent force", "a residual that varies", "a constant one")

    def loss(log):
        size, length, noise = np.exp(log)
        try:
            return -_smoothed(residual, valid, 1 / rate, size, length, noise)[2]
        except np.linalg.LinAlgError:     # a force so smooth that its two states are one number
            return np.inf

    starts = [np.log([spread, samples / rate, 0.3 * spread]) for samples in (3, 30, 300)]
    options = {"xatol": 1e-3, "fatol": 1e-3, "maxiter": 600}
    found = min((minimize(loss, s, method="Nelder-Mead", options=options) for s in starts), key=lambda r: r.fun)
    if not found.success:
        raise ConvergenceError("latent force: hyperparameters", "convergence in 600 steps", found.message)
    return smooth(residual, rate, *(float(x) for x in np.exp(found.x)), valid)


@dataclass(frozen=True)
class Dependence:
    """On one regressor: the ``share`` of the force's variance that a curve over it explains, and its ``p_value``.

    ``centre`` and ``curve`` (b,): mean force in bins of equal count.
    """

    name: str
    share: float
    p_value: float
    centre: np.ndarray
    curve: np.ndarray


def dependence(name, force, regressor, bins=16, draws=DRAWS, seed=0):
    """Dependence of a force (n,) on a regressor (n,): amplitude, sliding speed, displacement, temperature, ..."""
    edges = np.quantile(regressor, np.linspace(0, 1, bins + 1)[1:-1])
    index = np.searchsorted(edges, regressor, side="right")
    count = np.maximum(np.bincount(index, minlength=bins), 1)
    shift = np.concatenate(([0], _shifts(len(force), draws, seed)))
    centred = force - force.mean()
    spectrum = np.fft.rfft(centred)
    explained = np.zeros(len(force))
    for b in range(bins):
        sums = np.fft.irfft(np.conj(np.fft.rfft((index == b).astype(float))) * spectrum, len(force))
        explained += sums**2 / count[b]
    share = explained[shift] / max(centred @ centred, 1e-300)
    curve = np.bincount(index, force, bins) / count
    centre = np.bincount(index, regressor, bins) / count
    return Dependence(name, float(share[0]), _p_value(share), centre, curve)


def order_locked(force, angle, orders=6, draws=DRAWS, seed=0):
    """(share, p-value) of a force (n,) in the first ``orders`` harmonics of a rotation ``angle`` (n,) [rad]."""
    table = np.concatenate([[np.cos(k * angle), np.sin(k * angle)] for k in range(1, orders + 1)])
    return _explained_by(force, table, draws, seed)


def slow_drift(force, degree=3, draws=DRAWS, seed=0):
    """(share, p-value) of the slow change of a force's size: log power of stretches on a polynomial in time.

    Null by permutation of the stretches (32), which are taken as independent.
    """
    power = np.array([np.log(np.mean(s**2) + 1e-300) for s in np.array_split(np.asarray(force, float), 32)])
    frame = np.linalg.qr(np.polynomial.legendre.legvander(np.linspace(-1, 1, 32), degree))[0][:, 1:]
    centred, generator = power - power.mean(), np.random.default_rng(seed)
    orders = [np.arange(32), *(generator.permutation(32) for _ in range(draws))]
    share = np.array([np.sum((frame.T @ centred[o]) ** 2) for o in orders]) / max(centred @ centred, 1e-300)
    return float(share[0]), _p_value(share)


def loop_area(force, displacement):
    """Work per sample stretch, the integral of force over displacement: the area of its loops [J]."""
    return float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(displacement)))


@dataclass(frozen=True)
class Memory:
    """Loop area per cycle as frequency goes to zero (``static``, its ``std``) and its growth with frequency.

    A static part that is not zero is memory or dry friction; pure growth is viscous.
    """

    static: float
    std: float
    growth: float

    @property
    def present(self):
        return abs(self.static) > 3 * self.std


def memory(frequency, area, std):
    """Memory from loop areas per cycle (n,) with standard errors (n,) at frequencies (n,) and one amplitude."""
    frequency, weight = np.asarray(frequency, float), 1 / np.asarray(std, float)
    table = np.column_stack((weight, weight * frequency))
    covariance = np.linalg.inv(table.T @ table)
    static, growth = covariance @ table.T @ (weight * np.asarray(area, float))
    return Memory(float(static), float(np.sqrt(covariance[0, 0])), float(growth))


def _explained_by(force, table, draws, seed):
    """Share of the variance of a force in the row space of ``table`` (r, n), against circular shifts."""
    frame = np.linalg.qr((table - table.mean(axis=1, keepdims=True)).T)[0]
    centred = force - np.mean(force)
    spectra = np.conj(np.fft.rfft(frame, axis=0)) * np.fft.rfft(centred)[:, None]
    all_shifts = np.sum(np.fft.irfft(spectra, len(force), axis=0) ** 2, axis=1) / max(centred @ centred, 1e-300)
    share = all_shifts[np.concatenate(([0], _shifts(len(force), draws, seed)))]
    return float(share[0]), _p_value(share)


def _shifts(length, draws, seed):
    return np.random.default_rng(seed).integers(1, length, draws)


def _p_value(share):
    """Of the first entry among all."""
    return float(np.mean(share >= share[0] * (1 - 1e-12)))


@njit(cache=True)
def _smoothed(residual, valid, step, size, length, noise):
    """Posterior mean and variance (n,) of the force, and the log likelihood of the record."""
    n, decay = len(residual), 1 / length
    factor = np.exp(-decay * step)
    move = factor * np.array([[1 + decay * step, step], [-(decay**2) * step, 1 - decay * step]])
    stationary = np.array([[size**2, 0.0], [0.0, (size * decay) ** 2]])
    drive = stationary - move @ stationary @ move.T
    means, covariances = np.zeros((n, 2)), np.zeros((n, 2, 2))
    ahead_means, ahead = np.zeros((n, 2)), np.zeros((n, 2, 2))
    mean, covariance, log = np.zeros(2), stationary.copy(), 0.0
    for i in range(n):
        if i > 0:
            mean, covariance = move @ mean, move @ covariance @ move.T + drive
        ahead_means[i], ahead[i] = mean, covariance
        if valid[i]:
            variance = covariance[0, 0] + noise**2
            gap, gain = residual[i] - mean[0], covariance[:, 0] / variance
            log -= 0.5 * (np.log(2 * np.pi * variance) + gap**2 / variance)
            mean = mean + gain * gap
            covariance = covariance - np.outer(gain, gain) * variance
        means[i], covariances[i] = mean, covariance
    for i in range(n - 2, -1, -1):
        back = covariances[i] @ move.T @ np.linalg.inv(ahead[i + 1])
        means[i] = means[i] + back @ (means[i + 1] - ahead_means[i + 1])
        covariances[i] = covariances[i] + back @ (covariances[i + 1] - ahead[i + 1]) @ back.T
    return means[:, 0].copy(), covariances[:, 0, 0].copy(), log
