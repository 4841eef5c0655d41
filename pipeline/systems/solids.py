"""What the systems of finite-element bodies are made of: solids, and displacement rows that tie them.

A row holds one weight per body and degree of freedom (3 node + axis).
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.fem.elasticity import assemble
from pipeline.physics.fem.mesh import Mesh
from pipeline.physics.fem.ties import tie_stiffness


@dataclass(frozen=True)
class Solid:
    """Mesh, material row of each element, material table, rigidly held nodes; ``loss_factor`` (materials,), none by
    default; ``ties`` between parts of its mesh."""

    mesh: Mesh
    element_material: np.ndarray
    material_name: tuple
    density: np.ndarray
    elasticity: np.ndarray
    damping_ratio: float
    supported: np.ndarray
    loss_factor: np.ndarray | float = 0.0
    ties: tuple = ()

    def matrices(self):
        """Stiffness and mass (3n, 3n) sparse of the body, supports not yet held."""
        mesh = self.mesh
        matrices = assemble(mesh.node, mesh.element, mesh.kind, self.element_material, self.density, self.elasticity)
        return (matrices[0] + tie_stiffness(self.ties, len(mesh.node)), matrices[1]) if self.ties else matrices


@dataclass(frozen=True)
class Rows:
    """One (rows, 3 nodes) sparse matrix per body."""

    parts: tuple

    @property
    def count(self):
        """Number of rows."""
        return self.parts[0].shape[0]

    @property
    def matrix(self):
        """All bodies side by side."""
        return scipy.sparse.hstack(self.parts, format="csr")


@dataclass(frozen=True)
class Joints:
    """Springs [N/m] with loss factors and dampers [N s/m] along rows."""

    name: tuple
    stiffness: np.ndarray
    damping: np.ndarray
    rows: Rows
    loss_factor: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Contacts:
    """Patches on the disc: body that slides there, centroid, area and three relative displacements, body less disc."""

    body: np.ndarray
    position: np.ndarray
    area: np.ndarray
    normal: Rows
    tangent: Rows
    lateral: Rows


@dataclass(frozen=True)
class Assembly:
    """Solids, their joints, contacts and sensors."""

    bodies: tuple
    joints: Joints
    contacts: Contacts
    sensors: Rows
    sensor_position: np.ndarray
    sensor_direction: np.ndarray
