"""Memory of elements where a motion starts in the midst of another: as loaded from where they drew with no force.

Whatever turns came before, sliders of little strength have forgotten them after the next large swing, and strong ones
never slipped: what is left is the displacement about which a joint is relaxed. Relaxing branches are loaded from there
at once, so that it may stand for any force of theirs. Dry friction, whose elastic way is short, starts without one.
"""

import numpy as np

from pipeline.physics.time_stepping.coupled_solver import no_memory
from pipeline.physics.time_stepping.element_forces import FRICTION, MAXWELL, element_force


def loaded(elements, rows, relaxed, displacement, time=0.0, speed=0.0):
    """Memory (s,) of an ElementKernel with ``rows`` (e, n), led from ``relaxed`` (n,) m, where it draws with no force,
    to ``displacement`` (n,) m; ``time`` s and ``speed`` rad/s of the drive then."""
    memory, none = no_memory(elements, time), no_memory(elements, time)
    for k, row in enumerate(rows):
        if elements.kind[k] == MAXWELL:
            branches = slice(elements.first[k], elements.first[k + 1] - 1)
            memory[branches] = elements.stiffness[branches] * (row @ (displacement - relaxed))
        elif elements.kind[k] not in FRICTION:
            element_force(elements, k, float(row @ displacement), 0.0, float(row @ relaxed), none, memory,
                          (time, 0.0, speed))
    return memory


def remembers_loading(elements):
    """Whether an ElementKernel holds elements whose force at a start depends on where they were relaxed."""
    return bool((np.diff(elements.first)[~np.isin(elements.kind, FRICTION)] > 0).any())
