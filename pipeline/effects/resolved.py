"""How stiff and how short-lived a law of a bench may be: what its step resolves."""

import numpy as np

#: squared steps times stiffness over mass: 8 steps in a period of the mass on the spring
_LARGEST = 0.6


def felt_mass(bench, row):
    """Mass in kg that a force along ``row`` (n,) moves."""
    return 1 / (row @ np.linalg.solve(bench.model.mass, row))


def resolved_stiffness(bench, row):
    """Largest stiffness in N/m along ``row`` (n,) that the step of the bench resolves."""
    return _LARGEST * felt_mass(bench, row) / bench.step**2


def resolving_step(mass, stiffness):
    """Step in s that resolves a ``mass`` in kg on a ``stiffness`` in N/m."""
    return np.sqrt(_LARGEST * mass / stiffness)
