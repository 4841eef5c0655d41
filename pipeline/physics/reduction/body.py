"""One finite-element body in reduced coordinates: matrices, rows of the sliding model and shapes of its surface.

A supported body keeps its modes and its residual static response to the forces on it, and so does a free body that is
loaded in patterns. A free body without them keeps interface coordinates, fixed-interface modes and the residual inertia
of its moving interface (Craig-Bampton). A body that turns about z gets gyroscopic and centrifugal terms.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, centrifugal_load, geometric_stiffness, gyroscopic
from pipeline.physics.fem.mesh import Mesh, boundary_faces, corners
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.fem.ties import tie_stiffness
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.reduction.craig_bampton import (
    attachment,
    craig_bampton,
    independent_rows,
    modal_damping,
    projected,
)

#: inertia that holds a free body acts at this share of the frequency of its last mode
_INERTIA_SHARE = 0.05
#: rigid motions show as frequencies below this share of those of single elements
_RIGID_SHARE = 1e-5


@dataclass(frozen=True)
class ElasticBody:
    """Mesh, materials and supports of a body; degree of freedom = 3 node + axis.

    ``rows`` (r, 3n) sparse are all displacement rows that the model reads; those numbered in ``interface`` (i,) carry
    forces. ``patterns`` (i, p) sparse: forces on these that static responses are kept for; None = each by itself.
    ``loss_factor`` (materials,) of the materials; ``part``: numbers of those whose stiffness is wanted by itself as
    well; ``ties``: Ties of unlike meshes. ``frequency`` (m,) Hz and ``modes`` (3n, m) are not needed of a free body
    without patterns.
    """

    name: str
    node: np.ndarray
    element: np.ndarray
    kind: str
    material: np.ndarray
    density: np.ndarray
    elasticity: np.ndarray
    damping_ratio: float
    supported: np.ndarray
    rows: "scipy.sparse.csr_matrix"
    interface: np.ndarray
    turns: bool
    frequency: np.ndarray
    modes: np.ndarray
    patterns: "scipy.sparse.csr_matrix | None" = None
    loss_factor: np.ndarray | float = 0.0
    part: tuple = ()
    ties: tuple = ()

    def matrices(self):
        """Stiffness and mass (3n, 3n) sparse of the body, supports not yet held."""
        matrices = assemble(self.node, self.element, self.kind, self.material, self.density, self.elasticity)
        return (matrices[0] + tie_stiffness(self.ties, len(self.node)), matrices[1]) if self.ties else matrices

    def loss(self):
        """Imaginary part (3n, 3n) sparse of the stiffness: that of its materials times their loss factors."""
        lost = np.broadcast_to(self.loss_factor, len(self.density))[:, None, None] * self.elasticity
        return assemble(self.node, self.element, self.kind, self.material, self.density, lost)[0]

    def stiffness_of_part(self):
        """Stiffness (3n, 3n) sparse of the materials ``part`` alone."""
        kept = np.isin(np.arange(len(self.density)), self.part)[:, None, None] * self.elasticity
        return assemble(self.node, self.element, self.kind, self.material, self.density, kept)[0]


@dataclass(frozen=True)
class BodyTerms:
    """Matrices (k, k), rows (r, k), and the surface: positions (v, 3), quadrilaterals (f, 4), recovery (v, 3, k).

    ``loss`` is the imaginary part of the stiffness, ``part`` the stiffness of the materials wanted by themselves, or
    None.
    """

    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    centrifugal: np.ndarray
    rows: np.ndarray
    position: np.ndarray
    face: np.ndarray
    recovery: np.ndarray
    loss: np.ndarray | float = 0.0
    part: np.ndarray | None = None


def reduce_body(body, fixed_below, residual_below, solver):
    """BodyTerms of an ElasticBody.

    ``fixed_below`` [Hz] limits the fixed-interface modes of a free body without patterns, ``residual_below`` [Hz] the
    pseudo-frequencies of the residual shapes of all kinds. Raises ConfigError for a turning body without supports.
    """
    stiffness, mass = body.matrices()
    free = free_freedoms(len(body.node), body.supported)
    stiffness, mass, rows = stiffness[free][:, free], mass[free][:, free], scipy.sparse.csr_matrix(body.rows)[:, free]
    interface, factor = _loads(rows[body.interface], body.patterns), None
    if body.turns and not len(body.supported):
        raise ConfigError(f"reduced model: {body.name}", "a turning body on rigid supports", "none",
                          "hold the nodes of its mount")
    if len(body.supported) or body.patterns is not None:
        held = stiffness if len(body.supported) else _held_by_inertia(stiffness, mass, body.frequency, solver)
        factor = factorise(held, solver)
        reduced = attachment(stiffness, mass, interface, body.frequency, body.modes[free], residual_below, factor)
    else:
        reduced = craig_bampton(stiffness, mass, interface, fixed_below, solver, residual_below)
    size = reduced.shape.shape[1]
    whirl, centrifugal = ((projected(a, reduced.shape) for a in rotation(body, free, factor)) if body.turns
                          else (np.zeros((size, size)),) * 2)
    part = projected(body.stiffness_of_part()[free][:, free], reduced.shape) if body.part else None
    return BodyTerms(reduced.mass, modal_damping(reduced.mass, reduced.stiffness, body.damping_ratio), whirl,
                     reduced.stiffness, centrifugal, rows @ reduced.shape, *_surface(body, free, reduced.shape),
                     _loss(body, free, reduced), part)


def _loss(body, free, reduced):
    """(k, k) N/m, imaginary part of the reduced stiffness."""
    factors = np.unique(body.loss_factor)
    if len(factors) == 1:
        return factors[0] * reduced.stiffness
    return projected(body.loss()[free][:, free], reduced.shape)


def _loads(rows, patterns):
    """Independent rows (k, n) sparse along which static responses are kept."""
    loads = rows if patterns is None else scipy.sparse.csr_matrix(patterns.T @ rows)
    return loads[independent_rows(loads)]


def _held_by_inertia(stiffness, mass, frequency, solver):
    """The stiffness of a free body, regular by w^2 M with w far below its modes that are left out: below the last of
    those kept, or where these are all rigid motions, below the first one left out."""
    if not len(frequency):
        raise ConfigError("reduced model", "rigid motions among the modes of a free body", "no mode",
                          "raise structure.frequency_max")
    last, of_elements = frequency[-1], np.sqrt(stiffness.diagonal().sum() / mass.diagonal().sum()) / (2 * np.pi)
    if last < _RIGID_SHARE * of_elements:
        last = lowest_modes(stiffness, mass, solver, count=len(frequency) + 1)[0][-1]
    return stiffness + (2 * np.pi * _INERTIA_SHARE * last) ** 2 * mass


def rotation(body, free, factor):
    """Gyroscopic matrix per speed; stress stiffening less convective inertia, per squared speed: (f, f) sparse.

    ``free`` (f,): degrees of freedom of the ElasticBody that are not held; ``factor``: of their stiffness.
    """
    mesh = body.node, body.element, body.kind, body.material
    whirl, convective = gyroscopic(*mesh, body.density)
    stretched = np.zeros(3 * len(body.node))
    stretched[free] = factor.solve(centrifugal_load(*mesh, body.density)[free])
    stiffening = geometric_stiffness(*mesh, body.elasticity, stretched) - convective
    return whirl[free][:, free], stiffening[free][:, free]


def _surface(body, free, shape):
    """Corner nodes of the boundary faces, the faces on them, and their displacement per coordinate (float32)."""
    faces = boundary_faces(Mesh(body.node, body.element, body.kind, np.zeros((len(body.element), 3), int)))
    visible, face = np.unique(corners(faces), return_inverse=True)
    row_of = np.full(3 * len(body.node), -1)
    row_of[free] = np.arange(len(free))
    rows = row_of[3 * visible[:, None] + np.arange(3)]
    recovery = np.where((rows >= 0)[..., None], shape[rows], 0.0).astype(np.float32)
    return body.node[visible], face.reshape(-1, 4), recovery
