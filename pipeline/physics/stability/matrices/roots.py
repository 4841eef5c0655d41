"""Roots of large sparse systems (s^2 M + s C + K) x = 0 near the imaginary axis, by shifts that overlap.

About each shift the roots nearest to it are found (implicitly restarted Arnoldi iteration with T(shift)^-1; R. B.
Lehoucq & D. C. Sorensen, SIAM J. Matrix Anal. Appl. 17 (1996) 789), so that within the distance of the farthest of them
none is missed. Shifts are added until such discs cover the imaginary axis up to the highest frequency, and a strip to
either side of it.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import by_frequency
from pipeline.physics.numerics.sparse_solver import factorise

TWO_PI = 2.0 * np.pi
#: half width of the strip, as a share of the highest angular frequency
STRIP = 0.05
#: roots about a shift, at first and at most, and shifts at most
_NEAREST, _MOST, _SHIFTS = 40, 640, 200
#: roots of which there are so many at most are found all at once, without iteration; infinite ones, of what has no
#: mass, have inverses below this share of the largest
_FEW, _INFINITE = 8, 1e-14
#: radius of a disc over half the width of the strip, at least
_WIDE = 1.5
#: residual |T(s) x| / (|s|^2 |M x| + |s| |C x| + |K x|) above which a root is no root
_RESIDUAL = 1e-6
#: roots of two discs that differ by less, relative to the highest frequency, are one
_SAME = 1e-9
#: inverse iterations for the left vector
_LEFT = 3


@dataclass(frozen=True)
class Mode:
    """A root (1/s), its right and left vectors (n,) of unit length, its relative residual |T(s) x|."""

    root: complex
    right: np.ndarray
    left: np.ndarray | None
    residual: float


@dataclass(frozen=True)
class Found:
    """Modes with 0 < Im s <= the highest, by frequency; (d, 2) the discs that were searched: middle and radius, 1/s,
    which is infinite where all roots were found."""

    modes: tuple
    discs: np.ndarray

    @property
    def roots(self):
        """Roots (m,) 1/s of the modes."""
        return np.array([mode.root for mode in self.modes])


def strip_modes(matrices, highest, solver):
    """Found: all modes of sparse ``matrices`` (M, C, K) up to ``highest`` Hz within the strip about the imaginary axis.

    Raises ConvergenceError where roots are not found, one leaves a residual, or discs do not cover the strip.
    """
    top = TWO_PI * highest
    gaps, discs, modes = [(0.0, top)], [], []
    while gaps:
        if len(discs) >= _SHIFTS:
            raise ConvergenceError("complex modes", f"the strip covered by {_SHIFTS} discs", "gaps",
                                   "lower frequency_max")
        low, high = gaps.pop()
        shift = 1j * (low + high) / 2
        near, radius = _about(matrices, shift, _WIDE * STRIP * top, solver)
        modes += near
        discs.append((shift.imag, radius))
        reach = np.sqrt(radius**2 - (STRIP * top)**2)
        gaps += [(low, shift.imag - reach)] if shift.imag - reach > low else []
        gaps += [(shift.imag + reach, high)] if shift.imag + reach < high else []
    inside = [m for m in modes if _SAME * top < m.root.imag <= top and abs(m.root.real) <= STRIP * top]
    return Found(tuple(_once(inside, _SAME * top)), np.array(sorted(discs)))


def _about(matrices, shift, least, solver):
    """(Modes nearest to ``shift``, distance within which there is none besides, ``least`` at least)."""
    mass, damping, stiffness = matrices
    size = mass.shape[0]
    factor = factorise(shift**2 * mass + shift * damping + stiffness, solver, symmetric=False)

    def inverse(vector):
        place, speed = vector[:size], vector[size:]
        moved = factor.solve(-(mass @ speed + damping @ place + shift * (mass @ place)))
        return np.concatenate((moved, place + shift * moved))

    operator = scipy.sparse.linalg.LinearOperator((2 * size, 2 * size), inverse, dtype=complex)
    if 2 * size <= _FEW:
        inverted, vectors = np.linalg.eig(operator @ np.eye(2 * size))
        finite = abs(inverted) > _INFINITE * abs(inverted).max()
        roots = shift + 1 / inverted[finite]
        return [_mode(matrices, root, vector[:size]) for root, vector in zip(roots, vectors.T[finite], strict=True)
                ], np.inf
    count, most = min(_NEAREST, 2 * size - 2), min(_MOST, 2 * size - 2)
    while True:
        inverted, vectors = _largest(operator, count, shift)
        radius = (1 / abs(inverted)).max()
        if radius >= least or count == 2 * size - 2:
            break
        if count == most:
            raise ConvergenceError("complex modes", f"at most {most} roots within {least / TWO_PI:.3g} Hz of"
                                   f" {shift.imag / TWO_PI:.4g} Hz", "more", "lower frequency_max")
        count = min(2 * count, most)
    roots = shift + 1 / inverted
    modes = [_mode(matrices, root, vector[:size]) for root, vector in zip(roots, vectors.T, strict=True)]
    return modes, max(radius, least)


def _largest(operator, count, shift):
    """(values, vectors) of the ``count`` largest eigenvalues of an inverse about ``shift``."""
    start = np.random.default_rng(0).standard_normal(operator.shape[0]) + 0j
    try:
        return scipy.sparse.linalg.eigs(operator, count, v0=start, tol=1e-12, ncv=min(2 * count + 20, len(start)))
    except scipy.sparse.linalg.ArpackError as error:
        raise ConvergenceError("complex modes", f"{count} roots about {shift.imag / TWO_PI:.4g} Hz", str(error),
                               "lower frequency_max") from None


def _mode(matrices, root, vector):
    x = vector / np.linalg.norm(vector)
    return Mode(root, x, None, _residual(matrices, root, x))


def _residual(matrices, root, x):
    norm = np.linalg.norm
    inertia, drag, spring = (matrix @ x for matrix in matrices)
    whole = abs(root)**2 * norm(inertia) + abs(root) * norm(drag) + norm(spring)
    return float(norm(root**2 * inertia + root * drag + spring) / whole)


def _once(modes, apart):
    """Modes by frequency, each root once: of the same one the more exact."""
    kept = []
    for k in by_frequency(np.array([m.root for m in modes])):
        same = next((j for j in range(max(len(kept) - 8, 0), len(kept))
                     if abs(kept[j].root - modes[k].root) < apart
                     and abs(np.vdot(kept[j].right, modes[k].right)) > 0.5), None)
        if same is None:
            kept.append(modes[k])
        elif modes[k].residual < kept[same].residual:
            kept[same] = modes[k]
    worst = max(kept, key=lambda m: m.residual, default=None)
    if worst is not None and worst.residual > _RESIDUAL:
        raise ConvergenceError("complex modes", f"residuals below {_RESIDUAL:g}",
                               f"{worst.residual:.2g} at {worst.root.imag / TWO_PI:.5g} Hz")
    return kept


def with_left(mode, matrices, solver):
    """The Mode with its root polished by one step of Rayleigh's quotient, and its left vector.

    Raises ConvergenceError where its residual or that of the left vector exceeds what a root may leave.
    """
    mass, damping, stiffness = matrices
    beside = mode.root * (1 + 1e-7j)
    factor = factorise(beside**2 * mass + beside * damping + stiffness, solver, symmetric=False)
    x, y = mode.right, mode.right
    for _ in range(_LEFT):
        x, y = factor.solve(x), factor.solve(y, adjoint=True)
        x, y = x / np.linalg.norm(x), y / np.linalg.norm(y)
    root = mode.root
    for _ in range(_LEFT):
        inertia, drag = mass @ x, damping @ x
        left = root**2 * inertia + root * drag + stiffness @ x
        root = root - np.vdot(y, left) / np.vdot(y, 2 * root * inertia + drag)
    residual = _residual(matrices, root, x)
    other = _residual(tuple(matrix.conj().T for matrix in matrices), np.conj(root), y)
    if not max(residual, other) <= _RESIDUAL:
        raise ConvergenceError("complex modes", f"residuals below {_RESIDUAL:g} on both sides",
                               f"{residual:.2g} and {other:.2g} at {root.imag / TWO_PI:.5g} Hz")
    return Mode(root, x, y, residual)
