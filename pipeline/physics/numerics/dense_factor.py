"""Products and triangular factors of dense matrices for single complex vectors, without copies of the matrices."""

import numpy as np
import scipy


def product(matrix, x):
    """``matrix`` @ ``x`` of a vector (n,), or of several (n, g); a real matrix, dense or sparse, is not copied into
    complex numbers; of a diagonal one ``matrix`` (n,), which takes one vector, is the diagonal."""
    if matrix.ndim == 1:
        return matrix * x
    if np.iscomplexobj(x) and not np.iscomplexobj(matrix):
        return matrix @ x.real + 1j * (matrix @ x.imag)
    return matrix @ x


class DenseFactor:
    """P A = L U of a square ``matrix`` (n, n) in complex numbers of a ``kind``."""

    def __init__(self, matrix, kind=complex):
        self._lu, exchanged = scipy.linalg.lu_factor(np.asarray(matrix, kind), check_finite=False)
        order = list(range(len(exchanged)))
        for row, other in enumerate(exchanged.tolist()):
            order[row], order[other] = order[other], order[row]
        self._order = np.array(order, int)

    def solve(self, rhs, adjoint=False):
        """x (n,) of A x = rhs, or A^H x = rhs; a triangular product per factor, where getrs is made for many."""
        solve, x = scipy.linalg.get_blas_funcs("trsv", (self._lu,)), np.empty(len(self._order), complex)
        if not adjoint:
            x[:] = solve(self._lu, solve(self._lu, rhs[self._order], lower=1, diag=1))
            return x
        x[self._order] = solve(self._lu, solve(self._lu, rhs, trans=2), lower=1, trans=2, diag=1)
        return x
