"""Evidence of hypotheses: Laplace's approximation in latent coordinates, and what left-out operating points say.

With r0 = r + J u the linearised residual at latent zero and weights W (N_eff/N of each run),

    ln Z = -1/2 (r0'W r0 - b'H^-1 b) - 1/2 ln det H,   H = I + J'W J,   b = J'W r0,

exact where the prediction is linear in Normal parameters, wherever it was linearised. Constants that all hypotheses
share are left out.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.inference.fitting.fit_state import from_prior_mean, whitened
from pipeline.inference.problem import operating_points
from pipeline.inference.regular import log_determinant, solved


@dataclass(frozen=True)
class Evidence:
    """``log_evidence``, and the log predictive density ``left_out`` (point,) of each point from the others."""

    log_evidence: float
    left_out: np.ndarray


def evidence(fit, weights=None):
    """Evidence of a Fit; ``weights`` (runs,) see ``effective.tempering``."""
    information, projection, power = _moments(fit, weights)
    return Evidence(_log_evidence(information.sum(axis=0), projection.sum(axis=0), power.sum()),
                    np.array([_left_out(information, projection, power, i) for i in range(len(power))]))


def reached(fit, weights=None):
    """Evidence of a Fit that has not converged: from what it has reached, not from what its linearisation promises."""
    linearised = evidence(fit, weights)
    weights = np.ones(len(fit.runs)) if weights is None else weights
    lost = weights @ fit.chi_square + fit.latent @ fit.latent
    log = -0.5 * lost - 0.5 * log_determinant(fit.precision(weights))
    return Evidence(min(float(log), linearised.log_evidence), linearised.left_out)


def screened(null_evidence, score, power):
    """ln Z of a candidate that was only screened: one Normal parameter of prior scale 1 along its direction.

    ln Z - ln Z_null = z^2 d^2 / (2 (1 + d^2)) - ln(1 + d^2) / 2 with score z (a negative one counts as 0) and power d.
    """
    square = np.asarray(power, float) ** 2
    score = np.maximum(score, 0.0)
    return null_evidence + 0.5 * score**2 * square / (1 + square) - 0.5 * np.log1p(square)


def posterior(log_evidence, prior=None):
    """Probabilities (n,) of hypotheses; ``prior`` (n,), default even."""
    log = np.asarray(log_evidence, float) + (0.0 if prior is None else np.log(prior))
    share = np.exp(log - log.max())
    return share / share.sum()


def cautious_prior(count):
    """Half for nothing missing, the other half shared by ``count`` candidates: more candidates cost each its share."""
    return np.concatenate(([0.5], np.full(count, 0.5 / max(count, 1))))


def family_wise(p_value, gain, count):
    """p-value over a catalogue of ``count`` candidates of one whose ln Z exceeds the null's by ``gain``.

    That of the screen, or what Markov's inequality says where that is less: if nothing is missing, the ratio of Z is t
    or more at most once in t times (V. Vovk, R. Wang, Ann. Statist. 49 (2021) 1736). A screen looks at a few shapes of
    an effect alone, and a tone may lie between them.
    """
    return float(min(p_value, count * np.exp(-max(gain, 0.0))))


def nested(problem, fit, sampler, weights=None):
    """ln Z with the forward model itself, for near ties: ``sampler(log_likelihood, transform, size)`` -> ln Z.

    ``log_likelihood`` takes latent coordinates (k,) of the Fit's hypothesis, ``transform`` maps the unit cube to them
    (the arguments of dynesty's NestedSampler). Comparable with ``evidence`` of the same weights.
    """
    weights = np.ones(len(fit.runs)) if weights is None else weights

    def log_likelihood(latent):
        residuals, _ = whitened(problem, fit.noises, fit.hypothesis, latent, fit.runs)
        if residuals is None:
            return -np.inf
        return -0.5 * sum(w * (r @ r) for w, r in zip(weights, residuals, strict=True))

    return sampler(log_likelihood, scipy.special.ndtri, len(fit.latent))


def _moments(fit, weights):
    """J'WJ (point, k, k), J'W r0 (point, k) and r0'W r0 (point,) of every operating point."""
    weights = np.ones(len(fit.runs)) if weights is None else weights
    start, moments = from_prior_mean(fit), []
    for indices in operating_points(fit.runs).values():
        moments.append((sum(weights[i] * fit.jacobians[i].T @ fit.jacobians[i] for i in indices),
                        sum(weights[i] * fit.jacobians[i].T @ start[i] for i in indices),
                        sum(weights[i] * start[i] @ start[i] for i in indices)))
    return tuple(np.array(m) for m in zip(*moments, strict=True))


def _log_evidence(information, projection, power):
    hessian = np.eye(len(projection)) + information
    return float(-0.5 * (power - projection @ solved(hessian, projection))
                 - 0.5 * log_determinant(hessian))


def _left_out(information, projection, power, point):
    """ln p(data of one point | data of the others) = ln Z of all less ln Z of the others."""
    others = np.arange(len(power)) != point
    size = projection.shape[1]
    rest = (information[others].sum(axis=0), projection[others].sum(axis=0), power[others].sum()) if others.any() else (
        np.zeros((size, size)), np.zeros(size), 0.0)
    return _log_evidence(information.sum(axis=0), projection.sum(axis=0), power.sum()) - _log_evidence(*rest)
