"""Values of a model that measured natural frequencies ask for, with what they leave uncertain.

ln f_i = ln f_i(u) + e_i,  e_i ~ N(0, s_i^2 + s^2): s_i is the error of the test, s that of the model, which no value
can mend. Values are u standard deviations from their priors, u ~ N(0, I), linear about the best ones; s has a prior
that is constant in ln s, and is integrated out over a grid, so that few modes or many values leave wide intervals
(J. L. Beck, L. S. Katafygiotis, Updating models and their uncertainties, J. Eng. Mech. 124 (1998) 455).
Pairs of modes are found anew with every step (``mode_pairing``), with half of what the step moved a frequency by as
an error of its own, since slopes are those before it; those in doubt do not count.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.mode_pairing import Pairing, assurance, grouped, paired

#: grid of the model's error, relative: from below that of any test to that of a wrong model
_ERRORS = np.geomspace(1e-5, 0.1, 81)
#: model error with which modes are paired first
_ROUGH = 0.02
#: change of all values in standard deviations at which the update ends; steps at most
_ENOUGH, _STEPS = 0.02, 20
#: share of the change of a frequency in a step that is in doubt
_CURVED = 0.5
#: steps after which modes that are apart in one step and together in the next count as together: groups grow wider
_LATE, _WIDER = 8, 0.1
#: modes of a model closer than this are one group
CLOSE = 2e-3


@dataclass(frozen=True)
class ModelModes:
    """Modes of a model at some values: ``frequency`` (m,) Hz ascending, ``slope`` (m, p) of ln f over each u, and
    shapes ``shown`` (k, m)."""

    frequency: np.ndarray
    slope: np.ndarray
    shown: np.ndarray


@dataclass(frozen=True)
class Test:
    """Measured modes: ``frequency`` (t,) Hz, its relative error ``spread`` (t,), real ``shape`` (t, n), n = 0 where no
    point is known."""

    __test__ = False

    frequency: np.ndarray
    spread: np.ndarray
    shape: np.ndarray


@dataclass(frozen=True)
class Updated:
    """What a test asks for: values ``latent`` (p,), their ``covariance`` (p, p), and the model's error with that of its
    logarithm; the ``groups`` [(k,)] of the modes ``after``, their ``spread`` (g,) of ln f, the Pairing of the test, and
    its ``likeness`` (t, g) with the groups."""

    latent: np.ndarray
    covariance: np.ndarray
    error: float
    error_spread: float
    before: ModelModes
    after: ModelModes
    groups: list
    spread: np.ndarray
    pairing: Pairing
    likeness: np.ndarray


def update(model, seen, test, count):
    """Updated of ``count`` values by a Test.

    ``model(u)`` -> ModelModes; ``seen``: shapes (k, j) of j modes -> (n, i), columns of which a measured shape is a
    mixture where its mode is one of these. Raises ConvergenceError where no pair is clear or the steps do not end, and
    what the model raises.
    """
    latent, covariance, error, moved = np.zeros(count), np.eye(count), _ROUGH, np.zeros(count)
    before = modes = model(latent)
    for step in range(_STEPS):
        groups = grouped(modes.frequency, CLOSE * (1 + _WIDER * max(step - _LATE, 0)))
        frequency, slope = _means(modes, groups)
        spread = np.hypot(np.hypot(_spread(slope, covariance), _CURVED * (slope @ moved)), error)
        pairing, likeness = _paired(modes, groups, seen, test, frequency, spread)
        clear = pairing.clear
        if not clear.any():
            raise ConvergenceError("model update", "a measured mode that is one of the model beyond doubt", "none",
                                   "measure more points and state where they are, or widen the priors")
        own, left, noise = _told(test, pairing, frequency)
        target, covariance, error, error_spread = posterior(left + slope[own] @ latent, slope[own], noise)
        moved = target - latent
        if abs(moved / np.sqrt(np.diag(covariance))).max(initial=0.0) < _ENOUGH:
            return Updated(target, covariance, error, error_spread, before, modes, groups,
                           _spread(slope, covariance), pairing, likeness)
        latent = target
        modes = model(latent)
    raise ConvergenceError("model update", f"values that settle within {_STEPS} steps", "others at every step",
                           "state narrower priors or fewer values; the test may be of something else than the model")


def with_errors(found, test, errors):
    """Covariance (p, p) about the values of an Updated, with ``errors`` [(g,)] of ln f of its groups beside them.

    Each is times an unknown factor, N(0, 1): what the frequencies cannot tell from the values makes these uncertain,
    at most as their priors.
    """
    frequency, slope = _means(found.after, found.groups)
    own, left, noise = _told(test, found.pairing, frequency)
    beside = np.reshape(errors, (-1, len(found.groups))).T[own]
    count = len(found.latent)
    mean, covariance, _, _ = posterior(left + slope[own] @ found.latent, np.hstack((slope[own], beside)), noise)
    apart = mean[:count] - found.latent
    return covariance[:count, :count] + np.outer(apart, apart)


def posterior(left, slope, spread):
    """(mean (p,), covariance (p, p), median model error, spread of its logarithm) of u ~ N(0, I).

    left = slope u + e with e ~ N(0, spread^2 + s^2), s integrated out.
    """
    means, covariances, weights = [], [], []
    for error in _ERRORS:
        noise = np.hypot(spread, error)
        precision = np.eye(slope.shape[1]) + (slope / noise[:, None] ** 2).T @ slope
        covariance = np.linalg.inv(precision)
        mean = covariance @ (slope.T @ (left / noise ** 2))
        rest = left - slope @ mean
        weights.append(-0.5 * (rest @ (rest / noise ** 2) + mean @ mean) - np.log(noise).sum()
                       - 0.5 * np.linalg.slogdet(precision)[1])
        means.append(mean)
        covariances.append(covariance)
    weight = np.exp(np.array(weights) - max(weights))
    weight /= weight.sum()
    mean = weight @ np.array(means)
    apart = np.array(means) - mean
    whole = np.einsum("w,wpq->pq", weight, np.array(covariances)) + np.einsum("w,wp,wq->pq", weight, apart, apart)
    middle = weight @ np.log(_ERRORS)
    return mean, whole, float(np.exp(middle)), float(np.sqrt(weight @ (np.log(_ERRORS) - middle) ** 2))


def _told(test, pairing, frequency):
    """(group (o,), ln f measured less that of the model (o,), its error (o,)) of the groups with clear pairs: means of
    their measured modes, as what splits two modes of a disc is not in the model."""
    own = np.unique(pairing.group[pairing.clear])
    members = [pairing.clear & (pairing.group == group) for group in own]
    left = [np.log(test.frequency[m] / frequency[group]).mean() for m, group in zip(members, own, strict=True)]
    noise = [np.linalg.norm(test.spread[m]) / np.count_nonzero(m) for m in members]
    return own, np.array(left), np.array(noise)


def _spread(slope, covariance):
    """Standard deviation (g,) of ln f of each group by the values."""
    return np.sqrt(np.einsum("gp,pq,gq->g", slope, covariance, slope))


def _means(modes, groups):
    """(frequency (g,), slope (g, p)) of groups: their means, which a mixture of equal modes does not change."""
    log = np.log(modes.frequency)
    return (np.exp([log[k].mean() for k in groups]), np.array([modes.slope[k].mean(axis=0) for k in groups]))


def _paired(modes, groups, seen, test, frequency, spread):
    """(Pairing, MAC (t, g)) of a Test with groups of ``frequency`` and ``spread`` (g,)."""
    points = test.shape.shape[1]
    shows = [seen(modes.shown[:, k]) for k in groups] if points else []
    likeness = assurance(test.shape, shows) if points else np.zeros((len(test.frequency), len(groups)))
    every = np.concatenate((test.frequency, frequency))
    distance = np.log(test.frequency[:, None] / frequency)
    whole = np.hypot(test.spread[:, None], spread)
    dimensions = np.array([s.shape[1] for s in shows])
    return paired(distance, whole, [len(k) for k in groups], float(np.log(every.max() / every.min())) + 1e-3,
                  likeness if points else None, dimensions, points), likeness
