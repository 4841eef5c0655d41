"""Accelerated projected gradients with restart: where the next step begins.

FISTA (Beck & Teboulle, SIAM J. Imaging Sciences 2 (2009) 183), restarted where the momentum points uphill (O'Donoghue
& Candes, Foundations of Computational Mathematics 15 (2015) 715).
"""

import numpy as np


def ahead_of(new, before, ahead, momentum):
    """(point from which the next step begins, its momentum) after a projected step from ``ahead`` to ``new``.

    ``before`` is where the last step ended; all are arrays of one shape. The first step begins at ``before`` with a
    momentum of 1.
    """
    step = new - before
    if np.vdot(ahead - new, step) > 0.0:
        return new, 1.0
    following = (1.0 + np.sqrt(1.0 + 4.0 * momentum ** 2)) / 2.0
    return new + (momentum - 1.0) / following * step, following
