"""Structural (hysteretic) damping: loss factors of materials and joints, which lose the same share at every frequency.

A loss factor eta makes a stiffness k complex, k (1 + i eta): a cycle of amplitude a loses pi eta k a^2 at any frequency
(Cremer, Heckl & Petersson, Structure-Borne Sound, 3rd ed., section 4.4). A motion in time needs a viscous law. The one
used here keeps the loss of every real mode at its own frequency and the coupling of modes by losses,

    phi_i^T C phi_j = phi_i^T H phi_j / sqrt(w_i w_j),    H = sum of eta k over materials and joints,

with which both complex modes and motions over time are computed, so that they speak of the same system.
"""

import numpy as np

from pipeline.physics.modal.natural_modes import all_modes

#: share of the highest frequency below which a motion is rigid
_RIGID = 1e-7


def equivalent_damping(loss, stiffness, mass):
    """(n, n) N s/m symmetric: the viscous damping of real modes that an imaginary stiffness ``loss`` (n, n) N/m means.

    ``stiffness`` (n, n) N/m and ``mass`` (n, n) kg: whose real modes these are, with that of closed contacts. Rigid
    motions, which strain nothing, are not damped.
    """
    modes, root = _moving_modes(stiffness, mass)
    halves = modes / np.sqrt(root)
    motion = (halves @ halves.T) @ mass if np.count_nonzero(mass) > len(mass) else halves @ halves.T * np.diag(mass)
    damping = motion.T @ (loss @ motion)
    return (damping + damping.T) / 2


def equivalent_motion(shape, stiffness, mass):
    """z (n,) of a motion ``shape`` x (n,): z^H L z = x^H C x with the equivalent damping C of any loss L, symmetric.

    The equivalent damping is linear in the loss, so z tells what each part of it dissipates.
    """
    modes, root = _moving_modes(stiffness, mass)
    return (modes / root) @ (modes.T @ (mass @ shape))


def _moving_modes(stiffness, mass):
    """(modes (n, m), roots (m,) of their angular frequencies) without rigid motions."""
    square, modes = all_modes(stiffness, mass)
    angular = np.sqrt(np.maximum(square, 0.0))
    moving = angular > _RIGID * angular[-1]
    return modes[:, moving], np.sqrt(angular[moving])
