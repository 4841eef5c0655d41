"""Roots of the finite-element matrices without reduction, near those of a reduced model, and their residuals.

A reduced model is a projection, so that its roots are off by what its basis leaves out of the right vectors times what
it leaves out of the left ones. On the full matrices T(s) = s^2 M + s C + K, sparse and about the same sliding state,

    x <- T(s0)^-1 T'(s0) x,    then    y^H T(s) x = 0,    x <- x - T(s0)^-1 T(s) x,

where the first steps answer the contact motion of the reduced mode and the others are residual inverse iteration (see
``polished``). The factor of T(s0) at one operating point serves its neighbours at other speeds as well, as long as the
contacts then move as in the reduced mode.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import polished
from pipeline.physics.numerics.dense_factor import product
from pipeline.physics.numerics.sparse_solver import factorise

#: inverse iterations from the contact motion of the reduced mode
_STARTS = 3
#: rounds of residual inverse iteration until the residual meets its tolerance
_ROUNDS = 5
#: frequencies of one family differ from the next by no more than this share
_FAMILY = 5e-3
#: a root farther from that of the reduced model, as a share of it, is another one
_FARTHEST = 5e-2
#: MAC of the contact motion above which a root from the factor of another operating point is the one sought, and below
#: which even that from a factor of its own is another one
_ALIKE, _SAME = 0.95, 0.5


@dataclass(frozen=True)
class Guess:
    """A ``root`` (1/s) of a reduced model and the motion (c,) of the contacts in it along ``rows`` (c, n) of the full
    one, whose ``matrices`` are sparse (M, C, K)."""

    root: complex
    motion: np.ndarray
    rows: "scipy.sparse.csr_matrix"
    matrices: tuple


@dataclass(frozen=True)
class FullRoot:
    """A root (1/s), its vector (n,), its residual |T(s) x| / |K x|, the MAC of its contact motion with the guess."""

    root: complex
    vector: np.ndarray
    residual: float
    likeness: float


def sliding_as(full, model):
    """The SlidingModel ``full`` of the same system in the sliding state and at the speed of the reduced ``model``."""
    rows = {name: getattr(full.contacts, name) for name in ("normal", "tangent", "lateral")}
    return replace(full, speed=model.speed, contacts=replace(model.contacts, **rows))


def families(roots, state):
    """Indices of ``roots`` (r,) of one ``state`` (r,) and nearly one frequency: arrays, from the middle out."""
    order = np.lexsort((roots.imag, state))
    frequency, state = roots.imag[order], np.asarray(state)[order]
    apart = (np.diff(state) != 0) | (np.diff(frequency) > _FAMILY * frequency[1:])
    return [group[np.argsort(abs(roots[group] - roots[group].mean()), kind="stable")]
            for group in np.split(order, np.flatnonzero(apart) + 1)]


def full_roots(guesses, solver, tolerance):
    """A FullRoot for each Guess of a family of operating points, the first of which should be in its middle.

    Raises ConvergenceError where a residual exceeds ``tolerance`` or no such mode lies near the guess.
    """
    factors, solved = _Factors(solver), []
    for guess in guesses:
        mode = _from(guess, factors, tolerance) if factors.ready else None
        if mode is None or mode.likeness < _ALIKE:
            mass, damping, stiffness = guess.matrices
            factors.renew(guess.root**2 * mass + guess.root * damping + stiffness)
            mode = _from(guess, factors, tolerance)
        if not mode.residual <= tolerance or mode.likeness < _SAME or abs(mode.root / guess.root - 1) > _FARTHEST:
            raise _not_there(guess, mode, tolerance)
        solved.append(mode)
    return solved


class _Factors:
    """The sparse factor in use, if it is ``ready``; another takes its place after its memory was released."""

    def __init__(self, solver):
        self._solver, self._factor = solver, None

    @property
    def ready(self):
        return self._factor is not None

    def renew(self, matrix):
        self._factor = None
        self._factor = factorise(matrix, self._solver, symmetric=False)

    def solve(self, rhs, adjoint=False):
        return self._factor.solve(rhs, adjoint)


def _from(guess, factors, tolerance):
    """FullRoot from a Guess and a factor of T near it, which may give way to another."""
    (mass, damping, stiffness), root = guess.matrices, guess.root
    x, residual, norm = factors.solve(guess.rows.T @ guess.motion), np.inf, np.linalg.norm
    for _ in range(_STARTS):
        x = x / norm(x)
        x = factors.solve(2 * root * product(mass, x) + product(damping, x))
    for _ in range(_ROUNDS):
        root, x = polished(mass, damping, stiffness, root, x, factors=factors, accuracy=tolerance)
        forces = stiffness @ x
        residual = norm(root * (root * product(mass, x) + product(damping, x)) + forces) / norm(forces)
        if residual <= tolerance:
            break
    moved = guess.rows @ x
    likeness = (abs(np.vdot(moved, guess.motion)) / (norm(moved) * norm(guess.motion))) ** 2
    return FullRoot(root, x, float(residual), float(likeness))


def _not_there(guess, mode, tolerance):
    return ConvergenceError(
        "complex modes: full finite-element matrices",
        f"the mode of the reduced model within {_FARTHEST:.0%} of {guess.root:.6g} 1/s, residual {tolerance:g}",
        f"{mode.root:.6g} 1/s, residual {mode.residual:.2g}, MAC of the contact motion {mode.likeness:.2g}",
        "enlarge the bases of reduced_model, or set complex_modes.residual_tolerance: null")
