"""Elastic block of elements that differ in modulus: the finite elements of ``layered_solid``, a factor on each.

K u = f is solved by conjugate gradients, preconditioned by the block of one modulus: the DFT splits that into a chain
of layers for every wavenumber, whose elimination is kept. How many iterations that takes depends on the contrast of the
moduli, not on the grid.

Planes of nodes are counted from the surface (0) to the one above the clamped base; displacements and forces are
(planes, ny, nx, 3) along x, y and the outward normal z.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.rough.layer_element import brick_stiffness
from pipeline.physics.rough.layered_solid import layer_symbols

#: vertices of a brick: steps along x, along y, and down
_VERTICES = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]


@dataclass(frozen=True)
class CompositeBlock:
    """Block on a rigid base; see ``composite_block``."""

    factor: np.ndarray      # (layers, ny, nx) of the modulus of each element
    stiffness: tuple        # (24, 24) N/m of an element of each layer at factor 1
    inverse: np.ndarray     # (layers, ny, nx // 2 + 1, 3, 3) m/N of the chain of one modulus, deeper planes eliminated
    carried: np.ndarray     # (layers - 1, ny, nx // 2 + 1, 3, 3) share of a plane's forces that goes to the one above
    area: float             # m^2 of a node

    def solved(self, force, start=None, tolerance=1e-6, max_iterations=500):
        """Displacement in m under ``force`` in N; the residual is below ``tolerance`` times the norm of the force.

        ``start``: a displacement to start from. Raises ConvergenceError.
        """
        u = np.zeros_like(force) if start is None else start.copy()
        residual = force.copy() if start is None else force - self.forces(u)
        size, direction, image, before = np.linalg.norm(force), np.zeros_like(force), np.zeros_like(force), 1.0
        for _ in range(max_iterations):
            if np.linalg.norm(residual) <= tolerance * size:
                return u
            ahead = self.of_one_modulus(residual)
            product = np.vdot(residual, ahead)
            direction = ahead + product / before * direction
            image = residual + self._drawn(ahead, self.factor - 1.0) + product / before * image     # K direction
            before = product
            step = product / np.vdot(direction, image)
            u += step * direction
            residual -= step * image
        raise ConvergenceError("composite block", f"a residual of {tolerance:g} within {max_iterations} iterations",
                               f"{np.linalg.norm(residual) / size:.2g}", "lower the contrast of the moduli")

    def under(self, pressure, start=None, tolerance=1e-6):
        """Displacement under a ``pressure`` (ny, nx) in Pa on the surface, counted positive outwards as its compliance;
        see ``solved``."""
        force = np.zeros((*self.factor.shape, 3))
        force[0, ..., 2] = self.area * pressure
        return self.solved(force, start, tolerance)

    def forces(self, displacement):
        """Nodal forces in N that hold a ``displacement`` in m."""
        return self._drawn(displacement, self.factor)

    def _drawn(self, displacement, factor):
        """Nodal forces of elements with these factors (layers, ny, nx) of the modulus."""
        planes, ny, nx = factor.shape
        around = np.zeros((planes + 1, ny + 1, nx + 1, 3))      # the clamped base below, the next period beside
        around[:-1] = np.pad(displacement, ((0, 0), (0, 1), (0, 1), (0, 0)), "wrap")
        held, corners = np.zeros_like(around), np.empty((ny, nx, len(_VERTICES), 3))
        for layer in np.flatnonzero(factor.any(axis=(1, 2))):
            for k, (a, b, c) in enumerate(_VERTICES):
                corners[:, :, k] = around[layer + c, b:b + ny, a:a + nx]
            drawn = factor[layer, ..., None] * (corners.reshape(ny, nx, 24) @ self.stiffness[layer].T)
            drawn = drawn.reshape(corners.shape)
            for k, (a, b, c) in enumerate(_VERTICES):
                held[layer + c, b:b + ny, a:a + nx] += drawn[:, :, k]
        held[:, 0] += held[:, -1]
        held[:, :, 0] += held[:, :, -1]
        return held[:-1, :-1, :-1].copy()

    def of_one_modulus(self, force):
        """Displacement in m of the block of one modulus (factor 1) under ``force`` in N, exact."""
        waves = scipy.fft.rfft2(force, axes=(1, 2))
        for plane in range(len(waves) - 2, -1, -1):
            waves[plane] -= _times(self.carried[plane], waves[plane + 1])
        moved = np.empty_like(waves)
        moved[0] = _times(self.inverse[0], waves[0])
        for plane in range(1, len(waves)):
            moved[plane] = _times(self.inverse[plane], waves[plane])
            moved[plane] -= np.einsum("yxji,yxj->yxi", self.carried[plane - 1].conj(), moved[plane - 1])
        return scipy.fft.irfft2(moved, s=force.shape[1:3], axes=(1, 2))

    def shifted(self, offset):
        """The block shifted by ``offset`` (y, x) in nodes."""
        return CompositeBlock(np.roll(self.factor, offset, (1, 2)), self.stiffness, self.inverse, self.carried,
                              self.area)


def composite_block(factor, spacing, depth, youngs_modulus, poisson_ratio):
    """CompositeBlock with the modulus ``factor`` (layers, ny, nx) times ``youngs_modulus`` in Pa in every element.

    ``spacing`` (dy, dx) in m; ``depth`` (layers + 1,) in m as of ``layered_compliance``. ConfigError for factors that
    are not above 0.
    """
    factor = np.asarray(factor, float)
    if not np.isfinite(factor).all() or factor.min() <= 0:
        raise ConfigError("composite block: factors of the modulus", "finite values above 0", f"{factor.min():g}")
    inverse, carried, below = [], [], None
    for symbol in layer_symbols(factor.shape[1:], spacing, depth[::-1], youngs_modulus, poisson_ratio):
        top, coupling, bottom = symbol[..., :3, :3], symbol[..., :3, 3:], symbol[..., 3:, 3:]
        whole = top
        if below is not None:
            deeper = np.linalg.inv(bottom + below)
            inverse.append(deeper)
            carried.append(coupling @ deeper)
            whole = top - carried[-1] @ symbol[..., 3:, :3]
        below = whole
    inverse.append(np.linalg.inv(below))
    bricks = (brick_stiffness((*spacing[::-1], thickness), youngs_modulus, poisson_ratio)
              for thickness in np.diff(depth))
    stiffness = tuple(brick.reshape(24, 24) for brick in bricks)
    return CompositeBlock(factor, stiffness, np.array(inverse[::-1]), np.array(carried[::-1]).reshape(
        len(factor) - 1, *inverse[0].shape), spacing[0] * spacing[1])


def _times(matrices, vectors):
    return np.einsum("yxij,yxj->yxi", matrices, vectors)
