"""Modes of large sparse systems from what they are like: roots and vectors of T(s) x = (s^2 M + s C + K) x = 0 nearby.

Modes of about one frequency share a factor of S, which is T(s0) or its symmetric part, in single precision, and a
search space V (nonlinear Arnoldi; H. Voss, BIT 44 (2004) 387):

    V = [S^-1 f],    V^H T(theta) V y = 0,    V <- [V, S^-1 T(theta) V y],

f being forces that move the system much as each mode does. Of the pairs (theta, V y) the one counts as the mode sought
that moves most like it; residuals are those of double precision, until each meets its tolerance.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.modal.quadratic_eigenproblem import quadratic_pairs
from pipeline.physics.modal.shape_matching import assurance
from pipeline.physics.numerics.dense_factor import product
from pipeline.physics.numerics.orthonormal import orthonormal_beside, within

#: inverse iterations for each mode before the first search
_STARTS = 2
#: rounds of the search, and those after which what is still no mode has more vectors of its own added
_ROUNDS, _WIDENED = 30, 15
#: part of vectors that is new to the search space, below which it adds nothing
_NEW = 1e-8
#: change of a root, as a share of it, that ends the search where the residual is small enough
_SETTLED = 1e-7
#: a mode lies within this share of the frequency sought, and moves like it by a MAC of at least so much
FARTHEST, ALIKE = 5e-2, 0.5


@dataclass(frozen=True)
class Followed:
    """Of each mode sought (g,): ``root`` 1/s, nan where there is none like it; ``vector`` (n, g), ``residual`` |T x| /
    |K x| and the MAC of its motion with what was sought, ``likeness``."""

    root: np.ndarray
    vector: np.ndarray
    residual: np.ndarray
    likeness: np.ndarray


def followed_roots(matrices: tuple, solve: Callable, sought: np.ndarray, forces: np.ndarray, rows: object,
                   motion: np.ndarray, tolerance: float) -> Followed:
    """Followed modes of one family.

    ``matrices``: sparse (M, C, K), complex ones allowed; ``solve(b)``: S^-1 b, about; ``sought`` (g,) 1/s roots of
    another model, ``forces`` (n, g) that move the system like their modes, ``motion`` (r, g) of these along the sparse
    ``rows`` (r, n); ``tolerance`` of the residuals.
    """
    space, x = _Space(matrices, rows), solve(forces)
    for _ in range(_STARTS):
        space.add(x)
        x = solve(_slope(matrices, sought, x / np.linalg.norm(x, axis=0)))
    space.add(x)
    before = np.full(len(sought), np.inf, complex)
    for turn in range(_ROUNDS):
        root, weights, likeness = _most_like(space, sought, motion)
        off, residual = space.residuals(root, weights)
        done = (residual <= tolerance) & (abs(root - before) <= _SETTLED * abs(root)) & (likeness >= ALIKE)
        if done.all():
            break
        before, left = root, off[:, ~done]
        if turn >= _WIDENED:
            left = np.hstack((left, _slope(matrices, sought[~done], space.basis @ weights[:, ~done])))
        space.add(solve(left))
    vector = space.basis[:, :len(weights)] @ weights
    return Followed(np.where(done, root, complex(np.nan, np.nan)), vector, residual, likeness)


class _Space:
    """Orthonormal vectors (n, m), what ``rows`` and M, C and K make of them, and the projections (m, m) of these."""

    def __init__(self, matrices, rows):
        self._matrices, self._rows, self._count = matrices, rows, 0
        self._vectors, *self._images, self._seen = (np.empty((of.shape[0], 0), complex) for of in
                                                    (matrices[0], *matrices, rows))
        self.small = [np.empty((0, 0), complex)] * len(matrices)

    @property
    def basis(self):
        """(n, m)."""
        return self._vectors[:, :self._count]

    @property
    def seen(self):
        """What the rows make of the vectors (r, m)."""
        return self._seen[:, :self._count]

    def add(self, vectors):
        """Add what is new in ``vectors`` (n, g), none of them zero."""
        before, m = self.basis, self._count
        new = orthonormal_beside(before, vectors / np.linalg.norm(vectors, axis=0), _NEW)
        self._count += new.shape[1]
        self._vectors, self._seen = _filled(self._vectors, m, new), _filled(self._seen, m, self._rows @ new)
        for k, matrix in enumerate(self._matrices):
            image = product(matrix, new)
            below = within(new, self._images[k][:, :m])
            self.small[k] = np.block([[self.small[k], within(before, image)], [below, within(new, image)]])
            self._images[k] = _filled(self._images[k], m, image)

    def residuals(self, root, weights):
        """(T(s) x (n, g), its size over that of K x (g,)) of roots (g,) and vectors with ``weights`` (m, g)."""
        inertia, drag, forces = (image[:, :self._count] @ weights for image in self._images)
        off = root * (root * inertia + drag) + forces
        return off, np.linalg.norm(off, axis=0) / np.linalg.norm(forces, axis=0)


def _filled(columns, count, new):
    """Room for columns (n, ...), of which ``count`` are in use, with ``new`` (n, g) beside these."""
    room = count + new.shape[1]
    if room > columns.shape[1]:
        larger = np.empty((len(columns), max(room, 2 * count)), complex, order="F")
        larger[:, :count], columns = columns[:, :count], larger
    columns[:, count:room] = new
    return columns


def _most_like(space, sought, motion):
    """(root (g,), weights (m, g), likeness (g,)) of the pairs of a search space that move most like those sought."""
    value, right = quadratic_pairs(*space.small)
    likeness = assurance(motion.T, (space.seen @ right).T)
    likeness[abs(value.imag / sought.imag[:, None] - 1) > FARTHEST] = 0.0
    mode, pair = scipy.optimize.linear_sum_assignment(likeness, maximize=True)
    chosen = pair[np.argsort(mode)]
    return value[chosen], right[:, chosen], likeness[np.arange(len(sought)), chosen]


def _slope(matrices, root, x):
    return 2 * root * product(matrices[0], x) + product(matrices[1], x)
