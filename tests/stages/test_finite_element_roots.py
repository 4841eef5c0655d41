"""Unstable roots of the default brake, meshed coarsely, beside those of its full finite-element matrices.

Bodies, joints, contacts, friction and loss factors are assembled anew from the product Structure, and another sparse
solver factorises them. These matrices balance the contact forces of the steady sliding state, which is that of the
elements.
"""

import numpy as np
import pytest
import scipy.sparse.linalg

import stages
from pipeline.case_models.steady_sliding import posed, sliding_friction
from pipeline.contract import Context, case
from pipeline.physics.numerics.sparse_solver import available
from pipeline.physics.sliding.unreduced_equilibrium import Solutions
from pipeline.recordings import registry
from pipeline.systems.fem_bodies import full_model
from tests.commands import ROOT
from tests.stages.finite_elements import FiniteElements

SPEED = 10.25
#: coarser meshes: both ways solve the same matrices, of whatever size
COARSE = ("structure.disc.web_cells=2", "structure.disc.ring_cells=5", "structure.disc.angular_cells=48",
          "structure.pad.cells_per_patch=1", "structure.caliper.radial_cells=2", "structure.caliper.angular_cells=4",
          "structure.caliper.housing_cells=2", "structure.caliper.bridge_cells=2",
          "structure.bracket.element_size=15 mm")
#: friction that rises more steeply than that of the default case, so that more modes grow, at a fifth of the cost
ONE_PATCH = ("surface.pairs=1", "surface.nodes=128", "surface.patch_length=1 mm", "micro_friction.realisations=3",
             "micro_friction.pad.youngs_modulus=0.235 GPa")


def closures(elements, about, sliding, input_force):
    """(c,) m of the elements under the forces of a state, with springs at the contacts that hold loose pads."""
    contacts, contact, (normal, tangent, _) = about.contacts, sliding.contact, elements.contact
    springs = np.full(len(contact.force), contact.stiffness.max())
    held = contact.force - springs * (contact.closure + contacts.gap)
    drawn = about.direction() * sliding.friction.coefficient * contact.force
    force = about.input_rows.T @ input_force + normal.T @ held + tangent.T @ drawn
    stiffness = elements.stiffness + elements.spread(normal, springs, normal)
    return -(normal @ scipy.sparse.linalg.spsolve(stiffness.tocsc(), force)) - contacts.gap


@pytest.mark.slow
@pytest.mark.exact
def test_unstable_roots_are_those_of_the_full_matrices():
    """Within 0.05 % of the frequency and 1 1/s of the growth rate: five modes and more at two pressures."""
    chosen = case.load(ROOT / "configs" / "disc_brake.yaml", stages.CHAINS, stages.load,
                       (*ONE_PATCH, *COARSE, "structure.pressures=[2 MPa, 3 MPa]", "complex_modes.friction_steps=2",
                        f"complex_modes.speeds=[{SPEED} rad/s]"), registry.path).sections
    context, product = Context(solver=available()[0]), None
    for name in ("surface", "micro_friction", "friction_map"):
        product = stages.load(name)(*([product] if product else []), settings=chosen[name], context=context)
    structure = stages.load("structure")(product, settings=chosen["structure"], context=context)
    model = stages.load("reduced_model")(structure, settings=chosen["reduced_model"], context=context)
    settings, elements = chosen["complex_modes"], FiniteElements(structure)
    modes = stages.load("complex_modes")(model, product, None, structure, settings=settings, context=context)
    law, full = sliding_friction(product, model, settings), full_model(structure, context.solver)
    assert len(modes.unstable_root) >= 5 and set(modes.unstable_operating) == {0, 1}
    for state in set(modes.unstable_operating):
        there = posed(model, state, SPEED, settings.damping_speed)
        response, input_force = there.response(settings.centrifugal), model.pressure[state] * model.input_area
        sliding = there.slide(response, input_force, *law, settings)
        np.testing.assert_allclose(sliding.contact.force, modes.operating_force[state], rtol=1e-9)
        about, sliding = there.slide_on_elements(full, sliding, input_force, law[1], settings,
                                                 Solutions(context.solver))
        balanced = closures(elements, about, sliding, input_force)
        np.testing.assert_allclose(balanced, sliding.contact.closure, atol=1e-5 * abs(balanced).max())
        matrices = elements.about(about, sliding.acting(settings.friction_slopes))
        for k in np.flatnonzero(modes.unstable_operating == state):
            root, reduced = modes.unstable_root[k], modes.unstable_reduced[k]
            direct, residual = elements.root_near(root, *matrices)
            assert residual < 1e-5 and modes.unstable_residual[k] <= settings.residual_tolerance
            assert root.imag == pytest.approx(direct.imag, rel=5e-4)
            assert root.real == pytest.approx(direct.real, abs=1.0)
            assert reduced.imag == pytest.approx(direct.imag, rel=2e-3)
            assert reduced.real == pytest.approx(direct.real, abs=10.0)
