"""Derivatives of evenly sampled values by the quintic spline through them.

Central differences lose 15 % of an acceleration of nine samples a period, this 0.04 %, and 0.2 % of one of six; what
lies above that should be filtered out before, as noise there is not held back.
"""

import numpy as np
import scipy

#: order of the spline
_ORDER = 5


def derivatives(values, interval):
    """(First, second) derivatives, (n, m) each, of ``values`` (n, m) at every ``interval``; of fewer than six samples
    by differences."""
    if values.shape[1] <= _ORDER:
        first = np.gradient(values, interval, axis=1, edge_order=min(2, values.shape[1] - 1))
        return first, np.gradient(first, interval, axis=1, edge_order=min(2, values.shape[1] - 1))
    at = np.arange(values.shape[1], dtype=float)
    spline = scipy.interpolate.make_interp_spline(at, values, k=_ORDER, axis=1)
    return spline.derivative(1)(at) / interval, spline.derivative(2)(at) / interval**2
