"""Systems given as matrices that change with speed and friction: s^2 M + s C + K + i H, each a sum of scaled terms.

    T(s) = sum over terms t of  f_t s^order_t  c_t(speed, friction)  A_t,    f = i for losses H, else 1,
    c(speed, friction) = sum over k of  a_k speed^m_k friction^n_k
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.modal.root_derivatives import scaled

#: powers of s that the kinds of matrices stand with
ORDERS = {"loss": 0, "stiffness": 0, "damping": 1, "mass": 2}


@dataclass(frozen=True)
class Term:
    """A sparse matrix (n, n) of a ``kind`` (mass, damping, stiffness or loss), times its summands (a, m, n)."""

    name: str
    kind: str
    matrix: "scipy.sparse.csr_matrix"
    summands: tuple

    def factor(self, speed, friction):
        """c(speed, friction)."""
        return sum(a * speed**m * friction**n for a, m, n in self.summands)

    def slopes(self, speed, friction):
        """(dc/d ln speed, dc/d ln friction); the second at no friction is that to friction itself, times 0."""
        parts = [(a * speed**m * friction**n, m, n) for a, m, n in self.summands]
        return sum(m * c for c, m, _ in parts), sum(n * c for c, _, n in parts)


@dataclass(frozen=True)
class MatrixFamily:
    """Terms (n, n) of one system."""

    terms: tuple

    @property
    def size(self):
        """Degrees of freedom."""
        return self.terms[0].matrix.shape[0]

    def at(self, speed, friction):
        """(M, C, K) (n, n) sparse at a speed and a coefficient of friction, each over that of the matrices.

        With terms of loss H, which hold for frequencies above 0, K is complex: K + i H.
        """
        mass, damping, stiffness, loss = (
            sum((term.factor(speed, friction) * term.matrix for term in self.terms if term.kind == kind),
                scipy.sparse.csr_matrix((self.size, self.size))) for kind in ("mass", "damping", "stiffness", "loss"))
        return mass, damping, stiffness + 1j * loss if loss.nnz else stiffness

    def derivatives(self, mode, speed, friction):
        """(t,) ds per relative change of each term, and (2,) per ln speed and ln friction, of a Mode (right, left)."""
        mode = scaled(self.at(speed, friction), mode.root, mode.right, mode.left)
        raw = np.array([mode.change_of(ORDERS[term.kind], term.matrix) * (1j if term.kind == "loss" else 1.0)
                        for term in self.terms])
        factor = np.array([term.factor(speed, friction) for term in self.terms])
        slopes = np.array([term.slopes(speed, friction) for term in self.terms])
        return raw * factor, raw @ slopes
