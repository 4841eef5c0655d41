"""Directions of conjugate gradients for a normal contact, preconditioned next to each node.

A gap left at the free nodes is turned into pressures by a stencil: the kernel of the inverse compliance, cut off after
a few nodes. Within a spot that is nearly what closes the gap, so that large spots converge as fast as small ones.
"""

from functools import lru_cache

import numpy as np

from pipeline.physics.numerics.compiled import njit

#: nodes on either side to which the stencil reaches
_REACH = 2
_WIDTH = 2 * _REACH + 1
#: share by which its centre outweighs the rest at least, so that it stays positive definite
_DOMINANT = 1e-3


class Path:
    """Conjugate ``direction`` (ny, nx) in Pa, of no mean, nonzero at the free nodes of the last turn alone, with the
    ``near`` stencil (5, 5) in Pa/m, in the precision of a map ``like`` it."""

    def __init__(self, near, like):
        self._near, self._free, self._square = near.astype(like.dtype), np.empty(0, int), 1.0
        self.direction, self._residual = np.zeros((2, *like.shape), like.dtype)
        self._around = np.zeros([n + 2 * _REACH for n in like.shape], like.dtype)

    def turn(self, free, distance):
        """Turn into the direction of the ``free`` nodes, at a ``distance`` (n,) in m; slope (Pa m) along it.

        The conjugate factor is that of Polak & Ribiere (1969): where nodes join the contact it needs no restart.
        """
        direction, residual = self.direction.ravel(), self._residual.ravel()
        new, closing, before = distance - distance.mean(), np.empty_like(distance), residual[free]
        residual[self._free] = 0.0
        residual[free] = new
        weigh(self._near, self._residual, free, self._around, closing)
        closing -= closing.mean()
        square = new @ closing
        along = closing + max(0.0, square - closing @ before) / self._square * direction[free]
        along -= along.mean()
        if new @ along <= 0.0:      # uphill: steepest descent
            along = closing
        direction[self._free] = 0.0
        direction[free] = along
        self._free, self._square = free, square if square > 0.0 else 1.0
        return new @ along


def stencil(compliance, shape):
    """(5, 5) Pa/m: the kernel of the inverse ``compliance`` (ny, nx // 2 + 1) in m/Pa next to a node.

    No entry beside the centre is positive and the centre outweighs them, so that the stencil is positive definite. On
    a short side only nodes count that are met once.
    """
    waves = np.maximum(compliance, np.finfo(float).tiny)
    waves[0, 0] = waves.ravel()[1:].max()
    (rows, columns), sides = _cosines(shape), np.arange(-_REACH, _REACH + 1)
    kernel = (rows @ (1.0 / waves) @ columns)[np.ix_(abs(sides), abs(sides))]
    near = np.where(np.multiply.outer(*(abs(sides) <= (n - 1) // 2 for n in shape)), np.minimum(kernel, 0.0), 0.0)
    near[_REACH, _REACH] = max(kernel[_REACH, _REACH], -(1.0 + _DOMINANT) * near.sum())
    return near


@lru_cache(maxsize=4)
def _cosines(shape):
    """(3, ny) and (nx // 2 + 1, 3): what takes real waves of a map (ny, nx) to its values up to _REACH nodes away."""
    rows, columns = (np.cos(2.0 * np.pi / n * np.outer(np.arange(_REACH + 1), np.arange(n))) / n for n in shape)
    columns = columns[:, :shape[1] // 2 + 1]
    columns[:, 1:(shape[1] + 1) // 2] *= 2.0        # a wave and its mirror image
    return rows, columns.T


@njit
def weigh(near, values, free, around, result):
    """Fill ``result`` (n,) with the stencil at the ``free`` nodes, rising, of periodic ``values`` (ny, nx), which fill
    ``around`` (ny + 4, nx + 4) with those beyond the border."""
    ny, nx = values.shape
    for i in range(ny + 2 * _REACH):
        row = (i - _REACH) % ny
        for j in range(nx):
            around[i, j + _REACH] = values[row, j]
        for j in range(_REACH):
            around[i, j], around[i, nx + _REACH + j] = values[row, (j - _REACH) % nx], values[row, j % nx]
    i, end = 0, nx
    for k in range(free.size):
        while free[k] >= end:
            i, end = i + 1, end + nx
        j, total = free[k] - end + nx, 0.0
        for m in range(_WIDTH):
            for n in range(_WIDTH):
                total += near[m, n] * around[i + m, j + n]
        result[k] = total
