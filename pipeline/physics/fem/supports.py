"""Elastic bodies with some of their nodes held; degree of freedom = 3 node + axis."""

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.natural_modes import lowest_modes

#: rigid motions of a free body, and the most that their frequencies may be of that of its first mode
_RIGID, _RIGID_SHARE = 6, 0.1


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


def free_modes(stiffness, mass, solver, below, where):
    """Elastic modes ``below`` a frequency in Hz of a body that nothing holds; ``where`` for messages.

    Returns frequency (m,) Hz and shape (n, m) in 1/kg^0.5, mass-normalised. Raises ConvergenceError where it has other
    rigid motions than six.
    """
    frequency, shape = lowest_modes(stiffness, mass, solver, below=below)
    if len(frequency) > _RIGID and frequency[_RIGID - 1] > _RIGID_SHARE * frequency[_RIGID]:
        raise ConvergenceError(where, "six rigid motions far below its first mode",
                               f"frequencies {', '.join(f'{f:.4g}' for f in frequency[:_RIGID + 1])} Hz",
                               "check the mesh: it must be one body")
    return frequency[_RIGID:], shape[:, _RIGID:]
