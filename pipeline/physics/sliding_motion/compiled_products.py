"""Products of matrices in single precision with vectors in double, compiled; sums are kept in double precision."""

import numpy as np

from pipeline.physics.numerics.compiled import njit

#: sums may be reordered to use the width of the processor; nothing else is relaxed
FAST = {"reassoc", "contract", "nsz"}


@njit
def times(factor, values, result):
    """Add complex ``factor`` (2, m) times ``values`` (2m,) to ``result`` (2m,)."""
    m = factor.shape[1]
    for q in range(m):
        result[q] += factor[0, q] * values[q] - factor[1, q] * values[m + q]
        result[m + q] += factor[0, q] * values[m + q] + factor[1, q] * values[q]


@njit(fastmath=FAST)
def multiply(matrix, values, result):
    """Add ``matrix`` (r, n) times ``values`` (n,) to ``result`` (r,)."""
    four = matrix.shape[0] - matrix.shape[0] % 4
    for i in range(0, four, 4):     # four rows at once: as fast as they are read
        a = b = c = d = 0.0
        for q in range(values.size):
            value = values[q]
            a += matrix[i, q] * value
            b += matrix[i + 1, q] * value
            c += matrix[i + 2, q] * value
            d += matrix[i + 3, q] * value
        result[i] += a
        result[i + 1] += b
        result[i + 2] += c
        result[i + 3] += d
    for i in range(four, matrix.shape[0]):
        total = 0.0
        for q in range(values.size):
            total += matrix[i, q] * values[q]
        result[i] += total


@njit
def spread(matrix, values, result):
    """Fill ``result`` (n,) with ``values`` (r,) times ``matrix`` (r, n)."""
    result[:] = 0.0
    add_rows(matrix, values, np.arange(values.size), result)


@njit(fastmath=FAST)
def add_rows(matrix, values, which, result):
    """Add the rows ``which`` of ``matrix`` (r, n), times their ``values`` (r,), to ``result`` (n,)."""
    four = which.size - which.size % 4
    for k in range(0, four, 4):
        a, b, c, d = values[which[k]], values[which[k + 1]], values[which[k + 2]], values[which[k + 3]]
        first, second, third = matrix[which[k]], matrix[which[k + 1]], matrix[which[k + 2]]
        fourth = matrix[which[k + 3]]
        for q in range(result.size):
            result[q] += a * first[q] + b * second[q] + c * third[q] + d * fourth[q]
    for k in range(four, which.size):
        i = which[k]
        for q in range(result.size):
            result[q] += values[i] * matrix[i, q]
