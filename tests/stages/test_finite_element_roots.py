"""Unstable roots of the default brake beside those of its full finite-element matrices, solved directly.

The steady sliding state is that of the reduced model; bodies, joints, contacts, friction and loss factors are assembled
anew from the product Structure, without any reduction.
"""

import numpy as np
import pytest
import scipy
import scipy.sparse.linalg

import stages
from pipeline.case_models.steady_sliding import posed
from pipeline.contract import Context, case
from pipeline.physics.fem.elasticity import gyroscopic
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.numerics.sparse_solver import available
from pipeline.physics.sliding.model import loss_stiffness
from pipeline.recordings import registry
from pipeline.systems.fem_bodies import body_rows, elastic_body
from stages.complex_modes import _friction_law, _Losses, _operate
from tests.chain.conftest import ROOT

SPEED = 10.25
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
        self.stiffness = stiffness + self.spread(joints, structure.joint_stiffness, joints)
        self.loss = blocks([b.loss() for b in bodies], free) + self.spread(
            joints, structure.joint_loss_factor * structure.joint_stiffness, joints)
        self.contact = [rows(getattr(structure, f"contact_{name}")) for name in ("normal", "tangent", "lateral")]
        self._with_line(structure, rows(structure.piston_rows))

    def _with_line(self, structure, piston):
        """One more mass for the fluid in the line, tied to piston and cylinder by the column in the bore."""
        none = np.zeros(1)

        def grown(matrix, diagonal=none):
            return scipy.sparse.block_diag([matrix, np.diag(diagonal)], format="csr")

        tie = scipy.sparse.hstack([piston, [[-1.0]]], format="csr")
        self.drag = grown(0 * self.mass, structure.line_drag)
        self.mass, self.gyroscopic = grown(self.mass, structure.line_inertia), grown(self.gyroscopic)
        self.stiffness = grown(self.stiffness) + self.spread(tie, structure.fluid_stiffness, tie)
        self.loss = grown(self.loss) + self.spread(tie, structure.fluid_loss_factor * structure.fluid_stiffness, tie)
        self.contact = [scipy.sparse.hstack([each, np.zeros((each.shape[0], 1))], format="csr")
                        for each in self.contact]
        self.size += 1

    @staticmethod
    def spread(left, weight, right):
        return left.T @ scipy.sparse.diags(weight) @ right

    def about(self, model, friction):
        """(C, K): linearised about the steady sliding of a SlidingModel, equations (2) and (3) of its module."""
        contacts, (normal, tangent, lateral) = model.contacts, self.contact
        coupling = model.direction() * (friction.coefficient + contacts.pressure * friction.pressure_slope)
        turning = friction.coefficient * contacts.preload / abs(model.sliding_speed)
        damping = (self.drag + model.speed * self.gyroscopic + self.spread(normal, contacts.damping, normal)
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


@pytest.mark.slow
@pytest.mark.exact
def test_unstable_roots_are_those_of_the_full_matrices():
    """Within 0.05 % of the frequency and 5 % or 10 1/s of the growth rate: five modes at two pressures."""
    chosen = case.load(ROOT / "configs" / "disc_brake.yaml", stages.CHAINS, stages.load,
                       ("structure.pressures=[2 MPa, 3 MPa]",), registry.path).sections
    context, product = Context(solver=available()[0]), None
    for name in ("surface", "micro_friction", "friction_map"):
        product = stages.load(name)(*([product] if product else []), settings=chosen[name], context=context)
    structure = stages.load("structure")(product, settings=chosen["structure"], context=context)
    model = stages.load("reduced_model")(structure, settings=chosen["reduced_model"], context=context)
    settings, elements, compared = chosen["complex_modes"], FiniteElements(structure), 0
    losses = _Losses(model.contact_body, loss_stiffness(model), model.damping)
    for state, pressure in enumerate(model.pressure):
        there = posed(model, state, SPEED, settings.damping_speed)
        law = _friction_law(product, model, settings)
        found = _operate(settings, law, losses, (there, pressure * model.input_area))
        about = found.sliding.about(there.bench.model)
        matrices = elements.about(about, found.sliding.acting(settings.friction_slopes))
        for root in found.growing:
            direct, residual = elements.root_near(root, *matrices)
            assert residual < 1e-5
            assert root.imag == pytest.approx(direct.imag, rel=5e-4)
            assert root.real == pytest.approx(direct.real, rel=0.05, abs=10.0)
            compared += 1
    assert compared >= 5
