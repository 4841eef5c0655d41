"""Joints of the pads that are no linear springs: a shim that loses, an abutment that stiffens. No trial draws them.

A shim behind the outer pad makes the stiffness k of the fingers complex, k (1 + i h): the same loss factor h at every
frequency (T. Theodorsen, I. E. Garrick, NACA Report 685, 1940). It stands for motions exp(p t) with Im p > 0, the only
ones that are kept. A pad leans on its abutment with

    F = k x + c x^3,

whose slope k + 3 c x^2 grows with the friction that the abutment carries: about none of it at rest.
"""

import numpy as np

#: what can be hidden beside ``brake.HIDDEN``, with the sizes it is given: low and high of a draw; N/m^3
FURTHER = {"shim_damping": {"loss_factor": (0.08, 0.3)}, "cubic_stiffness": {"coefficient": (1e16, 4e16)}}


def with_shim(brake, stiffness):
    """The ``stiffness`` (n, n) N/m of the parts, complex where a shim loses."""
    if not (shim := brake.hidden.get("shim_damping")):
        return stiffness
    row = np.zeros(len(stiffness))
    row[[brake.disc + 1, brake.disc + 6]] = 1.0, -1.0
    return stiffness + 1j * shim["loss_factor"] * brake.values["fingers"] * np.outer(row, row)


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
