"""Best subsets of candidate laws where the prediction is linear in their coefficients: by evidence, exhaustively.

With the whitened directions g_i of the candidates per unit of their priors, C = I + J J' of the nominal parameters,
A_ij = g_i'C^-1 g_j and z_i = g_i'C^-1 r, a subset S gains over the nominal model

    ln Z_S - ln Z_0 = 1/2 z_S'(I + A_S)^-1 z_S - 1/2 ln det(I + A_S) - ln C(n, |S|)

with its coefficients u_S = (I + A_S)^-1 z_S (Zellner, in Bayesian Inference and Decision Techniques, 1986, for the
Gaussian case); the last term pays for the number of subsets of that size among n candidates (Chen & Chen, Biometrika 95
(2008) 759). No member has to gain anything alone.
"""

from dataclasses import dataclass
from itertools import combinations
from math import comb, log

import numpy as np

from pipeline.inference.fitting.effective_sample_size import tempering
from pipeline.inference.fitting.fit_state import from_prior_mean, orthogonal
from pipeline.inference.regular import log_determinant, solved

#: most laws of a subset
MOST = 4
#: directions that larger subsets are drawn from, those of the best pairs
DOZEN = 12
#: correlation beyond which two directions of one candidate are one, and share of its square that a direction keeps
#: beside the nominal parameters, below which they are it
_SAME, _VISIBLE = 0.9999, 1e-8


@dataclass(frozen=True)
class Table:
    """Gram matrix ``gram`` (q, q) and projections ``score`` (q,) of directions, ``owner`` (q,) their candidates.

    ``sign`` (q,): +1 or -1 where a coefficient has one sign, else 0; ``tried`` (q,) latent values of the effects'
    parameters, ``index`` (q,) of the direction among all; ``exclusive`` (n, n): which of n candidates are of one
    family, and never together; ``weights`` (runs,) of the runs.
    """

    gram: np.ndarray
    score: np.ndarray
    owner: np.ndarray
    sign: np.ndarray
    tried: tuple
    index: np.ndarray
    exclusive: np.ndarray
    weights: np.ndarray

    @property
    def count(self):
        """Number of candidates."""
        return len(self.exclusive)

    def gain(self, members):
        """(m,) gain in log evidence of subsets ``members`` (m, k) of directions, and (m, k) their coefficients."""
        members = np.asarray(members, int)
        size = members.shape[1]
        hessian = np.eye(size) + self.gram[members[:, :, None], members[:, None, :]]
        score = self.score[members]
        coefficient = solved(hessian, score[:, :, None])[:, :, 0]
        gained = 0.5 * np.einsum("mk,mk->m", score, coefficient) - 0.5 * log_determinant(hessian)
        gained -= multiplicity(self.count, size)
        against = (self.sign[members] * coefficient < 0).any(axis=1)
        return np.where(against, -np.inf, gained), coefficient


@dataclass(frozen=True)
class Subset:
    """Candidates ``owners`` (index, ...) in ascending order with the ``gain`` of their evidence, paid for.

    ``coefficients``: in prior scales; ``directions``: indices of their directions in the Table.
    """

    owners: tuple
    gain: float
    coefficients: tuple
    directions: tuple


def multiplicity(count, size):
    """ln of the number of sets of this ``size`` among ``count`` candidates."""
    return log(comb(count, size))


def table(null, every):
    """Table of ``every`` Directions at the Fit ``null``; runs are weighed by what all visible ones together leave."""
    residual = np.concatenate(from_prior_mean(null))
    vectors = np.concatenate([np.empty((0, len(residual))), *(d.vectors for d in every)])
    sign = np.concatenate([np.empty(0, int), *(d.sign for d in every)])
    owner = np.repeat(np.arange(len(every)), [len(d.sign) for d in every])
    tried = [latent for d in every for latent in d.tried]
    certain = np.concatenate(null.jacobians)
    kept = _distinct(vectors, orthogonal(vectors.T, certain).T, owner)
    vectors = vectors[kept]
    weights = _weights(null, residual, np.column_stack((certain, vectors.T)))
    root = np.sqrt(np.repeat(weights, null.counts))
    cleaned = orthogonal((root * vectors).T, root[:, None] * certain)
    return Table((root * vectors) @ cleaned, cleaned.T @ (root * residual), owner[kept], sign[kept],
                 tuple(tried[q] for q in kept), kept, _exclusive([d.candidate for d in every]), weights)


def _exclusive(candidates):
    alike = [[one.excludes(other) for other in candidates] for one in candidates]
    return np.array(alike, bool).reshape(len(candidates), len(candidates))


def best_subsets(of, most=MOST, count=8):
    """[Subset], best first: the best ``count`` sets of up to ``most`` candidates, by one direction each.

    Pairs of all directions are compared; larger ones are drawn from those of the best pairs.
    """
    singles = _subsets(of, np.arange(len(of.owner))[:, None])
    pairs = _subsets(of, _combined(of, np.arange(len(of.owner)), 2))
    dozen = list(dict.fromkeys(q for s in (*pairs, *singles) for q in s.directions))[:DOZEN]
    larger = [s for size in range(3, most + 1) for s in _subsets(of, _combined(of, np.array(sorted(dozen), int), size))]
    best = {}
    for subset in sorted((*singles, *pairs, *larger), key=lambda s: -s.gain):
        best.setdefault(subset.owners, subset)
    return list(best.values())[:count]


def _combined(of, directions, size):
    """(m, size) combinations of ``directions``, no two of one family of candidates."""
    members = np.array(list(combinations(directions, size)), int).reshape(-1, size)
    owners = of.owner[members]
    alike = [of.exclusive[owners[:, i], owners[:, k]] for i, k in combinations(range(size), 2)]
    return members[~np.any(alike, axis=0)] if alike and len(members) else members


def _subsets(of, members):
    """[Subset] of directions ``members`` (m, k) whose signs hold, best first."""
    if not len(members):
        return []
    gain, coefficient = of.gain(members)
    order = [m for m in np.argsort(-gain, kind="stable") if np.isfinite(gain[m])]
    return [Subset(*_by_owner(of, members[m], coefficient[m], float(gain[m]))) for m in order]


def _by_owner(of, members, coefficient, gain):
    order = np.argsort(of.owner[members])
    return (tuple(int(i) for i in of.owner[members][order]), gain, tuple(float(c) for c in coefficient[order]),
            tuple(int(q) for q in members[order]))


def _distinct(vectors, cleaned, owner):
    """Indices of the directions that can be seen beside the nominal parameters, those of one candidate distinct."""
    square, whole = np.einsum("qm,qm->q", vectors, cleaned), np.einsum("qm,qm->q", vectors, vectors)
    size, kept = np.sqrt(np.maximum(square, 1e-300)), []
    for q in np.flatnonzero(square > _VISIBLE * whole):
        rivals = [k for k in kept if owner[k] == owner[q]]
        if all(vectors[q] @ cleaned[k] < _SAME * size[q] * size[k] for k in rivals):
            kept.append(int(q))
    return np.array(kept, int)


def _weights(null, residual, columns):
    """Weights (runs,) by what all ``columns`` (m, k) leave, each coefficient as uncertain as its prior."""
    return tempering(null.noises, np.split(left_by(columns, residual), np.cumsum(null.counts)[:-1]))


def left_by(columns, residual):
    """(m,) of a ``residual`` (m,) that ``columns`` (m, k) leave, each coefficient as uncertain as its prior."""
    u = solved(np.eye(columns.shape[1]) + columns.T @ columns, columns.T @ residual)
    return residual - columns @ u
