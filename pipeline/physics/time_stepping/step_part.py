"""A part of a time step, compiled: the exact step of the pairs over any length, for forces linear in time.

With z = A t, x(t) = E x + t phi_1 B f + t phi_2 B (f' - f): E = exp(z), phi_1 = (E - 1) / z, phi_2 = (phi_1 - 1) / z.
phi_2 by its power series at z / 2^n, then doubled n times: E(2z) = E^2, phi_1(2z) = (E phi_1 + phi_1) / 2,
phi_2(2z) = (E phi_2 + phi_1 + phi_2) / 4 (Higham, Functions of Matrices, SIAM 2008, chapter 10).
"""

import numpy as np

from pipeline.physics.numerics.compiled import borrowing, njit

#: norm of z up to which the series is used, and its terms: the next one is below rounding
_SMALL, _TERMS = 0.25, 11


@borrowing
def _times(left, right, result):
    """Fill ``result`` (2, 2) with the product of two matrices (2, 2)."""
    for a in range(2):
        for b in range(2):
            result[a, b] = left[a, 0] * right[0, b] + left[a, 1] * right[1, b]


@borrowing
def _functions(z, grown, once, ramp, product):
    """Fill ``grown``, ``once`` and ``ramp`` (2, 2) with exp, phi_1 and phi_2 of ``z``, which is used up."""
    size, doublings = max(abs(z[0, 0]) + abs(z[0, 1]), abs(z[1, 0]) + abs(z[1, 1])), 0
    while size > _SMALL:
        size, doublings = 0.5 * size, doublings + 1
    for a in range(2):
        for b in range(2):
            z[a, b] *= 0.5**doublings
            ramp[a, b] = 1.0 if a == b else 0.0
    for k in range(_TERMS, 0, -1):
        _times(z, ramp, product)
        for a in range(2):
            for b in range(2):
                ramp[a, b] = product[a, b] / (k + 2) + (1.0 if a == b else 0.0)
    for a in range(2):
        for b in range(2):
            ramp[a, b] *= 0.5
    _times(z, ramp, once)
    once[0, 0] += 1.0
    once[1, 1] += 1.0
    _times(z, once, grown)
    grown[0, 0] += 1.0
    grown[1, 1] += 1.0
    for _ in range(doublings):
        _double(grown, once, ramp, product)


@borrowing
def _double(grown, once, ramp, product):
    """Take ``grown``, ``once`` and ``ramp`` (2, 2) from z to 2 z."""
    _times(grown, ramp, product)
    for a in range(2):
        for b in range(2):
            ramp[a, b] = 0.25 * (product[a, b] + once[a, b] + ramp[a, b])
    _times(grown, once, product)
    for a in range(2):
        for b in range(2):
            once[a, b] = 0.5 * (product[a, b] + once[a, b])
    _times(grown, grown, product)
    for a in range(2):
        for b in range(2):
            grown[a, b] = product[a, b]


@njit
def part_of_step(blocks, driven, length, step, first, last):
    """Fill the ``step`` (2, 2, m) of m pairs over ``length`` s, and the effect of forces at its begin and end on them.

    ``blocks`` (m, 2, 2) are the A of the pairs, ``driven`` (n, 2, m) their rates per unit force; ``first`` and ``last``
    (n, 2, m). The same as ``modal_integrator.step_matrices``, for one length after the other.
    """
    z, grown, once, ramp, product = (np.empty((2, 2)), np.empty((2, 2)), np.empty((2, 2)), np.empty((2, 2)),
                                     np.empty((2, 2)))
    for m in range(blocks.shape[0]):
        # (q, t q') where the pair is one: the entries of the exponent are of one size
        scale = 1.0 if blocks[m, 1, 0] == -blocks[m, 0, 1] else length
        z[0, 0], z[1, 1] = length * blocks[m, 0, 0], length * blocks[m, 1, 1]
        z[0, 1], z[1, 0] = length * blocks[m, 0, 1] / scale, length * blocks[m, 1, 0] * scale
        _functions(z, grown, once, ramp, product)
        for matrix in (grown, once, ramp):
            matrix[0, 1] *= scale
            matrix[1, 0] /= scale
        for a in range(2):
            for b in range(2):
                step[a, b, m] = grown[a, b]
            for n in range(driven.shape[0]):
                late = length * (ramp[a, 0] * driven[n, 0, m] + ramp[a, 1] * driven[n, 1, m])
                whole = length * (once[a, 0] * driven[n, 0, m] + once[a, 1] * driven[n, 1, m])
                first[n, a, m], last[n, a, m] = whole - late, late
