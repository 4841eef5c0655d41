"""Growing roots of s^2 x + s C x + K x = 0 below a frequency, by way of its real modes.

K = K_0 + dK, where K_0 is symmetric with the real modes phi and squared frequencies w^2; dK (friction, losses) and C
are neither small nor symmetric.

1. With the modes above the limit condensed, each answer at the frequency w_j of the mode that drives it, those below it
   are a small quadratic eigenvalue problem, in single precision.
2. Its roots that grow, or nearly do, are where to start: they are solved for in all coordinates without these
   simplifications, by residual inverse iteration.

Where one of these is not found, two become one, or one grows faster than it started by more than the margin by which
they were picked, so that others may have been left out, the condensation does not serve: then all roots are computed.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import DenseFactors, by_frequency, polished
from pipeline.physics.numerics.dense_factor import DenseFactor, product

#: growth rates above this negative share of the frequency are solved for, as is the largest; of all roots, which
#: losses enter as viscous damping, those above the wider one
_NEARLY, _WIDELY = 4e-4, 1e-3
#: the same in 1/s, for low frequencies
_SLOWLY = 2.0
#: modes up to this multiple of the limit are not condensed
_WIDER = 1.3
#: matrices are factorised beside a root, where they are regular in single precision
_BESIDE = 1 + 1e-5
#: inverse iterations for the shape of a mode
_INVERSE = 3
#: share of the highest squared frequency below which a motion counts as rigid
_RIGID = 1e-14
#: bands of frequency in which the modes above the limit are condensed
_BANDS = 6
#: relative error of a root
_ROOT = 1e-8
#: roots closer than this share of their frequency are one
_SAME = 1e-6


@dataclass(frozen=True)
class Growing:
    """Roots ``value`` (r,) 1/s by falling growth rate, ``shape`` (m, r), ``residual`` (r,) 1/s: |T(s) x| / |T'(s) x|;
    ``whole``: whether all roots of the system were computed to find them."""

    value: np.ndarray
    shape: np.ndarray
    residual: np.ndarray
    whole: bool


def growing_roots(damping, stiffness, change, limit):
    """Growing: all roots that grow, or nearly do, and the least stable one.

    ``damping`` (m, m) 1/s real; ``stiffness`` (m, m) 1/s^2 real symmetric and ``change`` (m, m) 1/s^2 complex are K_0
    and dK; roots are below ``limit`` rad/s. The small problem decides which are solved for: a root that grows by less
    than 4e-4 of its frequency may be missing, and where none grows another than the least stable one may stand for it.
    Raises ConvergenceError where a root cannot be solved for.
    """
    square, real = scipy.linalg.eigh(stiffness, driver="evd", check_finite=False)
    modes = _in_real_modes(damping, change, square, real.astype(np.float32))
    whole = scipy.sparse.eye_array(len(square), format="csr"), damping, stiffness + change
    try:
        return _solved(_Condensed.of(*modes, _WIDER * limit), real, whole, limit)
    except (ConvergenceError, np.linalg.LinAlgError):       # as of contacts damped so much that modes above the limit
        return spectrum_roots(damping, stiffness, change, limit)    # have no simple answer


def spectrum_roots(damping, stiffness, change, limit):
    """Growing, as of ``growing_roots``, from all 2 m roots of the system, in double precision."""
    square, real = scipy.linalg.eigh(stiffness, driver="evd", check_finite=False)
    modes = _in_real_modes(damping, change, square, real)
    whole = scipy.sparse.eye_array(len(square), format="csr"), damping, stiffness + change
    return _solved(_Condensed.of(*modes, np.inf), real, whole, limit, every=True)


def _in_real_modes(damping, change, square, real):
    """(C, dK, w^2): C and dK in the real modes, the losses being those of the viscous damping equivalent to them."""
    damping, drawn, imaginary = (real.T @ (part.astype(real.dtype) @ real)
                                 for part in (damping, change.real, change.imag))
    pace = np.sqrt(np.sqrt(np.maximum(square, _RIGID * square[-1]))).astype(real.dtype)
    return damping + imaginary / np.outer(pace, pace), drawn, square


@dataclass(frozen=True)
class _Condensed:
    """``mass``, ``damping`` and ``stiffness`` (k, k) of the lowest real modes; the others move by X q + Y q', their
    ``answers`` (2, m - k, k)."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    answers: np.ndarray

    @classmethod
    def of(cls, damping, change, square, limit):
        """With the modes above the angular frequency ``limit`` condensed.

        Their answer is that up to terms of the second order in damping, each inertia at the frequency of the mode that
        drives them.
        """
        k, kind = max(int(np.searchsorted(square, limit**2)), 1), damping.dtype
        answers = np.zeros((2, len(square) - k, k), kind)
        for band in np.array_split(np.arange(k), min(k, _BANDS)) if k < len(square) else ():
            high = change[k:, k:].copy()
            high[np.diag_indices(len(high))] += (square[k:] - square[band].mean()).astype(kind)
            factor = scipy.linalg.lu_factor(high, overwrite_a=True, check_finite=False)
            driven = change[k:, band]
            for order in range(2):
                answers[order][:, band] = -scipy.linalg.lu_solve(factor, driven, check_finite=False)
                driven = damping[k:, band] + damping[k:, k:] @ answers[order][:, band]
        drag, spring = damping[:k, k:], change[:k, k:]
        by_place, by_speed = answers
        return cls(np.eye(k) + drag @ by_speed, damping[:k, :k] + drag @ by_place + spring @ by_speed,
                   np.diag(square[:k]) + (change[:k, :k] + spring @ by_place), answers)

    def roots(self):
        """All roots (2 k,) 1/s."""
        k = len(self.mass)
        turned = np.linalg.solve(self.mass, np.hstack((self.stiffness, self.damping)))
        pace = np.sqrt(np.linalg.norm(turned[:, :k]))
        companion = np.zeros((2 * k, 2 * k), self.damping.dtype)
        companion[:k, k:][np.diag_indices(k)] = 1.0
        companion[k:, :k], companion[k:, k:] = -turned[:, :k] / pace**2, -turned[:, k:] / pace
        return pace * scipy.linalg.eigvals(companion, overwrite_a=True, check_finite=False).astype(complex)

    def shape(self, root):
        """(m,) of the mode of a root, by inverse iteration."""
        factor = DenseFactor(root**2 * self.mass + root * self.damping + self.stiffness, np.complex64)
        vector = np.ones(len(self.mass), complex)
        for _ in range(_INVERSE):
            vector = factor.solve(vector)
            vector = vector / np.linalg.norm(vector)
        follows = product(self.answers[0], vector) + root * product(self.answers[1], vector)
        return np.concatenate((vector, follows))


def _solved(condensed, real, whole, limit, every=False):
    """Growing, by step 2; ``whole``: (M, C, K) in all coordinates. ConvergenceError where that shows that the condensed
    system did not serve, unless ``every`` root has been computed."""
    roots, shapes, residuals = [], [], []
    for near in _BESIDE * _candidates(condensed.roots(), limit, _WIDELY if every else _NEARLY):
        s, x = polished(*whole, near, real @ condensed.shape(near), factors=DenseFactors(np.complex64), accuracy=_ROOT)
        again = any(abs(s - other) <= _SAME * abs(s) for other in roots)
        if not every and (again or s.real > near.real + _margin(s, _NEARLY)):
            raise ConvergenceError("growing roots", f"one root near {near:.6g} 1/s", f"{s:.6g} 1/s")
        if abs(s) < limit and not again:
            roots.append(s)
            shapes.append(x)
            residuals.append(_residual(whole, s, x))
    order = np.argsort(-np.real(roots), kind="stable")
    return Growing(np.array(roots, complex)[order], np.reshape(shapes, (-1, len(real))).T[:, order],
                   np.array(residuals, float)[order], every)


def _margin(root, nearly):
    """1/s: growth rates down to this below 0 are nearly growing."""
    return _SLOWLY + nearly * abs(root)


def _residual(whole, root, x):
    """|T(s) x| / |T'(s) x| in 1/s."""
    inertia, drag, held = (product(part, x) for part in whole)
    return np.linalg.norm(root**2 * inertia + root * drag + held) / np.linalg.norm(2 * root * inertia + drag)


def _candidates(root, limit, nearly):
    """Those of the roots below ``limit`` that grow or nearly do, and that of the largest growth rate."""
    root = root[(root.imag > abs(root.real)) & (abs(root) < limit)]
    root = root[by_frequency(root)]
    near = root.real > -_margin(root, nearly)
    near |= root.real == root.real.max(initial=-np.inf)
    return root[near]
