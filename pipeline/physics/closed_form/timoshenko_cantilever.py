"""Natural frequencies of a cantilever after Timoshenko, from his differential equations solved exactly along the beam.

State (v, psi, M, Q): v' = psi + Q / kGA, psi' = M / EI, M' = -Q - rho I w^2 psi, Q' = -rho A w^2 v; the transfer matrix
over the length is an exponential, and the free end asks for M = Q = 0 (Huang, J. Appl. Mech. 28 (1961) 579).
"""

import numpy as np
import scipy

#: samples of the frequency axis in which roots are bracketed, per frequency wanted
_SAMPLES = 400


def cantilever_frequencies(length, area, inertia, young, shear_stiffness, density, below):
    """All bending frequencies (Hz) below ``below`` Hz; SI units, ``shear_stiffness`` = kappa G A in N."""
    def mismatch(frequency):
        squared = density * (2 * np.pi * frequency) ** 2
        rate = np.array([[0, 1, 0, 1 / shear_stiffness], [0, 0, 1 / (young * inertia), 0],
                         [0, -inertia * squared, 0, -1], [-area * squared, 0, 0, 0]])
        return np.linalg.det(scipy.linalg.expm(rate * length)[2:, 2:])

    tried = np.linspace(below / _SAMPLES, below, _SAMPLES)
    values = [mismatch(f) for f in tried]
    return np.array([scipy.optimize.brentq(mismatch, low, high, xtol=1e-9, rtol=1e-13) for low, high, first, last in
                     zip(tried[:-1], tried[1:], values[:-1], values[1:], strict=True) if first * last < 0])
