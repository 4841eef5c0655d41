"""All roots of a large sparse system (s^2 M + s C + K) x = 0 in a strip along the imaginary axis.

Shift-invert Arnoldi about a shift on the imaginary axis finds the ``count`` roots nearest to it, that is all roots
in a disc. Shifts are added in the gaps until the discs cover the strip. Neighbouring discs overlap and check one
another: a disc that lacks a root which another one found is trusted only up to that root, and the gap left is
covered anew. A root of multiplicity m must be found m times.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse.linalg import ArpackError, LinearOperator, eigs

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.linear_solver import factorise

#: roots closer than this share of the strip's height are copies of one root found twice
_SAME = 1e-7
#: share of the radius within which a disc must hold every root
_INSIDE = 1 - 1e-6


@dataclass(frozen=True)
class StripModes:
    """Roots (k,) 1/s by rising imaginary part, right vectors (n, k), relative residuals (k,), shifts used."""

    value: np.ndarray
    right: np.ndarray
    residual: np.ndarray
    shift: np.ndarray


@dataclass(frozen=True)
class _Disc:
    """All roots within ``radius`` of ``centre``."""

    centre: complex
    radius: float
    value: np.ndarray
    right: np.ndarray

    def lacks(self, roots, same):
        """Of ``roots`` inside this disc, those that it holds fewer times than they appear."""
        inside = roots[abs(roots - self.centre) < _INSIDE * self.radius]
        return np.array([s for s in inside if _copies(s, roots, same) > _copies(s, self.value, same)])


def strip_modes(mass, damping, stiffness, highest, half_width, solver, count=40, tolerance=1e-8, most_shifts=40):
    """All modes with 0 <= Im s <= ``highest`` and abs(Re s) <= ``half_width``, both in 1/s.

    Parameters
    ----------
    mass, damping, stiffness : (n, n) sparse, real; the latter two may be unsymmetric
    solver : direct solver, see ``linear_solver.factorise``
    count : roots sought per shift, less than 2 n - 1
    tolerance : largest residual of (s^2 M + s C + K) x relative to the sum of its three terms

    Raises ConvergenceError when a residual is larger, or the strip is not covered after ``most_shifts`` shifts.
    """
    if not 0 < count < 2 * mass.shape[0] - 1:
        raise ConfigError("complex modes: count", f"1 to {2 * mass.shape[0] - 2} for {mass.shape[0]} coordinates",
                          str(count), "solve a small system densely (quadratic_modes)")
    discs, queue, same = [], [highest / 4, 3 * highest / 4], _SAME * highest
    while queue:
        if len(discs) == most_shifts:
            raise ConvergenceError("complex modes in a strip", f"a covered strip after {most_shifts} shifts",
                                   f"a gap at {queue[0] / (2 * np.pi):.6g} Hz", "raise count or most_shifts")
        disc = _disc(mass, damping, stiffness, 1j * queue.pop(0), highest, solver, count)
        if disc.radius <= half_width:
            raise ConvergenceError("complex modes in a strip", f"discs wider than {half_width:.4g} 1/s",
                                   f"a radius of {disc.radius:.4g}", "raise count or narrow the strip")
        discs = _mutually_trusted([*discs, disc], same)
        queue = queue or _gaps(discs, highest, half_width)
    return _collected(discs, mass, damping, stiffness, highest, half_width, tolerance)


def _disc(mass, damping, stiffness, shift, pace, solver, count):
    """The ``count`` roots nearest to ``shift``; Arnoldi on the state (x, s x / pace), from a seeded start."""
    n = mass.shape[0]
    factor = factorise(stiffness + shift * damping + shift**2 * mass, solver, symmetric=False)

    def inverse(state):
        """1 / (s - shift) about the shift, for the pencil s [[C, pace M], [I, 0]] = [[-K, 0], [0, pace I]]."""
        place, rate = state[:n], state[n:]
        force = damping @ place + pace * (mass @ rate) + shift * (mass @ place)
        moved = -factor.solve(force)
        return np.concatenate((moved, (place + shift * moved) / pace))

    start = np.random.default_rng(0).standard_normal(2 * n) + 0j
    try:
        inverse_distance, states = eigs(LinearOperator((2 * n, 2 * n), inverse, dtype=complex), count, v0=start,
                                        which="LM", tol=1e-11)
    except ArpackError as error:
        raise ConvergenceError("complex modes in a strip", "Arnoldi iteration to converge", str(error)) from None
    roots = shift + 1 / inverse_distance
    right = states[:n] / np.linalg.norm(states[:n], axis=0)
    return _Disc(shift, abs(roots - shift).max(), roots, right)


def _mutually_trusted(discs, same):
    """The discs, each cut back to the nearest root that another disc found inside it and it did not."""
    trusted = []
    for disc in discs:
        missed = [s for other in discs for s in disc.lacks(other.value, same)]
        radius = min([disc.radius, *(abs(s - disc.centre) for s in missed)])
        trusted.append(replace(disc, radius=radius))
    return trusted


def _gaps(discs, highest, half_width):
    """Midpoints of the parts of the strip that no disc covers over its whole width."""
    reach = [np.sqrt(max((_INSIDE * d.radius) ** 2 - half_width**2, 0.0)) for d in discs]
    spans = sorted((d.centre.imag - r, d.centre.imag + r) for d, r in zip(discs, reach, strict=True))
    gaps, covered = [], 0.0
    for low, high in [*spans, (highest, highest)]:
        if low > covered:
            gaps.append((covered + min(low, highest)) / 2)
        covered = max(covered, high)
        if covered >= highest:
            break
    return gaps


def _collected(discs, mass, damping, stiffness, highest, half_width, tolerance):
    """Union of the discs without copies, cut to the strip, with checked residuals."""
    values, vectors = np.empty(0, complex), []
    for disc in discs:
        for s, x in zip(disc.value, disc.right.T, strict=True):
            if _copies(s, values, _SAME * highest) < _copies(s, disc.value, _SAME * highest):
                values, vectors = np.append(values, s), [*vectors, x]
    inside = (values.imag >= -_SAME * highest) & (values.imag <= highest) & (abs(values.real) <= half_width)
    order = np.flatnonzero(inside)[np.argsort(values[inside].imag)]
    value = values[order]
    right = np.array(vectors)[order].T
    residual = _residuals(mass, damping, stiffness, value, right, highest)
    if len(value) and not residual.max() <= tolerance:
        raise ConvergenceError("complex modes in a strip", f"relative residuals below {tolerance:.1e}",
                               f"{residual.max():.1e}", "scale the matrices, or raise the tolerance")
    return StripModes(value, right, residual, np.array([d.centre for d in discs]))


def _residuals(mass, damping, stiffness, value, right, highest):
    """abs((s^2 M + s C + K) x) over the sum of the three terms, where s counts at least 1e-3 of ``highest``."""
    inertia, viscous, elastic = mass @ right, damping @ right, stiffness @ right
    size, norm = np.maximum(abs(value), 1e-3 * highest), np.linalg.norm
    scale = size**2 * norm(inertia, axis=0) + size * norm(viscous, axis=0) + norm(elastic, axis=0)
    return norm(value**2 * inertia + value * viscous + elastic, axis=0) / scale


def _copies(root, roots, same):
    return int((abs(roots - root) < same).sum())
