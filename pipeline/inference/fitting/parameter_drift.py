"""Drift of fitted values over operating points: a wrong value is one constant shift, missing physics drifts.

    Q = sum_i (theta_i - mean)' C_i^-1 (theta_i - mean),   C_i^-1 = J_i'W J_i,

with theta_i the values that run i alone asks for, linearised about the joint fit. Directions that a run cannot see add
nothing to Q. The null of Q is drawn from the same linear model, prior included.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.inference.problem import operating_points
from pipeline.inference.regular import inverse, solved

DRAWS = 4000
#: probability below which all are alike: 37 standard deviations
_RAREST = 1e-300


@dataclass(frozen=True)
class Drift:
    """``shift`` and ``std`` (point, k): latent values that each point alone asks for, against the joint fit.

    ``statistic`` Q and its ``p_value`` under constant parameters; ``freedom``: degrees of freedom of Q.
    """

    points: tuple
    names: tuple
    shift: np.ndarray
    std: np.ndarray
    statistic: float
    p_value: float
    freedom: int


def drift(fit, weights=None, draws=DRAWS, seed=0):
    """Drift test of a Fit; ``weights`` (runs,) of the runs (see ``effective.tempering``)."""
    information, score = by_point(fit, weights)
    joint = np.eye(len(fit.latent)) + information.sum(axis=0)
    inverse = np.array([np.linalg.pinv(a, rcond=1e-9, hermitian=True) for a in information])
    statistic = float(_statistic(score, inverse))
    null = _null(information, inverse, joint, draws, np.random.default_rng(seed))
    freedom = sum(_rank(a) for a in information) - _rank(information.sum(axis=0))
    shift, std = _own_values(information, score)
    rare = (1 + np.sum(null >= statistic)) / (1 + draws) if freedom else 1.0      # one point differs from no other
    return Drift(tuple(operating_points(fit.runs)), tuple(p.name for p in fit.hypothesis.parameters), shift, std,
                 statistic, rare, freedom)


def _by_run(fit, weights):
    """Information J'WJ (run, k, k) and score J'W r (run, k) of every run."""
    weights = np.ones(len(fit.runs)) if weights is None else weights
    return (np.array([w * j.T @ j for w, j in zip(weights, fit.jacobians, strict=True)]),
            np.array([w * j.T @ r for w, j, r in zip(weights, fit.jacobians, fit.residuals, strict=True)]))


def _seen(information, score):
    """(value, std) of one parameter for every run that sees it, about the joint fit."""
    seen = information > 1.0
    return score[seen] / information[seen], 1 / np.sqrt(information[seen])


def _beyond_noise(groups):
    """Standard deviation of values within ``groups`` [(value (n,), std (n,))] beyond that of each."""
    square = freedom = size = 0.0
    for value, std in groups:
        if len(value) > 1:
            weight = std**-2.0
            square += np.sum(weight * (value - np.average(value, weights=weight))**2)
            freedom += len(value) - 1
            size += weight.sum() - np.sum(weight**2) / weight.sum()
    return float(np.sqrt(max(square - freedom, 0.0) / size)) if size > 0 else 0.0


def _with_scatter(seen, scatter, std):
    """Standard deviation of a value whose runs (``seen``) scatter, ``std`` without that."""
    each = seen[1]
    if not scatter or len(each) < 2:
        return std
    return std * np.sqrt(np.sum(each**-2.0) / np.sum(1 / (each**2 + scatter**2)))


def _between_repeats(fit, index, weights):
    """What the values of one parameter differ by, beyond noise, between runs of one operating point."""
    information, score = _reduced(*_by_run(fit, weights), index)
    return _beyond_noise([_seen(information[rows], score[rows]) for rows in operating_points(fit.runs).values()])


def by_point(fit, weights=None):
    """Information J'WJ (point, k, k) and score J'W r (point, k) of every operating point at the fit."""
    points = operating_points(fit.runs).values()
    information, score = (np.array([sum(each[i] for i in indices) for indices in points])
                          for each in _by_run(fit, weights))
    return information, score


def scatter(fit, weights=None):
    """(scatter (k,) of latent values between runs beyond noise, standard deviation (k,) of the joint ones with it).

    Each run asks for a value of its own, the other parameters free under their priors; what their differences exceed
    noise by is how far the law itself is off from run to run: random effects, with the variance of R. DerSimonian,
    N. Laird, Control. Clin. Trials 7 (1986) 177. Values that fewer than two runs see have the scatter 0.
    """
    alone, own = _by_run(fit, weights), np.sqrt(np.diag(fit.covariance(weights)))
    seen = [_seen(*_reduced(*alone, k)) for k in range(len(own))]
    found = np.array([_beyond_noise([each]) for each in seen]).reshape(-1)
    return found, np.array([_with_scatter(*each) for each in zip(seen, found, own, strict=True)])


def spread(fit, weights=None):
    """{name: standard deviation} of the values of a Fit, noise and their ``scatter`` between runs together."""
    return fit.of_latent(scatter(fit, weights)[1])


def agreement(fit, index, weights=None, tolerance=0.0):
    """(disagreement in standard deviations, values (point,), std (point,)) of latent parameter ``index`` over points.

    Each point estimates it with the other parameters free under their priors. The disagreement is the normal deviate
    that is as rare as sum ((value - mean) / std)^2, chi^2 with one degree less than points. Points that hardly see the
    parameter (std above 1, its prior's) take no part; fewer than two: zero. ``tolerance``: latent spread that does not
    matter, added to the variance of every point; so is what runs of one point differ by beyond noise.
    """
    tolerance = max(tolerance, _between_repeats(fit, index, weights))
    information, score = by_point(fit, weights)
    information, score = _reduced(information, score, index)
    seen = information > 1.0
    value, std = np.zeros(len(seen)), np.full(len(seen), np.inf)
    value[seen], std[seen] = score[seen] / information[seen], 1 / np.sqrt(information[seen])
    if seen.sum() < 2:
        return 0.0, value, std
    std = np.hypot(std, tolerance)
    mean = np.average(value[seen], weights=1 / std[seen] ** 2)
    chance = scipy.stats.chi2.sf(np.sum(((value - mean)[seen] / std[seen]) ** 2), seen.sum() - 1)
    return float(scipy.stats.norm.isf(max(chance, _RAREST) / 2)), value, std


def trend(drift, index, condition):
    """Slope of parameter ``index`` over a condition (point,), in standard deviations of that slope."""
    weight = 1 / drift.std[:, index] ** 2
    centred = condition - np.average(condition, weights=weight)
    information = np.sum(weight * centred**2)
    return float(np.sum(weight * centred * drift.shift[:, index]) / np.sqrt(information)) if information > 0 else 0.0


def _statistic(score, inverse):
    return np.einsum("...ia,iab,...ib->...", score, inverse, score)


def _null(information, inverse, joint, draws, generator):
    """Q (draws,) of the linear model: theta_i = one prior draw, noise N(0, A_i) in the score of every point."""
    values, vectors = np.linalg.eigh(information)
    root = vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]
    size = joint.shape[0]
    noise = np.einsum("iab,dib->dia", root, generator.standard_normal((draws, len(information), size)))
    score = noise + np.einsum("iab,db->dia", information, generator.standard_normal((draws, size)))
    shift = solved(joint, score.sum(axis=1).T).T
    return _statistic(score - np.einsum("iab,db->dia", information, shift), inverse)


def _own_values(information, score):
    """Values and standard deviations that each point asks for, with the prior about the joint fit."""
    covariance = inverse(information + np.eye(information.shape[1]))
    return np.einsum("iab,ib->ia", covariance, score), np.sqrt(np.einsum("iaa->ia", covariance))


def _reduced(information, score, index):
    """Information and score (point,) of one parameter, the others eliminated under their priors."""
    others = np.arange(information.shape[1]) != index
    rest = information[:, others][:, :, others] + np.eye(others.sum())
    cross = information[:, others, index]
    gain = solved(rest, cross[..., None])[..., 0] if others.any() else cross
    return (information[:, index, index] - np.einsum("ia,ia->i", cross, gain),
            score[:, index] - np.einsum("ia,ia->i", gain, score[:, others]))


def _rank(matrix):
    values = np.linalg.eigvalsh(matrix)
    return int((values > 1e-9 * values.max(initial=1e-300)).sum())
