"""A block of finite elements pressed on a drive by a force, rubbed on its lower face, with two joints and losses."""

import numpy as np

from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.physics.stability.draws.scatter import Factors, Family, Pivot

LAW = np.linspace(0, 4e-6, 30), 2e11 * np.linspace(0, 4e-6, 30) + 1e17 * np.linspace(0, 4e-6, 30) ** 2


def friction(pressure, speed):
    """FrictionState that falls with pressure and speed."""
    return FrictionState(0.41 - 2e-8 * pressure - 0.02 * speed, np.full_like(pressure, -2e-8),
                         np.full_like(pressure, -0.02))


def family(**more):
    """Family of a block 60 x 20 x 30 mm on springs at its sides and on top."""
    mesh = block(np.linspace(0, 0.06, 7), np.linspace(0, 0.02, 2), np.linspace(0, 0.03, 4), kind="hexahedron")
    node, cells = mesh.node, np.zeros(len(mesh.element), int)
    stiffness, mass = (a.toarray() for a in assemble(node, mesh.element, mesh.kind, cells, np.array([3000.0]),
                                                     isotropic(5e9, 0.3)[None]))
    lower, n = np.flatnonzero(node[:, 2] == 0), 3 * len(node)
    normal, tangent, lateral = (np.eye(n)[3 * lower + axis] for axis in (2, 0, 1))
    joints = {f"side_{k}_{axis}": np.eye(n)[3 * np.flatnonzero(node[:, 0] == x)[0] + axis]
              for k, x in enumerate((0.0, 0.06)) for axis in range(3)}
    joints |= {f"top_{k}": np.eye(n)[3 * np.flatnonzero(node[:, 2] == 0.03)[4 * k] + axis]
               for k, axis in enumerate((0, 1, 2))}
    press, none, count = np.zeros((1, n)), np.zeros((n, n)), len(lower)
    press[0, 3 * np.flatnonzero(node[:, 2] == 0.03) + 2] = -1 / np.sum(node[:, 2] == 0.03)
    contacts = Contacts(normal, tangent, lateral, node[lower], np.full(count, 1e-4), np.ones(count),
                        np.full(count, 3000 / count), np.full(count, 1e8), np.zeros(count))
    springs = Joints(tuple(joints), np.array(list(joints.values())), np.full(len(joints), 2e7), np.zeros(len(joints)))
    model = SlidingModel(("block",), np.zeros(n, int), mass, none, none, stiffness, none, springs, contacts, ("press",),
                         press, (), np.empty((0, n)), 2.0)
    given = {"friction": friction, "damping_speed": 0.2,
             "loss": 0.01 * stiffness, "joint_loss_factor": np.full(len(joints), 0.05), "lining": 0.5 * stiffness,
             "lining_loss_factor": 0.01, "law_closure": LAW[0], "law_pressure": LAW[1],
             "pivot": Pivot(1e6, 2.0, (1e4, 1e8), (0.1, 10.0))}
    return Family(model, input_force=np.array([3000.0]), **{**given, **more})


def draws(count, seed):
    """Factors of ``count`` draws of everything."""
    rng = np.random.default_rng(seed)

    def factor(width, size=None):
        return np.exp(width * rng.standard_normal(size))

    return [Factors(factor(0.3, 9), factor(0.4, 9), factor(0.4), factor(0.15), factor(0.2), factor(0.5),
                    *rng.normal(0.0, (0.03, 0.01, 0.01))) for _ in range(count)]
