"""Joints of the pads that are no linear springs: a shim that loses, an abutment that stiffens. No trial draws them.

A shim behind the outer pad relaxes under the fingers, three branches a decade of time, all of one stiffness g,

    F = sum_j F_j + k_0 e,    F_j' = g e' - F_j / tau_j,

which lose h times what the fingers store, alike at all frequencies of the band (M. A. Biot, Proc. 3rd US Nat. Congr.
Appl. Mech., 1958), and are as stiff as the fingers without shim at a kilohertz. A pad leans on its abutment with

    F = k x + c x^3,

whose slope k + 3 c x^2 grows with the friction that the abutment carries: about none of it at rest.
"""

import numpy as np

#: what can be hidden beside ``brake.HIDDEN``, with the sizes it is given: low and high of a draw; 1, N/m^3
FURTHER = {"shim_damping": {"loss_factor": (0.05, 0.2)}, "cubic_stiffness": {"coefficient": (1e16, 4e16)}}
#: rad/s at which a shim stores what the fingers do; times of its branches in s
_MIDDLE = 2 * np.pi * 1e3
_TIMES = 10 ** (np.arange(-6, 7) / 3) / _MIDDLE
#: what branches of 1 N/m lose and store there
_LOST, _STORED = (np.sum(_MIDDLE * _TIMES * power / (1 + (_MIDDLE * _TIMES) ** 2)) for power in (1, _MIDDLE * _TIMES))


def relaxed(brake):
    """Stiffness (n, n) N/m of the parts once a shim has relaxed."""
    if "shim_damping" not in brake.hidden:
        return brake.stiffness.copy()
    row = _fingers(brake)
    return brake.stiffness - _branch(brake) * _STORED * np.outer(row, row)


def relaxing(brake, matrix):
    """The state ``matrix`` (s, s) of (q, q', ...) with the forces of the branches of a shim behind its states."""
    if "shim_damping" not in brake.hidden:
        return matrix
    row, size, states, count = _fingers(brake), len(brake.mass), len(matrix), len(_TIMES)
    whole = np.zeros((states + count,) * 2)
    whole[:states, :states] = matrix
    whole[size:2 * size, states:] = -np.linalg.solve(brake.mass, row)[:, None]
    whole[states:, size:2 * size] = _branch(brake) * row
    whole[states:, states:] = -np.diag(1 / _TIMES)
    return whole


def leaning(brake, stiffness, place):
    """The ``stiffness`` (n, n) N/m of small motions about ``place`` (n,) m, abutments that stiffen included."""
    if not (law := brake.hidden.get("cubic_stiffness")):
        return stiffness
    at, stiffness = brake.disc + 3 * law["pad"], stiffness.copy()
    stiffness[at, at] += 3 * law["coefficient"] * place[at] ** 2
    return stiffness


def carried(brake, force, place):
    """The ``force`` (n,) N of the springs at ``place`` (n,) m, abutments that stiffen included."""
    if not (law := brake.hidden.get("cubic_stiffness")):
        return force
    at, force = brake.disc + 3 * law["pad"], force.copy()
    force[at] += law["coefficient"] * place[at] ** 3
    return force


def moved(brake, step):
    """How far a ``step`` (n,) m moves the end of an abutment that stiffens, 0 m where none does."""
    law = brake.hidden.get("cubic_stiffness")
    return abs(step[brake.disc + 3 * law["pad"]]) if law else 0.0


def _fingers(brake):
    """Row (n,) of the elongation of the fingers: the outer pad over the caliper."""
    row = np.zeros(len(brake.mass))
    row[[brake.disc + 1, brake.disc + 6]] = 1.0, -1.0
    return row


def _branch(brake):
    """Stiffness of a branch in N/m."""
    return brake.hidden["shim_damping"]["loss_factor"] * brake.values["fingers"] / _LOST
