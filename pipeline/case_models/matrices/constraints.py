"""Degrees of freedom that constraints hold: programs put 1e36 (Abaqus) or another penalty on their diagonal.

With x_i = 0 for such a diagonal k_ii, other degrees of freedom lack stiffnesses k_ij k_ji / k_ii, which are below 1e-8
of their couplings; in double precision the penalty hides what the others leave of the equation.
"""

import numpy as np

#: diagonal of a held degree of freedom, at least: over the lowest of all, over its couplings
_ABOVE = 1e8
#: (rad/s)^2, stiffness over mass, above which it does not move by itself
_STIFF = 1e16


def held(stiffness, mass):
    """Indices (c,) of the degrees of freedom that penalties hold.

    ``stiffness`` (n, n) sparse and ``mass`` (n,), its diagonal, are sums of absolute values over the terms of a system.
    """
    diagonal = stiffness.diagonal()
    coupled = stiffness.tocoo()
    beside = coupled.row != coupled.col
    strongest = np.zeros(len(diagonal))
    for index in (coupled.row[beside], coupled.col[beside]):
        np.maximum.at(strongest, index, coupled.data[beside])
    lowest = diagonal[diagonal > 0].min(initial=np.inf)
    return np.flatnonzero((diagonal >= _ABOVE * lowest) & (diagonal >= _ABOVE * strongest)
                          & (diagonal >= _STIFF * mass))


def empty(matrices, without):
    """Indices (e,) of rows that have no entries in any of ``matrices`` (n, n), sparse, beside those of ``without``."""
    size = matrices[0].shape[0]
    counted = np.zeros(size, bool)
    for matrix in matrices:
        entries = matrix.tocoo()
        kept = (entries.data != 0) & ~np.isin(entries.row, without) & ~np.isin(entries.col, without)
        counted[entries.row[kept]] = counted[entries.col[kept]] = True
    counted[without] = True
    return np.flatnonzero(~counted)
