"""Roots of the finite-element matrices without reduction, near those of a reduced model, and their residuals.

A reduced model is a projection, so that its roots are off by what its basis leaves out of the right vectors times what
it leaves out of the left ones. On the full matrices T(s) = s^2 M + s C + K, sparse and about a sliding state, a
root is sought in a subspace of motions. It begins with the answer to the friction forces of the reduced mode, and grows
by S^-1 T(s) x, x being the mode of T projected on it (nonlinear Arnoldi iteration: H. Voss, BIT Numer. Math. 44 (2004)
387). S is the symmetric part of T(s0), whose factor, in single precision, takes a fifth of the time of one of T(s0): it
says where to go on, not what the root is. Operating points and modes of nearly one frequency share S and the subspace,
those of one brake the order in which S is factorised.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.sparse_solver import Successive
from pipeline.physics.sliding.shared_operator import SharedOperator, SlidingPoint, Subspace

#: vectors of a subspace, and rounds that each add one for every root
_MOST, _ROUNDS = 96, 30
#: the last change of a root, as a share of it, and a residual that is rounding, after which there is none
_ROOT, _EXACT = 1e-9, 1e-13
#: frequencies of a family differ from its middle by no more than this share
_FAMILY = 1e-2
#: a root farther from that of the reduced model, as a share of it, is another one
_FARTHEST = 5e-2
#: MAC of the contact motion above which a root in the subspace of others is the one sought, and below which even that
#: in a subspace of its own is another one
_ALIKE, _SAME = 0.95, 0.5


@dataclass(frozen=True)
class Guess:
    """A ``root`` (1/s) of a reduced model, the motion (3c,) of the contacts in it, n, t and l, and where it slides."""

    root: complex
    motion: np.ndarray
    point: SlidingPoint


@dataclass(frozen=True)
class FullRoot:
    """A root (1/s), its vector (n,), its residual |T(s) x| / |K x|, the MAC of its contact motion with the guess, and
    whether residual and root have ``settled``."""

    root: complex
    vector: np.ndarray
    residual: float
    likeness: float
    settled: bool


def sliding_as(full, model):
    """The SlidingModel ``full`` of the same system in the sliding state and at the speed of the reduced ``model``."""
    rows = {name: getattr(full.contacts, name) for name in ("normal", "tangent", "lateral")}
    return replace(full, speed=model.speed, contacts=replace(model.contacts, **rows))


def families(roots, state):
    """Indices of ``roots`` (r,) 1/s of one ``state`` (r,) and nearly one frequency: arrays, from their middle out."""
    order, groups = np.lexsort((roots.imag, state)), []
    while len(order):
        frequency, first = roots.imag[order], order[0]
        near = (state[order] == state[first]) & (frequency <= frequency[0] * (1 + _FAMILY) / (1 - _FAMILY))
        group, order = np.sort(order[near]), order[~near]
        groups.append(group[np.argsort(abs(np.arange(len(group)) - (len(group) - 1) / 2), kind="stable")])
    return groups


def full_roots(guesses: list, operator: SharedOperator, factors: Successive, tolerance: float) -> list:
    """A FullRoot for each Guess of a family, the first of which should be in its middle, on a SharedOperator;
    ``factors``, of this operator alone, are left for other families.

    Raises ConvergenceError where a residual exceeds ``tolerance`` or no such mode lies near the guess.
    """
    modes = _Search(operator, guesses[0], factors).modes(guesses, tolerance)
    for k, (guess, mode) in enumerate(zip(guesses, modes, strict=True)):
        if _missed(guess, mode) or mode.likeness < _ALIKE:
            modes[k] = mode = _Search(operator, guess, factors).modes([guess], tolerance)[0]
        if _missed(guess, mode):
            raise _not_there(guess, mode, tolerance)
    return modes


def _missed(guess, mode):
    """Whether a FullRoot is none, or not that of a Guess."""
    return not mode.settled or mode.likeness < _SAME or abs(mode.root / guess.root - 1) > _FARTHEST


class _Search:
    """The subspace in which roots are sought together, and the factor with which it grows."""

    def __init__(self, operator, guess, factors):
        self._operator, self._space = operator, Subspace(operator, _MOST)
        self._factor = factors.factor(operator.symmetric(guess.point, guess.root))

    def modes(self, guesses, tolerance):
        """[FullRoot] from Guesses, each as it is after as many rounds as are allowed and there is room for."""
        modes, left = [None] * len(guesses), list(range(len(guesses)))
        forces = np.stack([self._operator.moving(g.point, g.root, g.motion) for g in guesses], axis=1)
        for _ in range(_ROUNDS):
            if self._space.room < len(left):
                break
            self._space.add(self._factor.solve(forces))
            found, forces = self._projected([guesses[k] for k in left], [modes[k] for k in left], tolerance)
            for k, mode in zip(left, found, strict=True):
                modes[k] = mode
            forces = forces[:, [not mode.settled for mode in found]]
            left = [k for k in left if not modes[k].settled]
            if not left:
                break
        return modes

    def _projected(self, guesses, before, tolerance):
        """([FullRoot of each Guess], the forces (n, g) that they leave) in the subspace as it is; ``before``: those of
        the round before, or None."""
        roots, weights, likeness = map(np.array, zip(*map(self._likest, guesses), strict=True))
        vectors = self._space.vectors(weights.T)
        left, elastic = self._operator.forces([guess.point for guess in guesses], roots, vectors)
        residual = np.linalg.norm(left, axis=0) / np.linalg.norm(elastic, axis=0)
        moved = [np.inf if old is None else abs(old.root - root) for old, root in zip(before, roots, strict=True)]
        settled = (residual <= tolerance) & ((moved <= _ROOT * abs(roots)) | (residual <= _EXACT))
        modes = [FullRoot(complex(root), x, float(r), float(mac), bool(done)) for root, x, r, mac, done in
                 zip(roots, vectors.T, residual, likeness, settled, strict=True)]
        return modes, left

    def _likest(self, guess):
        """(root, weight (m,) of the vectors, MAC) of the mode near a Guess whose contacts move most as in it."""
        root, weight = small_modes(*self._space.matrices(guess.point), abs(guess.root))
        near = np.flatnonzero(abs(root / guess.root - 1) <= _FARTHEST)
        near = near if len(near) else np.array([np.argmin(abs(root - guess.root))])
        moved, norm = self._space.motion(weight[:, near]), np.linalg.norm
        likeness = (abs(guess.motion.conj() @ moved) / (norm(moved, axis=0) * norm(guess.motion))) ** 2
        best = int(np.argmax(likeness))
        return root[near[best]], weight[:, near[best]], likeness[best]


def small_modes(mass, damping, stiffness, pace):
    """(roots (2m,) 1/s, vectors (m, 2m)) of complex matrices (m, m), of roots of about the size ``pace`` 1/s."""
    m = len(mass)
    lower = -np.linalg.solve(pace**2 * mass, np.hstack((stiffness, pace * damping)))
    value, vector = np.linalg.eig(np.vstack((np.eye(m, 2 * m, m), lower)))
    return pace * value, vector[:m]


def _not_there(guess, mode, tolerance):
    return ConvergenceError(
        "complex modes: full finite-element matrices",
        f"the mode of the reduced model within {_FARTHEST:.0%} of {guess.root:.6g} 1/s, residual {tolerance:g}",
        f"{mode.root:.6g} 1/s, residual {mode.residual:.2g}, MAC of the contact motion {mode.likeness:.2g}",
        "enlarge the bases of reduced_model, or set complex_modes.residual_tolerance: null")
