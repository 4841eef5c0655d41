"""The value on an infinitely fine grid, by what refinement changes: Richardson's extrapolation of the observed order.

    f(h) = f_0 + C h^p

p from the last three grids, of whatever ratios; L. F. Richardson, J. A. Gaunt (1927), P. J. Roache (1998): the grid
convergence index, 1.25 times the change from the finest grid to the limit, is the error that is stated of the limit.
"""

from typing import NamedTuple

import numpy as np
import scipy

#: orders that are believed; outside, or where values do not approach a limit from one side, it is the least
ORDERS = (0.5, 4.0)
_SAFETY = 1.25


class GridLimit(NamedTuple):
    """``value`` at the limit, its ``error``, and the ``order`` p; 0 where fewer than three grids tell none."""

    value: float
    error: float
    order: float


def grid_limit(fineness, values):
    """GridLimit of ``values`` (n,) on grids of rising ``fineness`` (n,), as nodes per length.

    Of two grids the error is the last change, of one all of the value, and the value that of the finest. ValueError
    where the fineness does not rise.
    """
    h, f = 1 / np.asarray(fineness, float), np.asarray(values, float)
    if np.any(np.diff(h) >= 0):
        raise ValueError("grid limit: the fineness must rise")
    if len(f) < 3:
        return GridLimit(float(f[-1]), float(abs(f[-1] - f[-2] if len(f) == 2 else f[-1])), 0.0)
    (h3, h2, h1), (f3, f2, f1) = h[-3:], f[-3:]
    if f1 == f2:
        return GridLimit(float(f1), 0.0, ORDERS[1])
    order = _order(h1, h2, h3, (f3 - f2) / (f2 - f1))
    change = (f1 - f2) / ((h2 / h1) ** order - 1)
    return GridLimit(float(f1 + change), float(_SAFETY * abs(change)), float(order))


def _order(h1, h2, h3, ratio):
    def off(p):
        return (h3**p - h2**p) / (h2**p - h1**p) - ratio

    low, high = ORDERS
    if not ratio > 0 or off(low) > 0:
        return low
    return high if off(high) < 0 else scipy.optimize.brentq(off, low, high)
