"""Elastic bodies with some of their nodes held; degree of freedom = 3 node + axis."""

import numpy as np

from pipeline.physics.modal.natural_modes import lowest_modes


def free_freedoms(nodes, held):
    """(f,) degrees of freedom of ``nodes`` nodes that do not belong to the nodes ``held`` (k,)."""
    return np.setdiff1d(np.arange(3 * nodes), 3 * held[:, None] + np.arange(3))


def held_modes(stiffness, mass, held, solver, **wanted):
    """Modes of a body whose nodes ``held`` (k,) do not move; ``wanted``: count, or below in Hz (see lowest_modes).

    Returns frequency (m,) Hz and shape (n, m) in 1/kg^0.5, mass-normalised and 0 at the nodes held.
    """
    free = free_freedoms(stiffness.shape[0] // 3, held)
    frequency, modes = lowest_modes(stiffness[free][:, free], mass[free][:, free], solver, **wanted)
    shape = np.zeros((stiffness.shape[0], len(frequency)))
    shape[free] = modes
    return frequency, shape
