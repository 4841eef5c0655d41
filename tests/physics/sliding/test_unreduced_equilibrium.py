"""Steady sliding of sparse models, beside that condensed to the contacts."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import scipy

from pipeline.contract import ConvergenceError
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.sliding.equilibrium import closure_response, from_map, steady_sliding
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.sliding.unreduced_equilibrium import Solutions, _Equilibrium, sliding_on_elements
from tests.stages.small_brake import small_brake, small_map

BRAKE = small_brake()
LAW = BRAKE.law_closure, BRAKE.law_pressure
FRICTION = partial(from_map, FrictionLaw.of(small_map()), 1e-2)


def sparse(model):
    """The model with sparse matrices and rows."""
    kept, csr = ("mass", "damping", "gyroscopic", "stiffness", "centrifugal"), scipy.sparse.csr_matrix
    contacts = replace(model.contacts, **{name: csr(getattr(model.contacts, name))
                                          for name in ("normal", "tangent", "lateral")})
    return replace(model, **{name: csr(getattr(model, name)) for name in kept}, contacts=contacts,
                   joints=replace(model.joints, rows=csr(model.joints.rows)))


@pytest.mark.exact
@pytest.mark.parametrize("pressure", [3e5, 3e6])
def test_forces_are_those_of_the_bodies_condensed_to_their_contacts(pressure):
    model = sliding_model(BRAKE, 1, 10.0)
    load = pressure * BRAKE.input_area
    expected = steady_sliding(model, closure_response(model), load, *LAW, FRICTION)
    made = sliding_on_elements(sparse(model), load, LAW, FRICTION, np.full(6, LAW[0][3]), Solutions("superlu"))
    largest = expected.contact.force.max()
    np.testing.assert_allclose(made.contact.force, expected.contact.force, rtol=1e-7, atol=1e-7 * largest)
    np.testing.assert_allclose(made.contact.stiffness, expected.contact.stiffness, rtol=1e-7)
    np.testing.assert_allclose(made.friction.coefficient, expected.friction.coefficient, rtol=1e-7)


@pytest.fixture
def factors(monkeypatch):
    """Whether each factor that is made is of a symmetric matrix."""
    made, name = [], "pipeline.physics.sliding.unreduced_equilibrium.factorise"
    monkeypatch.setattr(name, lambda matrix, solver, symmetric: made.append(symmetric)
                        or factorise(matrix, solver, symmetric))
    return made


def test_one_factor_without_friction_serves_states_at_other_loads(factors):
    model, shared = sparse(sliding_model(BRAKE, 1, 10.0)), Solutions("superlu")
    forces = [sliding_on_elements(model, load * BRAKE.input_area, LAW, FRICTION, np.full(6, LAW[0][9]),
                                  shared).contact.force.sum() for load in (2e6, 3e6)]
    assert factors == [True] and forces[1] == pytest.approx(1.5 * forces[0], rel=0.05)


@pytest.mark.exact
def test_where_that_is_slow_one_with_friction_does(factors, monkeypatch):
    model = sparse(sliding_model(BRAKE, 1, 10.0))
    expected, found = (sliding_on_elements(model, 3e6 * BRAKE.input_area, LAW, FRICTION, np.full(6, LAW[0][9]),
                                           Solutions("superlu")).contact.force
                       for _ in map(partial(monkeypatch.setattr, f"{Solutions.__module__}._ITERATIONS"), (40, 1)))
    assert factors[:3] == [True, True, False]
    np.testing.assert_allclose(found, expected, rtol=1e-7)


@pytest.mark.exact
def test_a_state_begins_where_the_last_one_was(monkeypatch):
    """At nearly the same load, and then needs no step in which all of the load is found."""
    model, shared, begun = sparse(sliding_model(BRAKE, 1, 10.0)), Solutions("superlu"), []
    monkeypatch.setattr(_Equilibrium, "linear", lambda self, closure, linear=_Equilibrium.linear:
                        begun.append(closure) or linear(self, closure))
    first, near = (sliding_on_elements(model, load * BRAKE.input_area, LAW, FRICTION, np.full(6, LAW[0][9]), shared)
                   for load in (3e6, 3.03e6))
    assert len(begun) == 1
    alone = sliding_on_elements(model, 3.03e6 * BRAKE.input_area, LAW, FRICTION, np.full(6, LAW[0][9]),
                                Solutions("superlu"))
    np.testing.assert_allclose(near.contact.force, alone.contact.force, rtol=1e-7)
    assert near.contact.force.sum() > first.contact.force.sum()


def test_friction_turns_with_the_direction_of_sliding():
    forth, back = (sliding_on_elements(sparse(sliding_model(BRAKE, 1, speed)), 3e6 * BRAKE.input_area, LAW, FRICTION,
                                       np.full(6, LAW[0][9]), Solutions("superlu")).contact.force
                   for speed in (10.0, -10.0))
    np.testing.assert_allclose(forth[:3], back[2::-1], rtol=1e-6)


def test_forces_that_do_not_balance_are_an_error(monkeypatch):
    monkeypatch.setattr("pipeline.physics.sliding.unreduced_equilibrium._STEPS", 1)
    model = sparse(sliding_model(BRAKE, 1, 10.0))
    with pytest.raises(ConvergenceError, match="steady sliding on finite elements: expected nodal forces"):
        sliding_on_elements(model, 3e6 * BRAKE.input_area, LAW, FRICTION, np.full(6, LAW[0][40]), Solutions("superlu"))
