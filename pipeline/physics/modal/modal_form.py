"""A linear system in its complex modes: exact steps under forces that are held, of any length.

With the roots s_k of (s^2 M + s C + K) r = 0, left vectors l_k and l_k^H (2 s_k M + C) r_k = 1,

    x_k' = s_k x_k + (l_k^H B) u,    q = sum_k r_k x_k,    q' = sum_k s_k r_k x_k,

so that under a force u held over a step h

    x_k(t + h) = exp(s_k h) x_k(t) + (exp(s_k h) - 1) / s_k (l_k^H B) u.

Of each conjugate pair one root stands for both, with twice the real part.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes

#: largest error, over the largest acceleration that a force causes at once, of the modes taken together
_WHOLE = 1e-6
#: Newton's steps of each root between its vectors
_STEPS = 2


@dataclass(frozen=True)
class ModalForm:
    """``root`` (m,) 1/s; ``drive`` (m, i): l_k^H B; ``rows`` (s, m): displacement of each output is Re(rows x)."""

    root: np.ndarray
    drive: np.ndarray
    rows: np.ndarray

    def step(self, state, force, length):
        """States (m,) a step of ``length`` s after ``state`` (m,) under held ``force`` (i,)."""
        grown = self.root * length
        given = np.where(grown == 0, length, np.expm1(grown) / np.where(self.root == 0, 1, self.root))
        return np.exp(grown) * state + given * (self.drive @ force)

    def motion(self, state, force):
        """(displacement, velocity, acceleration), each (s,), in ``state`` (m,) under ``force`` (i,)."""
        rate = self.root * state + self.drive @ force
        return tuple((self.rows @ each).real for each in (state, self.root * state, self.root * rate))


def modal_form(matrices, inputs, outputs):
    """ModalForm of ``matrices`` (M, C, K) (n, n), real, of forces along the rows ``inputs`` (i, n) and of displacements
    along the rows ``outputs`` (s, n).

    Raises ConvergenceError where the modes do not span the motion, as where two of them are one.
    """
    mass, damping, stiffness = matrices
    modes = quadratic_modes(mass, damping, stiffness, left=True)
    root, right, left = modes.value, modes.right, modes.left
    with np.errstate(divide="ignore", invalid="ignore"):        # modes that are one are refused below
        for _ in range(_STEPS):
            slope = _between(left, 2 * root * (mass @ right) + damping @ right)
            root = root - _between(left, root * (root * (mass @ right) + damping @ right) + stiffness @ right) / slope
        drive = (left.conj().T @ inputs.T) / _between(left, 2 * root * (mass @ right) + damping @ right)[:, None]
    _refuse_defective(root, right, drive, np.linalg.solve(mass, inputs.T))
    kept = root.imag >= 0
    twice = np.where(root.imag > 0, 2.0, 1.0)
    return ModalForm(root[kept], drive[kept], (outputs @ right * twice)[:, kept])


def _between(left, right):
    """(m,) l_k^H r_k of the columns."""
    return np.einsum("nk,nk->k", left.conj(), right)


def _refuse_defective(root, right, drive, accelerated):
    """ConvergenceError unless the modes together answer a force at once by ``accelerated`` (n, i) and nothing else."""
    size = abs(accelerated).max(initial=0.0)
    with np.errstate(invalid="ignore"):
        wrong = abs((right * root) @ drive - accelerated).max(initial=0.0)
    if not wrong <= _WHOLE * size:
        raise ConvergenceError("modal form", "complex modes that span the motion", f"an error of {wrong / size:.2g} of"
                               " the acceleration by a force", "choose another operating point: two modes meet here")
