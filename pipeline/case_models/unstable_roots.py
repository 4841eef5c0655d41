"""Roots of a case that grow, or nearly do, in the whole reduced model instead of on a basis of it."""

import numpy as np

from pipeline.physics.modal.quadratic_eigenproblem import DenseFactors, polished
from pipeline.physics.stability.constrained_modes import is_hard

#: growth rates above this negative share of the frequency are nearly unstable
_NEARLY = 5e-4
#: matrices are factorised beside a root, where they are regular in single precision
_BESIDE = 1 + 1e-5


def nearly(roots, settings):
    """True where a root (1/s) grows or nearly does, below the frequency limit of the section ``complex_modes``."""
    return (roots.real > -_NEARLY * abs(roots)) & (abs(roots) < 2 * np.pi * settings.frequency_max)


def in_whole_model(model, sliding, roots, shapes, settings, hysteretic=None):
    """Roots (g,) and shapes (n, g) of a SlidingModel, those that oscillate as in the whole model instead of on a basis.

    ``sliding``: its Steady; ``settings``: the section ``complex_modes``; ``hysteretic``: what to add to its damping and
    its stiffness (imaginary), or None. Hard contacts leave the roots as they are.
    """
    oscillating = np.flatnonzero(roots.imag > 0)
    if is_hard(model) or not len(oscillating):
        return roots, shapes
    friction, beside = sliding.acting(settings.friction_slopes), sliding.beside(model, settings.friction_slopes)
    matrices = model.linearised(friction, settings.friction_damping, settings.gyroscopic, settings.centrifugal)
    if hysteretic is not None:
        matrices = matrices[0], matrices[1] + hysteretic[0], matrices[2] + hysteretic[1]
    roots, shapes = roots.copy(), shapes.copy()
    for k in oscillating:
        roots[k], better = polished(*matrices, roots[k] * _BESIDE, shapes[:, k], beside, DenseFactors(np.complex64))
        shapes[:, k] = better / np.sqrt(abs(better.conj() @ matrices[0] @ better))
    return roots, shapes
