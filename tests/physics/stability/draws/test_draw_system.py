"""The system of a draw: that of the varied model, in the whole model and on a basis."""

import numpy as np
import pytest

from pipeline.physics.stability.draws.draw_system import BodyLosses, by_body, draw_system
from pipeline.physics.stability.draws.sampled_sliding import whole_sliding
from pipeline.physics.stability.draws.whole_roots import about_sliding, system_about
from pipeline.physics.system.terms import Owner, What
from tests.physics.stability.draws.scattered_block import draws, family

SPEED = 2.0


def drawn(factors):
    """(Family, its filled Factors, the System of the draw in the whole model)."""
    made = family()
    filled, model = made.filled(factors), made.model.at_speed(SPEED)
    contact = whole_sliding(made).slide(filled, SPEED)
    return made, filled, draw_system(made, model, filled, contact, BodyLosses.whole(made))


@pytest.mark.exact
@pytest.mark.parametrize("factors", draws(2, 3))
def test_a_draw_is_the_varied_model_about_its_own_sliding_state(factors):
    made, filled, system = drawn(factors)
    varied = made.at_speed(SPEED).varied(filled)
    for found, expected in zip(system.matrices(), system_about(varied, *about_sliding(varied)).matrices(), strict=True):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * abs(expected).max())


@pytest.mark.exact
def test_losses_on_a_basis_are_projections_of_the_whole():
    factors = draws(1, 3)[0]
    made, filled, system = drawn(factors)
    basis = np.random.default_rng(1).normal(size=(made.model.size, 4))
    whole = system.where(lambda term: term.name == What.HYSTERETIC_LOSS and term.owner is Owner.BODY)
    small = BodyLosses.on(made, basis).terms(filled, made.lining_loss_factor)
    found = sum(term.matrix for term in small if term.name == What.HYSTERETIC_LOSS)
    np.testing.assert_allclose(found, basis.T @ whole.matrices()[2].imag @ basis, rtol=1e-10, atol=1e-12)


def test_blocks_of_bodies_make_up_the_matrix():
    made = family()
    basis = np.eye(made.model.size)
    np.testing.assert_allclose(by_body(made.model, made.loss, basis).sum(axis=0), made.loss)
