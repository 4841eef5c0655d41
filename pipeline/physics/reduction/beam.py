"""Modes of one beam for sliding: those below a limit, and residual shapes for the forces at its contact.

A beam that is free to move as a whole has no static response; the residual shapes are then those under forces that vary
slowly, which serve as Ritz vectors as well.
"""

import numpy as np
import scipy

from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.reduction.craig_bampton import attachment

#: frequency of the slow forces, as a share of the limit of the modes
_SLOW = 0.01


def beam_modes(stiffness, mass, rows, below, residual_below, solver):
    """(squared, shape): rad^2/s^2 (m,) and mass-normalised (n, m) of the modes below ``below`` Hz and of the residuals.

    ``rows`` (r, n) carry the forces; pseudo-modes above ``residual_below`` Hz are left out.
    """
    frequency, modes = lowest_modes(stiffness, mass, solver, below=below)
    slow = factorise(scipy.sparse.csr_matrix(stiffness + (2 * np.pi * _SLOW * below) ** 2 * mass), solver)
    reduced = attachment(stiffness, mass, rows, frequency, modes, residual_below, slow)
    return np.diag(reduced.stiffness).copy(), reduced.shape
