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
from pipeline.physics.modal.quadratic_eigenproblem import operator, polished, quadratic_modes
from pipeline.physics.stability.friction_basis import friction_basis

#: an imaginary part below this share of the root is rounding
_REAL = 1e-9
#: largest distance of a root from that which takes its place, relative
_MATCH = 5e-3
#: largest distance at which a basis reaches a root, relative
_REACHED = 1e-3
#: rounds of inverse iteration that lead to a mode, and the share of the squared size of shapes below which they agree
_ROUNDS, _ALIKE = 4, 1e-12


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

    def with_roots(self, roots, near=None):
        """The same moving with ``roots`` (b,) of positive frequency, each in place of the mode nearest to its root
        ``near`` (b,) in the matrices, which is the root itself where that is left out.

        Raises ConvergenceError where one of them has no counterpart.
        """
        near = roots if near is None else near
        mode, distance = self._counterparts(near)
        if (distance > _MATCH).any():
            lost = np.argmax(distance)
            raise ConvergenceError(
                "limit_cycle: sliding motion", f"a mode at {near[lost].imag / (2 * np.pi):.6g} Hz, which complex_modes"
                " has", f"the nearest {100 * distance[lost]:.2g} % off", "lower limit_cycle.smallest_correction to a"
                " tenth; where that does not help, damping that is no damper's moves this root by more than"
                f" {100 * _MATCH:g} %, and the mode has no limit cycle here")
        root = self.root.copy()
        root[mode] = roots
        return replace(self, root=root)

    def nearest(self, roots):
        """Indices (b,) of the modes that move nearest to the ``roots`` (b,) of positive frequency, another for each."""
        return replace(self, own=self.root)._counterparts(roots)[0]

    def coordinates(self, mass, beside, root):
        """((m,) modal coordinates, (k,) what settles) of the real motion at time 0 in the mode near a ``root`` 1/s of
        the system with a Settling ``beside`` it; ``mass`` (n, n)."""
        given = self.basis.T @ mass @ self.basis, self.damping, self.stiffness
        memory = beside.projected(self.basis.T, self.basis)
        first = np.linalg.solve(operator(*given, root, memory)[0], np.ones(len(given[0]), complex))
        own, shape = polished(*given, root, first, memory)
        displaced, moving = shape.real, (own * shape).real
        moved = self.left.T @ (given[0] @ moving + given[1] @ displaced) + self.own * (
            self.left.T @ (given[0] @ displaced))
        return moved, ((memory.by_place + own * memory.by_speed) @ shape / (own + memory.decay)).real

    def _counterparts(self, roots):
        """(modes (b,), another for each of the ``roots`` (b,), and their relative distances (b,))."""
        pairs = np.flatnonzero(self.oscillating)
        distance = abs(roots[:, None] - self.own[pairs]) / abs(roots)[:, None]
        which, nearest = scipy.optimize.linear_sum_assignment(distance)
        return pairs[nearest], distance[which, nearest]

    def without(self, roots):
        """Those of the ``roots`` (b,) that the basis does not reach."""
        return roots[self._counterparts(roots)[1] > _REACHED]

    def damped_above(self, frequency, ratio):
        """The same, modes above a ``frequency`` [Hz] with a damping ratio of at least ``ratio``."""
        size, high = abs(self.root), abs(self.root) > 2 * np.pi * frequency
        low = high & self.oscillating & (self.root.real > -ratio * size)
        damped = size * (-ratio + 1j * np.sqrt(1 - ratio**2))
        return replace(self, root=np.where(low, damped, self.root))


def sliding_modes(model, friction, below, smallest=1e-3, roots=(), others=None, felt=None, **terms):
    """SlidingModes of a SlidingModel linearised about its contacts, on real modes below a frequency [Hz] and their
    corrections.

    ``friction``: FrictionState; ``smallest``: corrections with smaller amplitudes are left out; ``roots`` (b,) 1/s of
    positive frequency, roughly: where the basis does not reach one of them, the shapes of that mode in the whole model
    join it; ``others``: stiffness (n, n) N/m that acts besides, see ``friction_basis``; ``felt``: FrictionState with
    what it remembers, where that is another; ``terms``: ``friction_damping``, ``gyroscopic`` and ``centrifugal`` as of
    ``SlidingModel.linearised``.
    """
    basis = friction_basis(model, below, terms.get("friction_damping", True), smallest,
                           adjoint=friction if felt is None else felt,
                           centrifugal=terms.get("centrifugal", True), others=others).shape
    matrices = model.linearised(friction, **terms)
    modes = _modes_on(basis, matrices)
    lost = modes.without(np.asarray(roots, complex))
    return _modes_on(_extended(basis, matrices, lost), matrices) if len(lost) else modes


def _modes_on(basis, matrices):
    """SlidingModes of ``matrices`` (M, C, K), each (n, n), on a ``basis`` (n, k)."""
    mass, damping, stiffness = (basis.T @ each @ basis for each in matrices)
    modes = quadratic_modes(mass, damping, stiffness, left=True)
    real = abs(modes.value.imag) <= _REAL * abs(modes.value)
    kept = np.flatnonzero(real | (modes.value.imag > 0))
    kept = kept[np.argsort(abs(modes.value[kept]), kind="stable")]
    root, right, left = modes.value[kept], modes.right[:, kept], modes.left[:, kept].conj()
    slope = np.einsum("nm,nm->m", left, 2 * root * (mass @ right) + damping @ right)
    return SlidingModes(root, root, right, left / slope, np.where(real[kept], 1, 2), basis, damping, stiffness)


def _extended(basis, matrices, roots):
    """The mass-orthonormal ``basis`` (n, k) and what right and left shapes of the modes near ``roots`` add to it."""
    mass = matrices[0]
    shapes = [_shape_near(root, *each) for root in roots for each in (matrices, [m.T for m in matrices])]
    added = np.hstack([part[:, None] for shape in shapes for part in (shape.real, shape.imag)])
    for _ in range(2):      # twice is enough (Kahan, Parlett)
        added = added - basis @ (basis.T @ (mass @ added))
    square, turn = np.linalg.eigh(added.T @ mass @ added)
    kept = square > _ALIKE * square[-1]
    return np.hstack((basis, added @ turn[:, kept] / np.sqrt(square[kept])))


def _shape_near(root, mass, damping, stiffness):
    """(n,) shape of the mode nearest to a ``root``, of unit length; by inverse iteration, then polished."""
    factor = scipy.linalg.lu_factor(root**2 * mass + root * damping + stiffness)
    shape = np.random.default_rng(len(mass)).standard_normal(len(mass)).astype(complex)
    for _ in range(_ROUNDS):
        shape = scipy.linalg.lu_solve(factor, (2 * root * mass + damping) @ shape)
        shape /= np.linalg.norm(shape)
    return polished(mass, damping, stiffness, root, shape)[1]
