"""T(s) = s^2 M + s C + K of a large sparse SlidingModel about its sliding states, in parts that all of these share.

    T(s) = s^2 M + s (C + W G) + K + W^2 Kc + B^T (D + s E) B,    B = (n; t; l)

The bodies stand in M, C, G, K and Kc, so that what these make of a motion serves every operating point: two of them
differ in the speed W and in the coefficients D and E of the contacts alone.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.physics.numerics.half_matrices import Half
from pipeline.physics.numerics.orthonormal import orthonormal_beside, within
from pipeline.physics.numerics.sparse_solver import Upper
from pipeline.physics.system.terms import What

#: powers of W that the terms of what turns stand with
_TURNS = {What.GYROSCOPIC: 1, What.CENTRIFUGAL: 2}
#: what is left of a vector of unit length that counts as rounding
_ROUNDING = 1e-12


@dataclass(frozen=True)
class SlidingPoint:
    """``speed`` W of the drive, and the sparse coefficients (3c, 3c) of the contacts: ``by_place`` D N/m, ``by_speed``
    E N s/m."""

    speed: float
    by_place: "scipy.sparse.csr_matrix"
    by_speed: "scipy.sparse.csr_matrix"

    @classmethod
    def of(cls, model, friction, friction_damping=True):
        """Of a SlidingModel, dense or sparse, about steady sliding; arguments and errors as of its ``linearised``."""
        count = len(model.contacts.area)
        rows, none = scipy.sparse.identity(3 * count, format="csr"), scipy.sparse.csr_matrix((3 * count,) * 2)
        contacts = replace(model.contacts, normal=rows[:count], tangent=rows[count:2 * count], lateral=rows[2 * count:])
        alone = replace(model, mass=none, damping=none, gyroscopic=none, stiffness=none, centrifugal=none,
                        joints=replace(model.joints, rows=none[:0], stiffness=np.empty(0), damping=np.empty(0)),
                        contacts=contacts)
        _, by_speed, by_place = alone.linearised(friction, friction_damping)
        return cls(model.speed, by_place, by_speed)


@dataclass(frozen=True)
class SharedOperator:
    """``terms``: each the Half of a matrix (n, n), real or complex, and the powers of s and W that it stands with; all
    are symmetric but the gyroscopic one, which is real and skew. ``rows`` B (3c, n)."""

    terms: tuple
    rows: "scipy.sparse.csr_matrix"

    @classmethod
    def of(cls, model, gyroscopic=True, centrifugal=True):
        """Of a sparse SlidingModel, at any speed and sliding state."""
        contacts, halves = model.contacts, []
        for term in model.at_speed(1.0).supporting(gyroscopic, centrifugal).terms:
            if (matrix := term.matrix).count_nonzero():
                skew = -1 if term.name == What.GYROSCOPIC else 1
                halves.append((Half(matrix, skew), term.kind.order, _TURNS.get(term.name, 0)))
        return cls(tuple(halves),
                   scipy.sparse.vstack((contacts.normal, contacts.tangent, contacts.lateral), format="csr"))

    def symmetric(self, point, root):
        """The symmetric part of T(``root``), an Upper in single precision, at a SlidingPoint: without what friction
        transfers from normal to tangential motion, and without what turns with the speed."""
        contact = (point.by_place + root * point.by_speed).diagonal()
        each = np.arange(len(contact) + 1)      # open ones too, so that entries are at the same places in any state
        pressed = scipy.sparse.csr_matrix((contact, each[:-1], each)) @ self.rows
        whole = scipy.sparse.triu(self.rows.T @ pressed, format="csr").astype(np.complex64)
        whole.sort_indices()        # sums of sorted rows are quick
        for half, order, power in sorted(self.terms, key=lambda term: term[0].size):
            if not power:
                whole = whole + half.upper(root**order if order else 1)
        return Upper(whole)

    def drawn(self, point, root, motion):
        """(n,) N: forces of friction at a ``motion`` (3c,) of the contacts, which ``symmetric`` leaves out."""
        coupling = point.by_place + root * point.by_speed
        return self.rows.T @ ((coupling - scipy.sparse.diags(coupling.diagonal())) @ motion)

    def moving(self, point, root, motion):
        """(n,) N: forces that move the system much as a mode of which the contacts' ``motion`` (3c,) is known: those of
        friction or, where there are none, some at the contacts that move."""
        drawn = self.drawn(point, root, motion)
        return drawn if drawn.any() else self.rows.T @ motion

    def images(self, vectors):
        """[(A x, A^H x), each (n, g), of every term A] and x of complex ``vectors`` (n, g)."""
        return [half.images(vectors) for half, *_ in self.terms]

    def forces(self, points, roots, vectors):
        """(T(s) x, K x), each (n, g) N, of motions x (n, g) at SlidingPoints and ``roots`` s (g,)."""
        whole, elastic = np.zeros_like(vectors), np.zeros_like(vectors)
        for (_, order, power), (image, _) in zip(self.terms, self.images(vectors), strict=True):
            image = image * [point.speed**power for point in points]
            elastic += 0.0 if order else image
            whole += roots**order * image
        moved = self.rows @ vectors
        pressed, dragged = (np.stack([getattr(point, name) @ moved[:, k] for k, point in enumerate(points)], axis=1)
                            for name in ("by_place", "by_speed"))
        return whole + self.rows.T @ (pressed + roots * dragged), elastic + self.rows.T @ pressed


class Subspace:
    """Orthonormal vectors (n, m) of which motions are made, and a SharedOperator between them."""

    def __init__(self, operator, most):
        """Empty, with room for so many vectors at ``most``."""
        self._operator, self._count = operator, 0
        self._vectors = np.empty((operator.rows.shape[1], most), complex, order="F")
        self._small = np.empty((len(operator.terms), most, most), complex)
        self._moved = np.empty((operator.rows.shape[0], most), complex, order="F")

    def __len__(self):
        """Number of vectors m."""
        return self._count

    @property
    def room(self):
        """How many vectors more there is room for."""
        return self._vectors.shape[1] - self._count

    def add(self, vectors):
        """What ``vectors`` (n, g), none of them zero, add to those that are there; there must be room for all."""
        m = self._count
        new = orthonormal_beside(self._vectors[:, :m], np.asarray(vectors, complex), _ROUNDING)
        part, self._count = slice(m, m + new.shape[1]), m + new.shape[1]
        self._vectors[:, part], self._moved[:, part] = new, self._operator.rows @ new
        whole = self._vectors[:, :self._count]
        for small, (image, adjoint) in zip(self._small, self._operator.images(new), strict=True):
            small[:self._count, part] = within(whole, image)
            small[part, :m] = within(whole[:, :m], adjoint).conj().T

    def matrices(self, point):
        """(M, C, K), each (m, m), at a SlidingPoint, projected on the vectors."""
        m, moved, parts = self._count, self._moved[:, :self._count], [0.0, 0.0, 0.0]
        for (_, order, power), small in zip(self._operator.terms, self._small, strict=True):
            parts[order] = parts[order] + point.speed**power * small[:m, :m]
        by_place, by_speed = (moved.conj().T @ (each @ moved) for each in (point.by_place, point.by_speed))
        return parts[2], parts[1] + by_speed, parts[0] + by_place

    def motion(self, weight):
        """B x (3c, ...) of motions x by their ``weight`` (m, ...) of the vectors."""
        return self._moved[:, :self._count] @ weight

    def vectors(self, weight):
        """x (n, ...)."""
        return self._vectors[:, :self._count] @ weight
