"""The few complex modes nearest to a target: roots and vectors of (s^2 M + s C + K) x = 0 by shift and invert.

With v = s x and states z that settle, z' = P x + V v - R z, which push with B z, the answer (A - s0)^-1 of the
first-order system needs one factorisation of

    T(s0) = s0^2 M + s0 C + K - B (s0 + R)^-1 (P + s0 V),

of the size of x. ARPACK finds its largest eigenvalues 1 / (s - s0) (Saad, Numerical Methods for Large Eigenvalue
Problems, 2nd ed., section 8.1).
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.dense_factor import DenseFactor, product

#: first-order systems up to this size are solved whole
_SMALL = 120
#: accuracy of the Ritz values, and iterations at most
_TOLERANCE, _ITERATIONS = 1e-10, 400


def modes_near(mass, damping, stiffness, target, count, beside=None):
    """Roots (g,) 1/s nearest to ``target``, nearest first, and their vectors (n, g), x^H M x = 1.

    Matrices (n, n) may be complex and unsymmetric, the mass symmetric positive definite; ``beside``: a Settling, or
    None. g is ``count``, or all roots where there are fewer. The target must not be a root itself. Raises
    ConvergenceError where ARPACK finds too few.
    """
    n, states = len(mass), 0 if beside is None else len(beside.decay)
    if 2 * n + states <= _SMALL or 2 * n + states < 2 * count + 2:
        value, vector = np.linalg.eig(_first_order(mass, damping, stiffness, beside))
    else:
        value, vector = _shifted(mass, damping, stiffness, target, count, beside)
    nearest = np.argsort(abs(value - target), kind="stable")[:count]
    shape = vector[:n, nearest]
    inertia = np.einsum("ik,ik->k", shape.conj(), mass @ shape).real
    moving = inertia > 0                                            # a state may settle without moving anything
    return value[nearest][moving], shape[:, moving] / np.sqrt(inertia[moving])


def _first_order(mass, damping, stiffness, beside):
    """A of (x, v, z)' = A (x, v, z)."""
    n, factor = len(mass), scipy.linalg.cho_factor(mass)
    lower = -scipy.linalg.cho_solve(factor, np.hstack((stiffness, damping)))
    whole = np.block([[np.zeros((n, n)), np.eye(n)], [lower]])
    if beside is None or not len(beside.decay):
        return whole
    push = np.vstack((0 * beside.push, scipy.linalg.cho_solve(factor, beside.push)))
    return np.block([[whole, push], [beside.by_place, beside.by_speed, -np.diag(beside.decay)]])


def _shifted(mass, damping, stiffness, s0, count, beside):
    n, operator, states = len(mass), s0**2 * mass + s0 * damping + stiffness, 0
    if beside is not None and len(beside.decay):
        states, answer = len(beside.decay), beside.push / (s0 + beside.decay)
        operator = operator - answer @ (beside.by_place + s0 * beside.by_speed)
    factor = DenseFactor(operator)

    def solve(right):
        """(x, v, z) with (A - s0) (x, v, z) = right: v = a + s0 x, and T(s0) x = -M b - (s0 M + C) a + settling."""
        a, b, c = right[:n], right[n:2 * n], right[2 * n:]
        load = -(product(mass, b + s0 * a) + product(damping, a))
        if states:
            load = load + answer @ (beside.by_speed @ a - c)
        x = factor.solve(load)
        v = a + s0 * x
        if not states:
            return np.concatenate((x, v))
        return np.concatenate((x, v, (beside.by_place @ x + beside.by_speed @ v - c) / (s0 + beside.decay)))

    size = 2 * n + states
    inverse = scipy.sparse.linalg.LinearOperator((size, size), matvec=solve, dtype=complex)
    start = np.random.default_rng(0).normal(size=size).astype(complex)
    try:
        value, vector = scipy.sparse.linalg.eigs(inverse, count, v0=start, tol=_TOLERANCE, maxiter=_ITERATIONS)
    except scipy.sparse.linalg.ArpackError as error:
        raise ConvergenceError("complex modes", f"{count} roots near {s0:.6g} 1/s", str(error)) from None
    return s0 + 1 / value, vector
