"""All complex modes of a sliding system with their left vectors: coordinates in which its linear motion is exact.

About steady sliding, M x'' + C x' + K x = r, with r whatever the linear terms leave out of the contact forces. On a
basis of real modes and their corrections, with right vectors phi, left vectors psi and psi^T (2 s M + C) phi = 1, every
mode obeys

    z' = s z + psi^T r,      x = sum w Re(phi z),      x' = sum w Re(s phi z),

w being 2 for a pair of roots and 1 for a real root. Roots may be moved, which changes nothing else: those of complex
modes take the place of their own approximations, and modes that are too high to be meant are damped.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes
from pipeline.physics.stability.friction_basis import friction_basis

#: an imaginary part below this share of the root is rounding
_REAL = 1e-9
#: largest distance of a root from that which takes its place, relative
_MATCH = 5e-3


@dataclass(frozen=True)
class SlidingModes:
    """All modes, by rising frequency: ``root`` (m,) 1/s with which they move, ``own`` (m,) those of the matrices;
    ``right``, ``left`` (k, m) in the coordinates of the ``basis`` (n, k), as the linearised ``damping`` and
    ``stiffness`` (k, k); ``weight`` (m,)."""

    root: np.ndarray
    own: np.ndarray
    right: np.ndarray
    left: np.ndarray
    weight: np.ndarray
    basis: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray

    @property
    def oscillating(self):
        """(m,) True for pairs of roots."""
        return self.weight == 2

    def growing(self, least=0.0):
        """Indices of the modes whose growth rate exceeds ``least`` 1/s, strongest first."""
        rate = self.root.real
        return np.flatnonzero(rate > least)[np.argsort(-rate[rate > least], kind="stable")]

    def with_roots(self, roots):
        """The same moving with ``roots`` (b,) of positive frequency, each in place of the nearest.

        Raises ConvergenceError where one of them has no counterpart.
        """
        pairs = np.flatnonzero(self.oscillating)
        distance = abs(roots[:, None] - self.own[pairs]) / abs(roots)[:, None]
        which, nearest = scipy.optimize.linear_sum_assignment(distance)
        far = distance[which, nearest] > _MATCH
        if far.any():
            lost = roots[which[far][0]]
            raise ConvergenceError("sliding motion", f"a mode at {lost.imag / (2 * np.pi):.6g} Hz",
                                   f"none within {100 * _MATCH:g} %", "lower sliding motion's smallest correction")
        root = self.root.copy()
        root[pairs[nearest]] = roots[which]
        return replace(self, root=root)

    def damped_above(self, frequency, ratio):
        """The same, modes above a ``frequency`` [Hz] with a damping ratio of at least ``ratio``."""
        size, high = abs(self.root), abs(self.root) > 2 * np.pi * frequency
        low = high & self.oscillating & (self.root.real > -ratio * size)
        damped = size * (-ratio + 1j * np.sqrt(1 - ratio**2))
        return replace(self, root=np.where(low, damped, self.root))


def sliding_modes(model, friction, below, smallest=1e-3, **terms):
    """SlidingModes of a SlidingModel linearised about its contacts, on real modes below a frequency [Hz] and their
    corrections.

    ``friction``: FrictionState; ``smallest``: corrections with smaller amplitudes are left out; ``terms``:
    ``friction_damping``, ``gyroscopic`` and ``centrifugal`` as of ``SlidingModel.linearised``.
    """
    basis = friction_basis(model, below, terms.get("friction_damping", True), smallest, adjoint=friction,
                           centrifugal=terms.get("centrifugal", True)).shape
    mass, damping, stiffness = (basis.T @ each @ basis for each in model.linearised(friction, **terms))
    modes = quadratic_modes(mass, damping, stiffness, left=True)
    real = abs(modes.value.imag) <= _REAL * abs(modes.value)
    kept = np.flatnonzero(real | (modes.value.imag > 0))
    kept = kept[np.argsort(abs(modes.value[kept]), kind="stable")]
    root, right, left = modes.value[kept], modes.right[:, kept], modes.left[:, kept].conj()
    slope = np.einsum("nm,nm->m", left, 2 * root * (mass @ right) + damping @ right)
    return SlidingModes(root, root, right, left / slope, np.where(real[kept], 1, 2), basis, damping,
                        stiffness)
