"""Structural (hysteretic) damping: loss factors of materials and joints, which lose the same share at every frequency.

A loss factor eta makes a stiffness k complex, k (1 + i eta): a cycle of amplitude a loses pi eta k a^2 at any frequency
(Cremer, Heckl & Petersson, Structure-Borne Sound, 3rd ed., section 4.4). A motion in time needs a viscous law. The one
used here keeps the loss of every real mode at its own frequency and the coupling of modes by losses,

    phi_i^T C phi_j = phi_i^T H phi_j / sqrt(w_i w_j),    H = sum of eta k over materials and joints,

with which both complex modes and motions over time are computed, so that they speak of the same system.
"""

import numpy as np
import scipy

#: share of the highest frequency below which a motion is rigid
_RIGID = 1e-7


def equivalent_damping(loss, stiffness, mass):
    """(n, n) N s/m symmetric: the viscous damping of real modes that an imaginary stiffness ``loss`` (n, n) N/m means.

    ``stiffness`` (n, n) N/m and ``mass`` (n, n) kg: whose real modes these are, with that of closed contacts. Rigid
    motions, which strain nothing, are not damped.
    """
    square, modes = scipy.linalg.eigh(stiffness, mass)
    angular = np.sqrt(np.maximum(square, 0.0))
    moving = angular > _RIGID * angular[-1]
    modes, root = modes[:, moving], np.sqrt(angular[moving])
    inertia, weighted = mass @ modes, modes / root
    small = weighted.T @ loss @ weighted
    return inertia @ ((small + small.T) / 2) @ inertia.T
