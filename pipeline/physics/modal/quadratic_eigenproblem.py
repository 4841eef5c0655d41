"""Complex modes of a small dense system: roots and vectors of (s^2 M + s C + K) x = 0, and their paths over friction.

C and K may be unsymmetric (gyroscopic and friction terms). The problem is scaled to unit masses by congruence and
written as the companion matrix [[0, g I], [-K / g, -C]] with g = sqrt(|K|), so that both blocks are of one size
(Fan, Lin & Van Dooren, SIAM J. Matrix Anal. Appl. 26 (2004) 252). What settles beside the motion, z' = P x + V x' - R z
with the force B z (a Settling of ``small_motion``), joins it as further rows.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.dense_factor import DenseFactor, product

#: factorisations at most, iterations with each, and the step, as a share of the root, that ends them
_FACTORISATIONS, _POLISHINGS, _POLISHED = 4, 8, 1e-11
#: part of the largest root below which two frequencies differ by rounding alone
_ROUNDING = 1e-10
#: vectors of known roots: factorised so far beside a root, inverse iterations, distance of the next root as a share of
#: it, and the part of all coordinates from whose number on vectors of all roots cost less
_BESIDE, _INVERSE, _APART, _FEW = 1 + 1e-8, 3, 1e-5, 10


@dataclass(frozen=True)
class QuadraticModes:
    """All roots (1/s) by rising imaginary part, 2 n and one for each of k states that settle beside the motion; right
    vectors (n, 2n + k) and, where asked for, left ones."""

    value: np.ndarray
    right: np.ndarray
    left: np.ndarray | None = None


def quadratic_roots(mass, damping, stiffness, beside=None):
    """All 2 n roots s (1/s) of det(s^2 M + s C + K) = 0, by rising imaginary part; arguments as ``quadratic_modes``."""
    companion, _ = _companion(mass, damping, stiffness, beside)
    roots = scipy.linalg.eigvals(companion, overwrite_a=True, check_finite=False)
    return roots[by_frequency(roots)]


def quadratic_modes(mass, damping, stiffness, left=False, beside=None):
    """Roots and vectors of (s^2 M + s C + K) x = 0 and, if ``left``, y^H (s^2 M + s C + K) = 0.

    ``mass`` (n, n) kg is symmetric positive definite; ``damping`` (n, n) N s/m and ``stiffness`` (n, n) N/m are
    general real matrices; ``beside``: a Settling, or None. Vectors have unit length in the mass norm, x^H M x = 1.
    Raises ConfigError for a mass matrix that is not positive definite.
    """
    companion, factor = _companion(mass, damping, stiffness, beside)
    roots, *vectors = scipy.linalg.eig(companion, left=left, right=True, overwrite_a=True, check_finite=False)
    order, n = by_frequency(roots), len(mass)
    right = _physical(vectors[-1][:n, order], factor)
    return QuadraticModes(roots[order], right, _physical(vectors[0][n:2 * n, order], factor) if left else None)


def vectors_of(mass, damping, stiffness, roots, every_root, beside=None):
    """Right vectors (n, g) of known ``roots`` (g,) 1/s among ``every_root`` (r,); arguments and errors as of
    ``quadratic_modes``, which a root that another one nearly equals asks for. Others are found by inverse iteration."""
    if len(roots) > len(mass) // _FEW or _crowded(roots, every_root):
        modes = quadratic_modes(mass, damping, stiffness, beside=beside)
        return modes.right[:, scipy.optimize.linear_sum_assignment(abs(roots[:, None] - modes.value))[1]]
    start, vectors = np.random.default_rng(0).standard_normal(len(mass)), np.empty((len(mass), len(roots)), complex)
    for k, root in enumerate(roots):
        factor, x = DenseFactor(operator(mass, damping, stiffness, root * _BESIDE, beside)[0]), start
        for _ in range(_INVERSE):
            x = factor.solve(operator(mass, damping, stiffness, root, beside, x)[1])
            x = x / np.linalg.norm(x)
        vectors[:, k] = x / np.sqrt((x.conj() @ (mass @ x)).real)
    return vectors


def _crowded(roots, every_root):
    """Whether one of the ``roots`` has another of all next to it, or is none that inverse iteration finds."""
    distance = np.sort(abs(roots[:, None] - every_root), axis=1)
    return bool((distance[:, 1:2] <= _APART * abs(roots)[:, None]).any() or not roots.all())


def quadratic_pairs(mass, damping, stiffness):
    """(roots (2 n,) 1/s, vectors (n, 2 n) of unit length) of (s^2 M + s C + K) x = 0 with general complex (n, n)."""
    n = len(mass)
    pace = np.sqrt(np.linalg.norm(stiffness) / np.linalg.norm(mass))
    companion = np.zeros((2 * n, 2 * n), complex)
    companion[:n, n:] = pace * np.eye(n)
    companion[n:] = -np.linalg.solve(mass, np.hstack((stiffness / pace, damping)))
    roots, vectors = scipy.linalg.eig(companion, overwrite_a=True, check_finite=False)
    return roots, vectors[:n] / np.linalg.norm(vectors[:n], axis=0)


def polished(mass, damping, stiffness, root, vector, beside=None, factors=None, accuracy=_POLISHED):
    """(root 1/s, vector (n,)) of T(s) x = (s^2 M + s C + K) x = 0 from an approximate pair.

    Arguments as of ``quadratic_modes``; matrices may be complex, sparse with ``factors`` (see ``DenseFactors``) of
    such, and the mass (n,) a diagonal one. Residual inverse iteration: one factor of T serves all steps, that of
    ``factors`` if it is ready, and another where they slow down (Neumaier, SIAM J. Numer. Anal. 22 (1985) 914). The
    last step is below ``accuracy`` times the root. Raises ConvergenceError where no root lies close by.
    """
    start = s, x = complex(root), vector / np.linalg.norm(vector)
    factors, step = DenseFactors() if factors is None else factors, np.inf
    given = factors.ready
    for attempt in range(_FACTORISATIONS):
        if attempt or not given:
            factors.renew(operator(mass, damping, stiffness, s, beside)[0])
        left = factors.solve(x, adjoint=True).conj()
        for _ in range(_POLISHINGS):
            missing, slope = operator(mass, damping, stiffness, s, beside, x)
            along = left @ slope
            if along == 0 or not np.isfinite(along):
                break
            step = (left @ missing) / along
            s = s - step
            x = x - factors.solve(missing - step * slope)
            x = x / np.linalg.norm(x)
            if abs(step) <= accuracy * abs(s):
                return s, x
        if given and not attempt:
            s, x = start
    raise ConvergenceError("complex modes", f"a root near {root:.6g} 1/s", f"steps of {abs(step):.2g} 1/s",
                           "lower smallest_correction")


class DenseFactors:
    """The LU factor in use, if it is ``ready``; another takes its place and its memory.

    ``kind``: type of its numbers. Where solutions are refined, single precision does, at less than half the cost.
    """

    ready = False

    def __init__(self, kind=complex):
        self._kind = kind

    def renew(self, matrix):
        """Factorise ``matrix`` (n, n)."""
        self._factor, self.ready = DenseFactor(matrix, self._kind), True

    def solve(self, rhs, adjoint=False):
        """x (n,) of A x = rhs, or A^H x = rhs."""
        return self._factor.solve(rhs, adjoint)


def operator(mass, damping, stiffness, s, beside, x=None):
    """T(s) = s^2 M + s C + K less what settles beside it, and dT/ds; both times ``x`` where it is given."""
    force, turn = (0.0, 0.0) if beside is None else beside.answers(s, x)
    if x is None:
        if mass.ndim == 1:
            whole = s * damping + stiffness
            whole[np.diag_indices(len(mass))] += s**2 * mass
        else:
            whole = s**2 * mass + s * damping + stiffness
        return (whole if beside is None else whole - force), None
    inertia, drag = product(mass, x), product(damping, x)
    return s**2 * inertia + s * drag + product(stiffness, x) - force, 2 * s * inertia + drag - turn


def by_frequency(roots):
    """Indices that put complex ``roots`` in order of rising imaginary part, those of one frequency by real part.

    Frequencies that differ by rounding alone are one: no last bit decides which of a growing and a decaying root of
    the same frequency comes first.
    """
    roots = np.asarray(roots)
    order = np.argsort(roots.imag, kind="stable")
    apart = np.diff(roots.imag[order]) > _ROUNDING * np.abs(roots).max(initial=0.0)
    group = np.concatenate(([0], np.cumsum(apart)))[:len(roots)]
    return order[np.lexsort((roots.real[order], group))]


def upper_half(roots, count=None):
    """Indices of one root of every conjugate pair, by rising imaginary part: n of the 2 n roots of a real system.

    Of real roots, which come in an even number, the half that lies to the right is taken. ``count``: n where others
    stand beside them, of states that settle.
    """
    return by_frequency(roots)[len(roots) - (len(roots) // 2 if count is None else count):]


def follow_roots(roots):
    """Reorder roots (steps, n) so that column j is one root followed over the steps.

    Every step is assigned to the roots expected by linear extrapolation, with the least sum of distances in the
    complex plane. Where two roots meet (coalescence) either continuation is right.
    """
    followed = np.array(roots)
    for step in range(1, len(followed)):
        back = max(step - 2, 0)
        expected = followed[step - 1] + (followed[step - 1] - followed[back])
        _, chosen = scipy.optimize.linear_sum_assignment(abs(expected[:, None] - followed[step][None, :]))
        followed[step] = followed[step, chosen]
    return followed


def _companion(mass, damping, stiffness, beside):
    """(companion matrix, W): W^T M W = I takes unit-mass coordinates to physical ones."""
    n, balance = len(mass), np.sqrt(np.maximum(np.diag(mass), np.finfo(float).tiny))
    try:
        lower = scipy.linalg.cholesky(mass / np.outer(balance, balance), lower=True)
    except scipy.linalg.LinAlgError:
        raise ConfigError("complex modes: mass", "a symmetric positive definite matrix",
                          f"smallest diagonal entry {np.min(np.diag(mass)):.3g}",
                          "give every coordinate a mass, or condense the massless ones") from None
    to_physical = scipy.linalg.solve_triangular(lower, np.eye(n), lower=True).T / balance[:, None]
    unit_damping = to_physical.T @ damping @ to_physical
    unit_stiffness = to_physical.T @ stiffness @ to_physical
    pace = np.sqrt(np.linalg.norm(unit_stiffness)) or 1.0
    companion = np.zeros((2 * n, 2 * n))
    companion[:n, n:] = pace * np.eye(n)
    companion[n:, :n], companion[n:, n:] = -unit_stiffness / pace, -unit_damping
    if beside is None or not beside.decay.size:
        return companion, to_physical
    mixed = beside.projected(to_physical.T, to_physical)
    return np.block([[companion, np.vstack((0 * mixed.push, mixed.push / pace))],
                     [np.hstack((mixed.by_place, pace * mixed.by_speed)), -np.diag(mixed.decay)]]), to_physical


def _physical(vectors, to_physical):
    size = np.linalg.norm(vectors, axis=0)      # 0 where a state settles that moves nothing
    return to_physical @ (vectors / np.where(size > 0, size, 1.0))
