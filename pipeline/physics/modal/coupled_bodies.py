"""Modes of bodies in reduced coordinates that springs tie together, and what each spring has in them.

    (K + sum_s k_s b_s b_s^T) x = w^2 M x,    d ln w / d ln k_s = k_s (b_s x)^2 / (2 w^2)  with x^T M x = 1:

half the share of a spring in the strain energy of a mode (R. L. Fox, M. P. Kapoor, AIAA J. 6 (1968) 2426). The
reduction of the bodies is that of the springs as well as long as their rows are among its interface.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.reduction.craig_bampton import ReducedBody, attachment, craig_bampton, independent_rows

#: modes below this share of the frequency limit count as rigid motions
_RIGID = 1e-4
#: limit of the pseudo-frequencies of residual shapes, Hz
_RESIDUAL = 1e6


@dataclass(frozen=True)
class CoupledBodies:
    """Bodies side by side: ``mass`` and ``stiffness`` (k, k) without springs, ``rows`` (s, k) of these."""

    mass: np.ndarray
    stiffness: np.ndarray
    rows: np.ndarray

    def held(self, springs):
        """Stiffness (k, k) with ``springs`` (s,) N/m."""
        return self.stiffness + (self.rows.T * springs) @ self.rows

    def modes(self, springs, below):
        """(frequency (m,) Hz, mass-normalised shape (k, m), share (s, m) of springs in the strain energy).

        Elastic modes ``below`` a frequency in Hz, ascending, with ``springs`` (s,) N/m.
        """
        square, shape = scipy.linalg.eigh(self.held(springs), self.mass)
        frequency = np.sqrt(np.maximum(square, 0.0)) / (2 * np.pi)
        wanted = (frequency < below) & (frequency > _RIGID * below)
        frequency, shape = frequency[wanted], shape[:, wanted]
        return frequency, shape, springs[:, None] * (self.rows @ shape) ** 2 / square[wanted]


def side_by_side(bodies, rows):
    """CoupledBodies of ReducedBodies and their parts [(s, n)] sparse of the rows."""
    mass, stiffness = (scipy.linalg.block_diag(*(getattr(body, name) for body in bodies))
                       for name in ("mass", "stiffness"))
    return CoupledBodies(mass, stiffness, np.hstack([part @ b.shape for part, b in zip(rows, bodies, strict=True)]))


def reduced_body(solid, rows, below, solver):
    """ReducedBody of a Solid whose shape (3 nodes, k) is 0 where it is held.

    ``rows`` (r, 3 nodes) sparse: its interface; ``below`` Hz: modes kept, with the interface fixed where nothing holds
    the body. Residual shapes beside them make the response to static forces on the interface exact.
    """
    stiffness, mass = solid.matrices()
    free = free_freedoms(len(solid.mesh.node), solid.supported)
    stiffness, mass, rows = stiffness[free][:, free], mass[free][:, free], rows.tocsr()[:, free]
    loads = rows[independent_rows(rows)] if rows.nnz else rows[:0]
    if not len(solid.supported):
        reduced = craig_bampton(stiffness, mass, loads, below, solver, _RESIDUAL)
    else:
        frequency, modes = lowest_modes(stiffness, mass, solver, below=below)
        reduced = _with_residuals(stiffness, mass, loads, frequency, modes, below, solver)
    shape = np.zeros((3 * len(solid.mesh.node), reduced.shape.shape[1]))
    shape[free] = reduced.shape
    return type(reduced)(shape, reduced.mass, reduced.stiffness, reduced.boundary, reduced.frequency)


def _with_residuals(stiffness, mass, loads, frequency, modes, below, solver):
    """ReducedBody of given modes, with the residual response to ``loads`` where there are any."""
    if not loads.shape[0]:
        return ReducedBody(modes, np.eye(len(frequency)), np.diag((2 * np.pi * frequency) ** 2), 0, frequency)
    return attachment(stiffness, mass, loads, frequency, modes, _RESIDUAL, factorise(stiffness, solver))
