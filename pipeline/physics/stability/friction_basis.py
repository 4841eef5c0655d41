"""A small basis for complex modes: real modes of the frictionless system and corrections for friction and damping.

Real modes alone do not converge the growth rates, because friction and dampers load the bodies locally. What the real
modes phi (frequencies w) below a limit leave out of the response to these forces, each at its own frequency, is known
from the modes H (frequencies W) above it:

    x = H (W^2 - w^2)^-1 H^T K_f phi,    y = H (W^2 - w^2)^-1 H^T w C phi,    friction coefficient 1.

With w = 0 in the bracket these would be static corrections, which converge more slowly near the limit. The corrections
are orthonormalised in the mass; their singular values are amplitudes per unit of modal amplitude.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.natural_modes import all_modes
from pipeline.physics.system.terms import Kind


@dataclass(frozen=True)
class FrictionBasis:
    """``shape`` (n, m + c): mass-orthonormal; m real modes of ``frequency`` (m,) Hz, then c ``corrections``."""

    shape: np.ndarray
    frequency: np.ndarray
    corrections: int


def friction_basis(model, below, friction_damping=True, smallest=1e-3, contact_stiffness=0.0, centrifugal=True,
                   others=None, adjoint=None):
    """Real modes of a SlidingModel below a frequency [Hz] and their corrections, largest first.

    The real modes are those of closed contacts without friction, damping and gyroscopic terms. Corrections with
    amplitudes up to ``smallest`` per unit of modal amplitude are left out; ``smallest`` = inf leaves out all. Where the
    basis shall serve states whose contacts are stiffer or softer, corrections for changes by ``contact_stiffness``
    ((), (c,) or, for several, (b, c) N/m) join them, and where ``others`` (n, n) or (b, n, n) N/m act, as Maxwell
    branches do at once, those for each of them. With ``adjoint``, the FrictionState of the system or a coefficient,
    left vectors and gyroscopic terms are served as well: roots are off by what the basis lacks of right vectors times
    what it lacks of left ones. Raises ConfigError where no mode lies below the frequency.
    """
    mass, damping, stiffness = model.frictionless(gyroscopic=False, centrifugal=centrifugal)
    square, modes = all_modes(stiffness, mass)
    low = square < (2 * np.pi * below) ** 2
    frequency = np.sqrt(np.maximum(square, 0.0)) / (2 * np.pi)
    if not low.any():
        raise ConfigError("real modes", f"a mode below {below:g} Hz", f"the lowest at {frequency[0]:g} Hz")
    real, high = modes[:, low], modes[:, ~low]
    pace, rows = 2 * np.pi * frequency[low], model.contacts.normal
    drag, follower = _drawn(model.frictional(1.0, friction_damping), real)
    changes = np.atleast_2d(np.broadcast_to(contact_stiffness, (*np.shape(contact_stiffness)[:-1], len(rows))))
    force = [follower, *(rows.T @ (changed[:, None] * (rows @ real)) for changed in changes if changed.any()),
             (damping @ real + drag) * pace]
    force += [] if others is None else [other @ real for other in np.reshape(others, (-1, *mass.shape))]
    if adjoint is not None:
        drag, follower = _drawn(model.frictional(adjoint, friction_damping).adjoint(), real)
        force += [follower, drag * pace, model.speed * model.gyroscopic @ real * pace]
    response = (high.T @ np.hstack(force)) / (square[~low, None] - np.tile(square[low], len(force)))
    corrections = high @ _directions(response, smallest)
    return FrictionBasis(np.hstack((real, corrections)), frequency[low], corrections.shape[1])


def _drawn(friction, motion):
    """(damping, stiffness) of the System of ``friction`` times ``motion``, each (n, m)."""
    return tuple(friction.of_kind(kind, motion) for kind in (Kind.DAMPING, Kind.STIFFNESS))


def _directions(response, smallest):
    """Left singular vectors of ``response`` (h, k) with singular values above ``smallest``, largest first."""
    if 2 * response.shape[1] <= len(response):
        direction, size, _ = np.linalg.svd(response, full_matrices=False)
    else:       # of many columns, in a third of the time
        square, direction = scipy.linalg.eigh(response @ response.T, driver="evd", overwrite_a=True)
        size, direction = np.sqrt(np.maximum(square, 0.0))[::-1], np.asfortranarray(direction[:, ::-1])
    return direction[:, size > smallest]
