"""The growth rate as a sum: terms add up, each is that of its own matrix, and a change of one shows in the root."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes
from pipeline.physics.sliding.model import FrictionState, sliding_model, spread
from pipeline.physics.stability.growth_balance import BODIES, CONTACT, SLIP, TURNING, body_shares, growth_terms
from tests.stages.small_brake import small_brake

STATE = FrictionState(0.5, 2e-8, -0.02)


def model_and_mode(state=STATE):
    product = small_brake()
    model = sliding_model(product, 1, 10.0)
    model = replace(model, contacts=replace(model.contacts, damping=model.contacts.preload / 2.0))
    modes = quadratic_modes(*model.linearised(state))
    kept = np.flatnonzero((modes.value.imag > 100) & (abs(modes.value.real) < 0.2 * modes.value.imag))
    return model, product.contact_body, modes.value[kept], modes.right[:, kept]


@pytest.mark.exact
def test_terms_are_those_of_their_matrices_and_add_up():
    model, body, roots, shapes = model_and_mode()
    contacts, (_, damping, stiffness) = model.contacts, model.supported()
    friction = model.friction_matrices(STATE)
    for root, x in zip(roots, shapes.T, strict=True):
        terms = growth_terms(model, STATE, root, x, body)
        inertia = 2 * root.imag * np.vdot(x, model.mass @ x).real

        def part(c, k, x=x, root=root, inertia=inertia):
            return -(root * np.vdot(x, c @ x) + np.vdot(x, k @ x)).imag / inertia

        assert terms[BODIES] == pytest.approx(part(damping, stiffness), abs=1e-7 * abs(root))
        assert terms[CONTACT] == pytest.approx(
            part(spread(contacts.normal, contacts.damping, contacts.normal), 0 * stiffness), abs=1e-9 * abs(root))
        fed = sum(value for name, value in terms.items() if name.startswith("friction at"))
        assert fed + terms[TURNING] + terms[SLIP] == pytest.approx(part(*friction), abs=1e-9 * abs(root))
        assert sum(terms.values()) == pytest.approx(root.real, abs=1e-9 * abs(root))


def test_a_little_less_of_a_term_changes_the_growth_by_about_it():
    """Contact damping less by a thousandth moves the root by its share, where friction is next to none."""
    model, body, roots, shapes = model_and_mode(FrictionState(1e-6))
    less = replace(model, contacts=replace(model.contacts, damping=0.999 * model.contacts.damping))
    moved = quadratic_modes(*less.linearised(1e-6)).value
    for root, x in zip(roots, shapes.T, strict=True):
        change = moved[np.argmin(abs(moved - root))].real - root.real
        share = growth_terms(model, 1e-6, root, x, body)[CONTACT]
        assert change == pytest.approx(-1e-3 * share, rel=0.05, abs=1e-7 * abs(root))


def test_shares_of_the_bodies():
    model, _, _, shapes = model_and_mode()
    for x in shapes.T:
        share = body_shares(model, x)
        assert share.shape == (4,) and share.sum() == pytest.approx(1.0) and (share >= 0).all()
    alone = np.zeros(model.size, complex)
    alone[0] = 1j
    np.testing.assert_array_equal(body_shares(model, alone), [1, 0, 0, 0])
