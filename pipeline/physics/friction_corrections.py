"""A small basis for complex modes: real modes of the frictionless system and static corrections for friction.

Real modes alone do not converge the growth rates, because friction and dampers load the bodies locally. The part of
the response that the real modes Phi (frequencies W) below a limit leave out is static: with the modes H above it,

    X = H W_H^-2 H^T [K_f Phi, C Phi W],    friction coefficient 1, C of joints and friction,

orthonormalised in the mass. Its singular values are amplitudes per unit of modal amplitude.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from pipeline.contract.errors import ConfigError


@dataclass(frozen=True)
class FrictionBasis:
    """``shape`` (n, m + c): mass-orthonormal; m real modes of ``frequency`` (m,) Hz, then c ``corrections``."""

    shape: np.ndarray
    frequency: np.ndarray
    corrections: int


def friction_basis(model, below, friction_damping=True, smallest=1e-4):
    """Real modes of a SlidingModel below a frequency [Hz] and their static corrections, largest first.

    The real modes are those of closed contacts without friction, damping and gyroscopic terms. Corrections with
    amplitudes below ``smallest`` per unit of modal amplitude are left out; ``smallest`` = inf leaves out all. Raises
    ConfigError where no mode lies below the frequency.
    """
    mass, damping, stiffness = model.frictionless(gyroscopic=False)
    square, modes = eigh(stiffness, mass)
    angular = np.sqrt(np.maximum(square, 0.0))
    low = angular < 2 * np.pi * below
    if not low.any():
        raise ConfigError("real modes", f"a mode below {below:g} Hz", f"the lowest at {angular[0] / (2 * np.pi):g} Hz")
    real, high = modes[:, low], modes[:, ~low]
    drag, follower = model.friction_matrices(1.0, friction_damping)
    drag = drag + damping - model.damping
    force = np.hstack((follower @ real, drag @ real * angular[low]))
    direction, size, _ = np.linalg.svd((high.T @ force) / square[~low, None], full_matrices=False)
    corrections = high @ direction[:, size > smallest]
    return FrictionBasis(np.hstack((real, corrections)), angular[low] / (2 * np.pi), corrections.shape[1])
