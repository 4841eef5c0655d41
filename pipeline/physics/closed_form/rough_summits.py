"""Greenwood & Williamson (Proc. R. Soc. A 295 (1966) 300): equal summits with exponentially distributed heights."""

import numpy as np


def exponential_pressure(gap, density, curvature, modulus, spread):
    """p = sqrt(pi) density E* sqrt(spread^3 / curvature) exp(-gap / spread), gap counted from the origin of heights.

    ``density`` summits per m^2, ``curvature`` 1/m, ``modulus`` Pa, ``spread`` = mean height m.
    """
    return np.sqrt(np.pi) * density * modulus * np.sqrt(spread**3 / curvature) * np.exp(-gap / spread)


def exponential_area(gap, density, curvature, spread):
    """Real area share pi density spread / curvature exp(-gap / spread)."""
    return np.pi * density * spread / curvature * np.exp(-gap / spread)
