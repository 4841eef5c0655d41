"""Reduction of an elastic body to interface coordinates and modes, or to modes and residual flexibility.

An interface coordinate is a weighted average b = R u of the displacements of a patch (contact face, joint): R holds one
sparse row per coordinate. Craig & Bampton (AIAA J. 6 (1968) 1313) with such averaged interfaces reads

    u = Psi b + Phi p,    [K R^T; R 0] [Psi; L] = [0; I],    K phi - w^2 M phi + R^T l = 0 with R phi = 0,

and is the textbook method where R selects nodes. The body may be free as long as R restrains its rigid motions.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.sparse_solver import factorise

#: held modes sought at first; doubled until the frequency limit is passed
_FIRST_COUNT = 24


@dataclass(frozen=True)
class ReducedBody:
    """u = shape q: ``shape`` (n, k), ``mass`` and ``stiffness`` (k, k).

    The first ``boundary`` coordinates are averaged interface displacements; ``frequency`` (k - boundary,) Hz are those
    of the fixed-interface modes (Craig-Bampton), or of the modes and residual pseudo-modes (attachment).
    """

    shape: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    boundary: int
    frequency: np.ndarray


def craig_bampton(stiffness, mass, rows, below, solver, residual_below=None):
    """Interface coordinates ``rows @ u`` and all fixed-interface modes below a frequency.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse symmetric [N/m, kg]
    rows : (r, n) sparse, linearly independent, restraining all rigid motions of the body
    below : frequency limit of the fixed-interface modes [Hz]
    residual_below : the inertia of the constraint modes drives motions that the fixed-interface modes lack; their
        leading part, static and interface held, is added as pseudo-modes up to this frequency [Hz] (none by default).
        Errors then fall with the fourth instead of the second power of frequency over ``below``.
    solver : direct solver, see ``linear_solver.factorise``

    Raises ConfigError where the rows leave a rigid motion free or depend on one another.
    """
    rows = scipy.sparse.csr_matrix(rows)
    if rows.shape[0] == 0:
        raise ConfigError("Craig-Bampton reduction", "at least one interface row", "none",
                          "reduce a body without interfaces to its modes")
    held = _held(stiffness, rows, solver)
    frequency, fixed = _fixed_modes(held, mass, rows, below, solver)
    if residual_below is not None:
        driven = _without(fixed, mass, held.solve(mass @ held.constraint))
        more = _pseudo_modes(stiffness, mass, driven, residual_below)
        frequency, fixed = np.concatenate((frequency, more[0])), np.hstack((fixed, more[1]))
    shape = np.hstack((held.constraint, fixed))
    return ReducedBody(shape, projected(mass, shape), projected(stiffness, shape), rows.shape[0], frequency)


def attachment(stiffness, mass, rows, frequency, modes, below, factor):
    """Given mass-normalised modes of a body, with the residual static response to forces on ``rows``.

    The static responses K^-1 R^T are freed of their share in ``modes`` (n, m), ``frequency`` (m,) Hz; what is left is
    turned into mass-orthonormal pseudo-modes, of which those below the frequency ``below`` [Hz] are kept. With all of
    them the static response to interface forces is exact. ``factor`` is that of the stiffness, of a free body that of
    K + w^2 M with w well below its modes that are not given.
    """
    static = factor.solve(scipy.sparse.csr_matrix(rows).T.toarray())
    pseudo_frequency, pseudo = _pseudo_modes(stiffness, mass, _without(modes, mass, static), below)
    shape, frequency = np.hstack((modes, pseudo)), np.concatenate((frequency, pseudo_frequency))
    return ReducedBody(shape, np.eye(len(frequency)), np.diag((2 * np.pi * frequency) ** 2), 0, frequency)


def independent_rows(rows, tolerance=1e-6):
    """Indices of linearly independent rows of (r, n) sparse ``rows`` that span all of them, in rising order.

    A row counts as dependent when its part outside the others is below ``tolerance`` of its length.
    """
    rows = scipy.sparse.csr_matrix(rows)
    used = np.unique(rows.indices)
    dense = rows[:, used].toarray()
    length = np.linalg.norm(dense, axis=1)
    dense = dense[length > 0] / length[length > 0, None]
    if not len(dense):
        return np.empty(0, int)
    triangle, order = scipy.linalg.qr(dense.T, mode="r", pivoting=True)
    rank = int((abs(np.diag(triangle)) > tolerance).sum())
    return np.flatnonzero(length > 0)[np.sort(order[:rank])]


def projected(matrix, shape):
    """shape^T matrix shape, made exactly symmetric or antisymmetric where ``matrix`` is so; (k, k)."""
    small = shape.T @ (matrix @ shape)
    probe = np.random.default_rng(0).standard_normal(matrix.shape[0])
    forward, backward = matrix @ probe, matrix.T @ probe
    for sign in (1, -1):
        if np.allclose(forward, sign * backward, rtol=0, atol=1e-9 * abs(forward).max()):
            return (small + sign * small.T) / 2
    return small


def modal_damping(mass, stiffness, ratio):
    """C = M V diag(2 ratio w) V^T M (k, k): damping ratio ``ratio`` of every mode, none of rigid motions."""
    square, modes = scipy.linalg.eigh(stiffness, mass)
    inertia = mass @ modes
    return inertia * (2 * ratio * np.sqrt(np.maximum(square, 0.0))) @ inertia.T


@dataclass(frozen=True)
class _HeldBody:
    """The body with R u = 0, through A = K + k R^T R, which is regular and gives the same motions as K on R u = 0."""

    stiffness: "scipy.sparse.csr_matrix"    # A
    factor: object              # of A
    constraint: np.ndarray      # Psi = A^-1 R^T (R A^-1 R^T)^-1, the static shapes of unit interface coordinates
    rows: "scipy.sparse.csr_matrix"

    def solve(self, force):
        """u of K u + R^T l = force, R u = 0."""
        free = self.factor.solve(force)
        return free - self.constraint @ (self.rows @ free)


def _held(stiffness, rows, solver):
    restrained = (stiffness + stiffness.diagonal().mean() * (rows.T @ rows)).tocsr()
    try:
        factor = factorise(restrained, solver)
    except ConvergenceError as error:
        raise ConfigError("Craig-Bampton reduction", "rows that restrain all rigid motions of the body", str(error),
                          "add joints or contacts to the body") from None
    response = factor.solve(rows.T.toarray())
    flexibility = rows @ response
    if np.linalg.cond(flexibility) > 1e12:
        raise ConfigError("Craig-Bampton reduction", "linearly independent interface rows",
                          f"a flexibility of condition {np.linalg.cond(flexibility):.1e}", "see independent_rows")
    return _HeldBody(restrained, factor, np.linalg.solve(flexibility.T, response.T).T, rows)


def _fixed_modes(held, mass, rows, below, solver):
    """Frequencies (m,) Hz, ascending, and mass-normalised shapes (n, m) of the body with its interface held."""
    count, limit, largest = _FIRST_COUNT, (2 * np.pi * below) ** 2, mass.shape[0] - rows.shape[0] - 1
    square, shape = _lowest_held(held, mass, min(count, largest))
    while square[-1] < limit and count < largest:
        count *= 2
        square, shape = _lowest_held(held, mass, min(count, largest))
    square, shape = square[square < limit], shape[:, square < limit]
    expected = _held_modes_below(held.stiffness, mass, rows, below, solver)
    if expected not in (None, len(square)):
        raise ConvergenceError("fixed-interface modes", f"{expected} modes below {below:g} Hz (inertia)",
                               str(len(square)), "change the frequency limit a little")
    return np.sqrt(square) / (2 * np.pi), shape * np.sign(shape[abs(shape).argmax(axis=0), range(len(square))])


def _lowest_held(held, mass, count):
    """Squared angular frequencies (m,), ascending, and shapes (n, m), by Lanczos from a seeded start."""
    start = held.solve(np.random.default_rng(0).standard_normal(mass.shape[0]))
    inverse = scipy.sparse.linalg.LinearOperator(mass.shape, held.solve, dtype=float)
    try:
        square, shape = scipy.sparse.linalg.eigsh(held.stiffness, count, mass, sigma=0.0, OPinv=inverse, v0=start)
    except scipy.sparse.linalg.ArpackError as error:
        raise ConvergenceError("fixed-interface modes", f"{count} modes", str(error)) from None
    order = np.argsort(square)
    square, shape = square[order], shape[:, order]
    miss = (abs(held.solve(mass @ shape) * square - shape).max(axis=0) / abs(shape).max(axis=0)).max()
    if not miss < 1e-7:
        raise ConvergenceError("fixed-interface modes", "an error below 1e-7", f"{miss:.1e}")
    return square, shape


def _held_modes_below(stiffness, mass, rows, below, solver):
    """Number of held modes below a frequency: inertia of A - w^2 M less that of its interface flexibility.

    None where the solver cannot tell the inertia (row exchanges).
    """
    dynamic = factorise(stiffness - (2 * np.pi * below) ** 2 * mass, solver)
    if dynamic.negative is None:
        return None
    flexibility = rows @ dynamic.solve(rows.T.toarray())
    return dynamic.negative - int((np.linalg.eigvalsh((flexibility + flexibility.T) / 2) < 0).sum())


def _without(modes, mass, shapes):
    """The part of ``shapes`` outside the mass-orthonormal ``modes``, in their memory; projected twice against
    rounding."""
    for _ in range(2):
        shapes -= modes @ (modes.T @ (mass @ shapes))
    return shapes


def _pseudo_modes(stiffness, mass, residual, below):
    """Mass-orthonormal combinations of the ``residual`` shapes, whose memory it uses, that diagonalise the stiffness,
    below a frequency [Hz]."""
    image = stiffness @ residual
    image *= residual
    residual /= np.sqrt(image.sum(axis=0))
    del image
    energy, inertia = projected(stiffness, residual), projected(mass, residual)
    size, direction = scipy.linalg.eigh(energy)
    kept = direction[:, size > 1e-10 * size[-1]] / np.sqrt(size[size > 1e-10 * size[-1]])
    flexibility, combination = scipy.linalg.eigh(kept.T @ inertia @ kept)
    combination, flexibility = (kept @ combination)[:, ::-1], flexibility[::-1]
    wanted = flexibility > 1 / (2 * np.pi * below) ** 2
    pseudo = residual @ combination[:, wanted] / np.sqrt(flexibility[wanted])
    return 1 / (2 * np.pi * np.sqrt(flexibility[wanted])), pseudo
