"""Modes of a few finite elements followed from another model, beside those that a whole search finds."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.case_models.refinement.element_modes import OperatingPoint, brake_of, element_modes, families
from pipeline.case_models.refinement.finer_settings import finer
from pipeline.case_models.refinement.reduced_starts import Starts
from pipeline.case_models.refinement.unreduced_brake import BodyMatrices, unreduced
from pipeline.contract import ConfigError
from pipeline.physics.numerics.sparse_solver import available
from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding.unreduced_equilibrium import Solutions, sliding_on_elements
from tests.case_models.refinement.tiny_brake import SECTION

LINEAR = SimpleNamespace(damping_speed=1.0, friction_slopes=True, friction_damping=True, gyroscopic=True,
                         centrifugal=True)
SOLVER = available()[0]
POINT, LAW = OperatingPoint(2e6, 10.0, 0.0, LINEAR), (np.array([0, 2e-6, 2e-5]), np.array([0, 1e6, 2e7]))


def friction(pressure, speed):
    return FrictionState(0.4 + 0 * pressure, 1e-9 + 0 * pressure, 0 * speed)


def operator(section, matrices):
    """((M, C, K), rows of the contacts, contacts, closures) of a brake about its steady sliding."""
    brake = brake_of(section, POINT)
    model = unreduced(brake, matrices, POINT.speed)
    load = np.full(model.input_rows.shape[0], POINT.pressure * brake.pad_area)
    state = sliding_on_elements(model, load, LAW, friction, np.full(len(brake.contacts.area), 2e-6),
                                Solutions(SOLVER))
    about = model_about(model, state.contact, 1.0).linearised(state.friction)
    rows = scipy.sparse.vstack((model.contacts.normal, model.contacts.tangent, model.contacts.lateral), format="csr")
    return about, rows, brake.contacts, state.contact.closure


def near(matrices, target, count):
    """(roots, vectors) nearest to a target by ARPACK on the first-order system."""
    mass, damping, stiffness = (matrix.astype(complex) for matrix in matrices)
    unit = scipy.sparse.identity(mass.shape[0], format="csr")
    left = scipy.sparse.bmat([[None, unit], [-stiffness, -damping]], format="csc")
    right = scipy.sparse.block_diag((unit, mass), format="csc")
    value, vector = scipy.sparse.linalg.eigs(left, count, right, sigma=target)
    return value, vector[:mass.shape[0]]


@pytest.mark.exact
def test_modes_of_a_finer_contact_are_those_of_a_whole_search_there():
    matrices, section = BodyMatrices(SOLVER), finer(SECTION, ["contact"], 1.5)
    coarse, rows, contacts, closure = operator(SECTION, matrices)
    root, shape = near(coarse, 2j * np.pi * 1500, 3)
    root, shape = root[order := np.argsort(root.imag)], shape[:, order]
    count = len(contacts.area)
    motion = (rows @ shape).reshape(3, count, -1)
    starts = Starts(root, motion, contacts.position, contacts.body, closure, LAW, friction)
    made = element_modes(section, POINT, starts, matrices, 1e-9)
    exact = near(operator(section, matrices)[0], 2j * np.pi * 1500, 5)[0]
    assert made.contacts == 36 and np.isfinite(made.root).all() and (made.likeness > 0.5).all()
    for found in made.root:
        assert abs(exact - found).min() < 1e-6 * abs(found)


def test_too_little_memory_is_said_before_anything_is_solved(monkeypatch):
    monkeypatch.setattr("pipeline.physics.numerics.memory.available_memory", lambda: 1e6)
    monkeypatch.setattr("pipeline.case_models.refinement.element_modes.unreduced", None)
    with pytest.raises(ConfigError, match="convergence.refinements: expected .* GB for a finite-element model of"):
        element_modes(SECTION, POINT, None, BodyMatrices(SOLVER), 1e-6)


def test_linings_are_as_stiff_as_at_the_operating_point():
    pad = SECTION.pad.model_copy(update={"lining_pressure_exponent": 0.5, "lining_pressure": 5e5,
                                         "lining_softening": 1e-3})
    plain, made = (brake_of(section, point).bodies[1].elasticity for section, point in (
        (SECTION, POINT), (SECTION.model_copy(update={"pad": pad}), OperatingPoint(2e6, 10.0, 100.0, LINEAR))))
    np.testing.assert_allclose(made[0], 2 * 0.9 * plain[0])
    np.testing.assert_allclose(made[1], plain[1])


def test_families_share_a_tenth_of_frequency():
    assert families(np.array([100.0, 109.0, 111.0, 200.0])) == [[0, 1], [2], [3]]
