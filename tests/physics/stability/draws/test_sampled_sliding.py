"""Sliding states of draws on a basis of static answers, beside those of the whole model."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.sliding.equilibrium import closure_response, steady_sliding
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.stability.draws.sampled_sliding import sliding_basis
from pipeline.physics.stability.draws.scatter import NOMINAL, Factors
from tests.physics.stability.draws.scattered_block import draws, family


def whole(case, factors, speed):
    drawn = case.at_speed(speed).varied(factors)
    response = closure_response(drawn.model)
    return steady_sliding(drawn.model, response, drawn.input_force, drawn.law_closure, drawn.law_pressure,
                          drawn.friction)


@pytest.fixture(scope="module")
def basis():
    return sliding_basis(family(), (1.5, 2.5), (NOMINAL, *draws(8, 1)))


def largest_error(basis, factors):
    """Of a contact force, as a share of the largest."""
    force, exact = basis.slide(factors, 2.5).force, whole(family(), factors, 2.5).contact.force
    return abs(force - exact).max() / exact.max()


@pytest.mark.exact
@pytest.mark.parametrize("factors", [NOMINAL, *draws(8, 1)])
def test_forces_of_training_draws_are_within_what_the_basis_states(basis, factors):
    assert largest_error(basis, factors) < 2 * basis.residual + 1e-9 < 2e-3


@pytest.mark.exact
@pytest.mark.parametrize("factors", draws(4, 7))
def test_forces_of_other_draws_are_those_of_the_whole_model(basis, factors):
    assert largest_error(basis, factors) < 5e-3


def test_contacts_without_a_law_keep_preload_and_stiffness():
    case = family(law_closure=(), law_pressure=())
    contact = sliding_basis(case, (2.0,)).slide(Factors(contact_stiffness=1.5), 2.0)
    np.testing.assert_array_equal(contact.force, case.model.contacts.preload)
    np.testing.assert_array_equal(contact.stiffness, 1.5 * case.model.contacts.stiffness)


def test_friction_beyond_any_sliding_state_is_refused():
    locked = family(friction=lambda p, v: FrictionState(0.5 + 1e-3 * p, 1e-3 + 0 * p, 0 * p))
    with pytest.raises(ConvergenceError, match="narrow the scatter"):
        sliding_basis(locked, (2.0,))
