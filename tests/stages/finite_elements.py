"""Full matrices of a product Structure and a direct solution for their roots, beside those of the library."""

import numpy as np
import scipy
import scipy.sparse.linalg

from pipeline.physics.fem.elasticity import gyroscopic
from pipeline.physics.fem.supports import free_freedoms
from pipeline.systems.fem_bodies import body_rows, elastic_body

ITERATIONS = 30


def blocks(matrices, free):
    return scipy.sparse.block_diag(matrices, format="csr")[free][:, free]


class FiniteElements:
    """Full matrices of a product Structure: mass, stiffness, loss, gyroscopic terms, rows of contacts."""

    def __init__(self, structure):
        bodies = [elastic_body(structure, name) for name in structure.body_name]
        first = np.cumsum([0, *(3 * len(b.node) for b in bodies)])
        free = np.concatenate([k + free_freedoms(len(b.node), b.supported)
                               for k, b in zip(first, bodies, strict=False)])
        self.size = len(free)
        stiffness, self.mass = (blocks(part, free) for part in zip(*(b.matrices() for b in bodies), strict=True))
        self.gyroscopic = blocks([gyroscopic(b.node, b.element, b.kind, b.material, b.density)[0] if b.turns
                                  else scipy.sparse.csr_matrix((3 * len(b.node),) * 2) for b in bodies], free)

        def rows(incidence):
            return scipy.sparse.hstack([body_rows(incidence, k, len(b.node)) for k, b in enumerate(bodies)],
                                       format="csr")[:, free]

        joints = rows(structure.joint_rows)
        self.damping = self.spread(joints, structure.joint_damping, joints)
        self.stiffness = stiffness + self.spread(joints, structure.joint_stiffness, joints)
        self.loss = blocks([b.loss() for b in bodies], free) + self.spread(
            joints, structure.joint_loss_factor * structure.joint_stiffness, joints)
        self.contact = [rows(getattr(structure, f"contact_{name}")) for name in ("normal", "tangent", "lateral")]
        if len(structure.fluid_stiffness):
            self._with_line(structure, rows(structure.piston_rows))

    def _with_line(self, structure, piston):
        """One more mass for the fluid in the line, tied to piston and cylinder by the column in the bore."""
        none = np.zeros(1)

        def grown(matrix, diagonal=none):
            return scipy.sparse.block_diag([matrix, np.diag(diagonal)], format="csr")

        tie = scipy.sparse.hstack([piston, [[-1.0]]], format="csr")
        self.damping = grown(self.damping, structure.line_drag)
        self.mass, self.gyroscopic = grown(self.mass, structure.line_inertia), grown(self.gyroscopic)
        self.stiffness = grown(self.stiffness) + self.spread(tie, structure.fluid_stiffness, tie)
        self.loss = grown(self.loss) + self.spread(tie, structure.fluid_loss_factor * structure.fluid_stiffness, tie)
        self.contact = [scipy.sparse.hstack([each, np.zeros((each.shape[0], 1))], format="csr")
                        for each in self.contact]
        self.size += 1

    @staticmethod
    def spread(left, weight, right):
        return left.T @ scipy.sparse.diags(np.broadcast_to(weight, left.shape[0])) @ right

    def about(self, model, friction, friction_damping=True):
        """(C, K): linearised about the steady sliding of a SlidingModel, equations (2) and (3) of its module."""
        contacts, (normal, tangent, lateral) = model.contacts, self.contact
        coupling = model.direction() * (friction.coefficient + contacts.pressure * friction.pressure_slope)
        turning = friction_damping * friction.coefficient * contacts.preload / abs(model.sliding_speed)
        damping = (self.damping + model.speed * self.gyroscopic + self.spread(normal, contacts.damping, normal)
                   + self.spread(tangent, coupling * contacts.damping, normal)
                   + self.spread(tangent, contacts.preload * friction.speed_slope, tangent)
                   + self.spread(lateral, turning, lateral))
        return damping, (self.stiffness + 1j * self.loss + self.spread(normal, contacts.stiffness, normal)
                         + self.spread(tangent, coupling * contacts.stiffness, normal))

    def root_near(self, guess, damping, stiffness):
        """Root and its residual, by inverse iteration about ``guess``."""
        factor = scipy.sparse.linalg.splu(
            (guess**2 * self.mass + guess * damping + stiffness).tocsc(), permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.01, options={"SymmetricMode": True})
        slope = 2 * guess * self.mass + damping
        x = factor.solve(np.random.default_rng(0).standard_normal(self.size).astype(complex))
        for _ in range(ITERATIONS):
            x = x / np.linalg.norm(x)
            moved = factor.solve(slope @ x)
            share, x = np.vdot(x, moved), moved
        root, x = guess - 1 / share, x / np.linalg.norm(x)
        left = (root**2 * self.mass + root * damping + stiffness) @ x
        return root, np.linalg.norm(left) / np.linalg.norm(stiffness @ x)
