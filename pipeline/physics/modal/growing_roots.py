"""Growing roots of T(s) x = (s^2 + s C + K) x = 0 below a frequency, by way of its real modes.

K = K_0 + dK, where K_0 is symmetric with the real modes phi and squared frequencies w^2; dK (friction, losses) and C
are neither small nor symmetric.

1. In each band of frequency the modes in and about it are kept, what all others answer is condensed: exactly at the
   middle i c of the band, to first order beside it. The condensed matrix is linear in s^2,

       S(s) = S(i c) + (s^2 + c^2) S'(i c) / (2 i c),

   a complex eigenvalue problem as large as the band has modes, in single precision. The lowest band, wide as a share of
   its frequencies, is a quadratic one, the answers of others being those to slow motion.
2. Roots that grow, or nearly do, are where to start: they are solved for in all coordinates without these
   simplifications, by residual inverse iteration.

Where one of these is not found, two of a band become one, or one grows faster than it started by more than the margin
by which they were picked, so that others may have been left out, the bands do not serve: then all roots are computed.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import DenseFactors, by_frequency, operator, polished
from pipeline.physics.numerics.dense_factor import DenseFactor, product

#: growth rates above this negative share of the frequency are solved for, as is the largest, and above this in 1/s
_NEARLY, _SLOWLY = 4e-4, 2.0
#: the lowest band ends at this share of the limit; number of those above it, each as wide in proportion
_LOW, _BANDS = 1 / 8, 4
#: modes this far beyond a band, as a share of the frequency of its end, are kept; the same of the lowest band
_ABOUT, _ABOUT_LOW = 0.2, 0.6
#: roots this far beyond a band, as a share of their frequency, are its own too: none is left to the other of two
_SHARED = 2e-3
#: octaves down from the limit over each of which memory is as at the middle; below the last it is one band
_OCTAVES = 8
#: so few coordinates are not split into bands
_FEW = 60
#: matrices are factorised beside a root, where they are regular in single precision
_BESIDE = 1 + 1e-5
#: inverse iterations for the shape of a mode
_INVERSE = 3
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


def growing_roots(damping, stiffness, change, limit, beside=None):
    """Growing: all roots that grow, or nearly do, and the least stable one.

    ``damping`` (m, m) 1/s real; ``stiffness`` (m, m) 1/s^2 real symmetric and ``change`` (m, m) 1/s^2 complex are K_0
    and dK; roots are below ``limit`` rad/s. The bands decide which are solved for: a root that grows by less than 4e-4
    of its frequency may be missing, and where none grows another than the least stable one may stand for it.
    ``beside``: a Settling, see ``quadratic_eigenproblem``, or None; bands take what it answers at their middles.
    Raises ConvergenceError where a root cannot be solved for.
    """
    square, real = scipy.linalg.eigh(stiffness, driver="evd", check_finite=False)
    whole = np.ones(len(square)), damping, stiffness + change
    try:
        modes = _in_real_modes(damping, change, square, real.astype(np.float32))
        memory = beside and beside.projected(real.T, real)
        return _solved(_bands(*modes, np.sqrt(np.maximum(square, 0.0)), limit, memory), real, whole, limit, beside)
    except (ConvergenceError, np.linalg.LinAlgError):
        return _of_all(square, real, whole, change, limit, beside)


def spectrum_roots(damping, stiffness, change, limit, beside=None):
    """Growing, as of ``growing_roots``, from all 2 m roots of the system, in double precision; with a Settling
    ``beside`` it, of those about each of a few frequencies as it answers there."""
    square, real = scipy.linalg.eigh(stiffness, driver="evd", check_finite=False)
    whole = np.ones(len(square)), damping, stiffness + change
    return _of_all(square, real, whole, change, limit, beside)


def _of_all(square, real, whole, change, limit, beside):
    modes, memory = _in_real_modes(whole[1], change, square, real), beside and beside.projected(real.T, real)
    ends = [0.0, limit] if memory is None else _octaves(limit)
    bands = [(_Low.of(*_remembering(modes, memory, (low + high) / 2), len(square), 0.0), low, high)
             for low, high in pairwise(ends)]
    return _solved(bands, real, whole, limit, beside, every=True)


def _octaves(limit):
    """Ends in rad/s of bands over which what settles beside the modes answers as at their middles."""
    return [0.0, *(limit / 2.0 ** np.arange(_OCTAVES, -1, -1))]


def _remembering(modes, memory, pace):
    """(C, K) of ``modes``, with real ones that stand for a Settling ``memory``, or None, at ``pace`` rad/s."""
    if memory is None:
        return modes
    (damping, stiffness), (answer, _) = modes, memory.answers(1j * pace)
    return damping - (answer.imag / pace).astype(damping.dtype), stiffness - answer.real.astype(damping.dtype)


def _in_real_modes(damping, change, square, real):
    """(C, K) in the real modes, the latter complex."""
    damping, drawn, lost = (real.T @ (part.astype(real.dtype) @ real) for part in (damping, change.real, change.imag))
    stiffness = np.empty(drawn.shape, np.result_type(drawn, np.complex64))
    stiffness.real, stiffness.imag = drawn, lost
    stiffness[np.diag_indices(len(square))] += square.astype(real.dtype)
    return damping, stiffness


def _bands(damping, stiffness, pace, limit, memory=None):
    """[(condensed problem, its lower, its upper end in rad/s)] that cover the frequencies to the ``limit``; ``pace``
    (m,) rad/s are those of the real modes; ``memory``: a Settling in real modes or None."""
    modes, ends = (damping, stiffness), limit * np.geomspace(_LOW, 1.0, _BANDS + 1)
    if len(pace) <= _FEW:
        whole = [0.0, limit] if memory is None else _octaves(limit)
        return [(_Low.of(*_remembering(modes, memory, (low + high) / 2), len(pace), 0.0), low, high)
                for low, high in pairwise(whole)]
    last, lowest = int(np.searchsorted(pace, (1 + _ABOUT_LOW) * ends[0])), [0.0, ends[0]]
    if memory is not None:
        lowest = [end for end in _octaves(limit) if end <= ends[0]]
    bands = [(_Low.of(*_remembering(modes, memory, (low + high) / 2), last, ends[0] / 2), low, high)
             for low, high in pairwise(lowest if last else [])]
    for low, high in pairwise(ends):
        first, last = np.searchsorted(pace, ((1 - _ABOUT) * low, (1 + _ABOUT) * high))
        if last > first:
            middle = (low + high) / 2
            bands.append((_Band.of(*_remembering(modes, memory, middle), np.arange(first, last), middle), low, high))
    return bands


@dataclass(frozen=True)
class _Low:
    """``mass``, ``damping`` and ``stiffness`` (k, k) of the lowest k real modes; the others move by X q + Y q', their
    ``answers`` (2, m - k, k)."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    answers: np.ndarray

    @classmethod
    def of(cls, damping, stiffness, k, middle):
        """Of the real modes below the k-th; the others answer with their inertia at the frequency ``middle`` rad/s, and
        to first order in damping."""
        own, other = slice(0, k), slice(k, len(stiffness))
        answers = np.zeros((2, len(stiffness) - k, k), stiffness.dtype)
        if k < len(stiffness):
            high = stiffness[other, other].copy()
            high[np.diag_indices(len(high))] -= high.dtype.type(middle**2)
            factor = scipy.linalg.lu_factor(high, overwrite_a=True, check_finite=False)
            driven = stiffness[other, own]
            for order in range(2):
                answers[order] = -scipy.linalg.lu_solve(factor, driven, check_finite=False)
                driven = damping[other, own] + damping[other, other] @ answers[order]
        drag, spring = damping[own, other], stiffness[own, other]
        by_place, by_speed = answers
        return cls(np.eye(k) + drag @ by_speed, damping[own, own] + drag @ by_place + spring @ by_speed,
                   stiffness[own, own] + spring @ by_place, answers)

    def roots(self):
        """All roots (2 k,) 1/s."""
        k = len(self.mass)
        turned = np.linalg.solve(self.mass, np.hstack((self.stiffness, self.damping)))
        pace = np.sqrt(np.linalg.norm(turned[:, :k]))
        companion = np.zeros((2 * k, 2 * k), self.stiffness.dtype)
        companion[:k, k:][np.diag_indices(k)] = 1.0
        companion[k:, :k], companion[k:, k:] = -turned[:, :k] / pace**2, -turned[:, k:] / pace
        return pace * scipy.linalg.eigvals(companion, overwrite_a=True, check_finite=False).astype(complex)

    def shape(self, root):
        """(m,) of the mode of a root."""
        vector = _null_vector(root**2 * self.mass + root * self.damping + self.stiffness)
        return np.concatenate((vector, product(self.answers[0], vector) + root * product(self.answers[1], vector)))


@dataclass(frozen=True)
class _Band:
    """S(i c) = ``value`` (k, k) 1/s^2 and S'(i c) = ``slope`` (k, k) 1/s of k real modes of m, the first of ``order``
    (m,); the others move by ``answer`` (m - k, k) times these, as at the ``middle`` c rad/s."""

    value: np.ndarray
    slope: np.ndarray
    answer: np.ndarray
    order: np.ndarray
    middle: float

    @classmethod
    def of(cls, damping, stiffness, kept, middle):
        """Of the real modes ``kept`` (k,), about the frequency ``middle`` rad/s."""
        order = np.concatenate((kept, np.delete(np.arange(len(stiffness)), kept)))
        k, turn, diagonal = len(kept), np.complex64(2j * middle), np.diag_indices(len(stiffness))
        drag, moved = damping[order][:, order], stiffness[order][:, order]
        moved.imag += np.float32(middle) * drag
        moved[diagonal] -= np.float32(middle**2)
        factor = scipy.linalg.lu_factor(moved[k:, k:], check_finite=False)
        answer = -scipy.linalg.lu_solve(factor, moved[k:, :k], check_finite=False)
        pushed = -scipy.linalg.lu_solve(factor, moved[:k, k:].T, trans=1, check_finite=False).T
        slope = drag[:, :k] + product(drag[:, k:], answer)
        slope[k:] += turn * answer
        slope = slope[:k] + pushed @ slope[k:]
        slope[np.diag_indices(k)] += turn
        return cls(moved[:k, :k] + moved[:k, k:] @ answer, slope, answer, order, middle)

    def roots(self):
        """The k roots (k,) 1/s of the upper half plane."""
        turned = np.linalg.solve(self.slope, np.complex64(-2j * self.middle) * self.value)
        square = scipy.linalg.eigvals(turned, overwrite_a=True, check_finite=False).astype(complex) - self.middle**2
        return np.sqrt(-square) * 1j       # the square root lies in the right half plane

    def shape(self, root):
        """(m,) of the mode of a root."""
        vector = _null_vector(self.value + (root**2 + self.middle**2) / (2j * self.middle) * self.slope)
        shape = np.empty(len(self.order), complex)
        shape[self.order] = np.concatenate((vector, self.answer @ vector))
        return shape


def _null_vector(matrix):
    """(k,) of unit length that a nearly singular ``matrix`` (k, k) nearly takes to 0, by inverse iteration."""
    factor, vector = DenseFactor(matrix, np.complex64), np.ones(len(matrix), complex)
    for _ in range(_INVERSE):
        vector = factor.solve(vector)
        vector = vector / np.linalg.norm(vector)
    return vector


def _solved(bands, real, whole, limit, beside, every=False):
    """Growing, by step 2; ``whole``: (M, C, K) in all coordinates. ConvergenceError where that shows that the ``bands``
    did not serve, unless ``every`` root has been computed."""
    found, shapes, residuals = [], [], []      # found: [(root, number of its band)]
    for number, near in _candidates(bands, limit):
        band, near = bands[number][0], _BESIDE * near
        s, x = polished(*whole, near, real @ band.shape(near), beside, DenseFactors(np.complex64), _ROOT)
        twins = [of for root, of in found if abs(s - root) <= _SAME * abs(s)]
        if not every and (number in twins or s.real > near.real + _margin(s)):
            raise ConvergenceError("growing roots", f"one root near {near:.6g} 1/s", f"{s:.6g} 1/s")
        if abs(s) < limit and not twins:
            found.append((s, number))
            shapes.append(x)
            residuals.append(_residual(whole, s, x, beside))
    roots = np.array([root for root, _ in found], complex)
    order = np.argsort(-roots.real, kind="stable")
    return Growing(roots[order], np.reshape(shapes, (-1, len(real))).T[:, order], np.array(residuals, float)[order],
                   every)


def _margin(root):
    """1/s: growth rates down to this below 0 are nearly growing."""
    return _SLOWLY + _NEARLY * abs(root)


def _residual(whole, root, x, beside):
    """|T(s) x| / |T'(s) x| in 1/s."""
    left, slope = operator(*whole, root, beside, x)
    return np.linalg.norm(left) / np.linalg.norm(slope)


def _candidates(bands, limit):
    """[(number of its band, root 1/s)] of those that grow or nearly do, and that of the largest growth rate."""
    found = [(number, root) for number, (band, low, high) in enumerate(bands)
             for root in _within(band.roots(), (1 - _SHARED) * low, min((1 + _SHARED) * high, limit))]
    most = max((root.real for _, root in found), default=0.0)
    return [(number, root) for number, root in found if root.real > -_margin(root) or root.real == most]


def _within(root, low, high):
    """Those of the roots that lie between two frequencies in rad/s and are no mere decay, by rising frequency."""
    root = root[(root.imag > abs(root.real)) & (abs(root) >= low) & (abs(root) < high)]
    return root[by_frequency(root)]
