"""A disc brake as finite elements alone: no modes, no reduction; bodies that did not change are assembled once."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import scipy

from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.numerics.sparse_blocks import on_diagonal
from pipeline.physics.reduction.body import ElasticBody
from pipeline.physics.sliding.model import Contacts, Joints, SlidingModel
from pipeline.systems.fem_bodies import full_matrices, with_fluid

_MATRICES = ("mass", "stiffness", "gyroscopic", "centrifugal")


@dataclass
class BodyMatrices:
    """Sparse matrices of Solids, each kept for brakes that have the same one; ``solver`` of linear equations."""

    solver: str
    _known: dict = field(default_factory=dict)

    def of(self, name, solid):
        """(mass, complex stiffness, gyroscopic, centrifugal) of a Solid in its free freedoms, as the body ``name``."""
        for known, matrices in self._known.setdefault(name, []):
            if _same(known, solid):
                return matrices
        matrices = full_matrices(_elastic(name, solid), _free(solid), self.solver)
        self._known[name].append((solid, matrices))
        return matrices


def freedoms(brake):
    """Degrees of freedom of the bodies of a DiscBrake that are not held."""
    return sum(len(_free(solid)) for solid in brake.bodies)


def unreduced(brake, matrices, speed, fluid_loss=0.0):
    """SlidingModel of a DiscBrake at a ``speed`` of the disc, rad/s: sparse, supported nodes left out.

    Loss factors are the imaginary parts of the stiffnesses; damping ratios of bodies, which are of their modes, do not
    enter. Contacts bear nothing yet. ``matrices``: BodyMatrices; ``fluid_loss``: loss factor of the brake fluid.
    """
    sizes = [len(_free(solid)) for solid in brake.bodies]
    parts = zip(*(matrices.of(*each) for each in zip(brake.names, brake.bodies, strict=True)), strict=True)
    blocks = {name: on_diagonal(part) for name, part in zip(_MATRICES, parts, strict=True)}
    free = np.concatenate([first + _free(solid) for first, solid in zip(
        np.cumsum([0, *(3 * len(solid.mesh.node) for solid in brake.bodies)]), brake.bodies, strict=False)])
    joints, contacts = brake.joints, brake.contacts
    normal, tangent, lateral, held, inputs, sensors = (
        rows.matrix[:, free] for rows in (contacts.normal, contacts.tangent, contacts.lateral, joints.rows,
                                          brake.piston, brake.sensors))
    none = np.zeros(len(contacts.area))
    model = SlidingModel(
        body_name=brake.names, coordinate_body=np.repeat(np.arange(len(sizes)), sizes), **blocks,
        damping=scipy.sparse.csr_matrix((sum(sizes),) * 2),
        joints=Joints(tuple(joints.name), held, joints.stiffness * (1 + 1j * joints.loss_factor), joints.damping),
        contacts=Contacts(normal, tangent, lateral, contacts.position, contacts.area,
                          np.hypot(*contacts.position[:, :2].T), none, none, none),
        input_name=tuple(f"piston_{k + 1}" for k in range(inputs.shape[0])), input_rows=inputs, sensor_name=(),
        sensor_rows=sensors, speed=float(speed))
    return model if brake.fluid is None else with_fluid(model, _fluid(brake, fluid_loss))


def _fluid(brake, loss):
    """Fields of the fluid of a Structure."""
    column, each = brake.fluid, np.ones(brake.piston.count)
    return SimpleNamespace(line_inertia=column.inertia * each, line_drag=column.drag * each,
                           fluid_stiffness=column.stiffness * each, fluid_loss_factor=loss * each)


def _free(solid):
    return free_freedoms(len(solid.mesh.node), solid.supported)


def _elastic(name, solid):
    mesh = solid.mesh
    return ElasticBody(name=name, node=mesh.node, element=mesh.element, kind=mesh.kind, material=solid.element_material,
                       density=solid.density, elasticity=solid.elasticity, damping_ratio=0.0, supported=solid.supported,
                       rows=None, interface=None, turns=name == "disc", frequency=(), modes=None,
                       loss_factor=solid.loss_factor, ties=solid.ties)


def _same(first, other):
    """Whether two Solids have the same mesh and materials."""
    pairs = [(a.mesh.node, a.mesh.element, a.element_material, a.density, a.elasticity, a.supported,
              np.broadcast_to(a.loss_factor, len(a.density))) for a in (first, other)]
    return all(np.array_equal(*each) for each in zip(*pairs, strict=True))
