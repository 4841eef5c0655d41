"""Unknown physics: a smoothed latent force, and what it depends on.

The force is a Gaussian process with Matern-3/2 covariance s^2 (1 + |t|/l) exp(-|t|/l), seen with white noise; as a
two-state linear system its posterior follows from a Kalman filter and Rauch-Tung-Striebel smoother in one pass each
(Hartikainen & Sarkka, IEEE MLSP 2010). What it depends on is tested against circular shifts of the force, which keep
its own correlation.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.compiled import njit

DRAWS = 999
#: smallest and largest size of a force and of its noise, in standard deviations of the residual
_SPREADS = 1e-4, 1e2


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
    """LatentForce with the hyperparameters of the largest likelihood. Raises ConvergenceError where none is found.

    No length far beyond that of the record is tried: such a force is constant or straight over it.
    """
    residual = np.asarray(residual, float)
    valid = np.ones(len(residual), bool) if valid is None else valid
    spread = residual[valid].std()
    if not spread > 0:
        raise ConvergenceError("latent force", "a residual that varies", "a constant one")

    def loss(log):
        size, length, noise = np.exp(log)
        return -_filtered(residual, valid, 1 / rate, size, length, noise)[-1]

    starts = [np.log([spread, samples / rate, 0.3 * spread]) for samples in (3, 30, 300)]
    sizes = [share * spread for share in _SPREADS]
    bounds = np.log([sizes, [0.3 / rate, max(len(residual), 1000) / rate], sizes])
    options = {"xatol": 1e-3, "fatol": 1e-3, "maxiter": 600}
    fits = (scipy.optimize.minimize(loss, s, method="Nelder-Mead", bounds=bounds, options=options) for s in starts)
    best = min(fits, key=lambda fit: fit.fun)
    if not best.success:
        raise ConvergenceError("latent force: hyperparameters", "convergence in 600 steps", best.message)
    return smooth(residual, rate, *(float(x) for x in np.exp(best.x)), valid)


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


@njit
def _filtered(residual, valid, step, size, length, noise):
    """Before and after each sample (n, 5): force, rate, covariance (p, q), (q, r); the transition, log likelihood."""
    n, decay = len(residual), 1 / length
    factor = np.exp(-decay * step)
    move = factor * np.array([[1 + decay * step, step], [-(decay**2) * step, 1 - decay * step]])
    (a, b), (c, d) = move
    before, after = np.zeros((n, 5)), np.zeros((n, 5))
    top, bottom = size**2, (size * decay) ** 2      # of the stationary covariance, which is diagonal
    drive_0 = top - (a * a * top + b * b * bottom)
    drive_01 = -(a * c * top + b * d * bottom)
    drive_1 = bottom - (c * c * top + d * d * bottom)
    force, rate, p, q, r, log = 0.0, 0.0, top, 0.0, bottom, 0.0
    for i in range(n):      # written out: small arrays cost more than their numbers
        if i > 0:
            force, rate = a * force + b * rate, c * force + d * rate
            p, q, r = (a * a * p + 2 * a * b * q + b * b * r + drive_0, a * c * p + (a * d + b * c) * q + b * d * r
                       + drive_01, c * c * p + 2 * c * d * q + d * d * r + drive_1)
        before[i] = force, rate, p, q, r
        if valid[i]:
            variance = p + noise**2
            gap = residual[i] - force
            log -= 0.5 * (np.log(2 * np.pi * variance) + gap**2 / variance)
            force, rate = force + p / variance * gap, rate + q / variance * gap
            p, q, r = p - p * p / variance, q - p * q / variance, r - q * q / variance
        after[i] = force, rate, p, q, r
    return before, after, move, log


@njit
def _smoothed(residual, valid, step, size, length, noise):
    """Posterior mean and variance (n,) of the force, and the log likelihood of the record."""
    before, after, move, log = _filtered(residual, valid, step, size, length, noise)
    mean, covariance = after[-1, :2].copy(), _covariance(after[-1])
    means, variances = after[:, 0].copy(), after[:, 2].copy()
    for i in range(len(residual) - 2, -1, -1):
        back = _covariance(after[i]) @ move.T @ np.linalg.inv(_covariance(before[i + 1]))
        mean = after[i, :2] + back @ (mean - before[i + 1, :2])
        covariance = _covariance(after[i]) + back @ (covariance - _covariance(before[i + 1])) @ back.T
        means[i], variances[i] = mean[0], covariance[0, 0]
    return means, variances, log


@njit
def _covariance(row):
    return np.array([[row[2], row[3]], [row[3], row[4]]])
