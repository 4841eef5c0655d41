"""Modes of a few finite elements followed from another model, beside those that a whole search finds."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.case_models.matrices.full_matrices import Mode, full_modes, slid_on_elements
from pipeline.case_models.refinement import element_modes as searched
from pipeline.case_models.refinement.element_modes import OperatingPoint, brake_of, element_modes, families
from pipeline.case_models.refinement.finer_settings import finer
from pipeline.case_models.refinement.reduced_starts import Starts
from pipeline.case_models.refinement.unreduced_brake import BodyMatrices, unreduced
from pipeline.case_models.steady_sliding import Posed
from pipeline.contract import ConfigError, Context
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.nearest_modes import modes_near
from pipeline.physics.numerics.sparse_solver import available
from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding.unreduced_equilibrium import Solutions, sliding_on_elements
from pipeline.physics.time_stepping.simulate import Table
from pipeline.physics.virtual_rig.response import Bench
from tests.case_models.refinement.tiny_brake import SECTION

LINEAR = SimpleNamespace(damping_speed=1.0, friction_slopes=True, friction_damping=True, gyroscopic=True,
                         centrifugal=True, residual_tolerance=1e-9)
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
@pytest.mark.parametrize("lost", [False, True])
def test_modes_of_a_finer_contact_are_those_of_a_whole_search_there(monkeypatch, lost):
    """With the symmetric factor and, where that leads nowhere, with that of the whole matrix."""
    whole, wholes = searched._Search._whole, []
    monkeypatch.setattr(searched._Search, "_whole", lambda self, at: (wholes.append(at), whole(self, at))[1])
    if lost:
        monkeypatch.setattr(searched.Successive, "factor", lambda *_: SimpleNamespace(solve=lambda forces: forces))
    matrices, section = BodyMatrices(SOLVER), finer(SECTION, ["contact"], 1.5)
    coarse, rows, contacts, closure = operator(SECTION, matrices)
    root, shape = near(coarse, 2j * np.pi * 1500, 3)
    root, shape = root[order := np.argsort(root.imag)], shape[:, order]
    count = len(contacts.area)
    motion = (rows @ shape).reshape(3, count, -1)
    starts = Starts(root, motion, contacts.position, contacts.body, closure, LAW, friction)
    made = element_modes(section, POINT, starts, matrices, 1e-9)
    exact = near(operator(section, matrices)[0], 2j * np.pi * 1500, 5)[0]
    assert bool(wholes) == lost and made.contacts == 36 and np.isfinite(made.root).all() and (made.likeness > 0.5).all()
    for found in made.root:
        assert abs(exact - found).min() < 1e-6 * abs(found)


@pytest.mark.exact
def test_full_roots_of_complex_modes_are_those_that_convergence_finds_on_the_same_meshes():
    """From a reduced model whose sliding state is another: each way solves for that of the elements."""
    brake, matrices = brake_of(SECTION, POINT), BodyMatrices(SOLVER)
    full = unreduced(brake, matrices, POINT.speed)
    bench, load = reduced_bench(full), np.full(full.input_rows.shape[0], POINT.pressure * brake.pad_area)
    case, plain = Posed(bench, bench), (constant(0.4), friction)
    begin = case.slide(case.response(True), load, *plain, LINEAR)
    model = begin.about(bench.model)
    root, shape = modes_near(*model.linearised(begin.friction), 2j * np.pi * 1500, 1)
    modes = [Mode(0, 0, each, vector) for each, vector in zip(root, shape.T, strict=True)]
    (about, steady), = slid_on_elements(lambda: full, SOLVER, plain, LINEAR, [(case, case.response(True), load)])
    made = full_modes([(about, steady)], [model], modes, lambda about, sliding, roots, _: [(
        [about.contacts.preload], [sliding.contact.stiffness], [None])][0], LINEAR, Context(solver=SOLVER))
    motion = np.array([rows @ shape for rows in (model.contacts.normal, model.contacts.tangent,
                                                 model.contacts.lateral)])
    order = np.argsort(root.imag)
    contacts = brake.contacts
    starts = Starts(root[order], motion[..., order], contacts.position, contacts.body, begin.contact.closure, LAW,
                    friction)
    found = element_modes(SECTION, POINT, starts, matrices, 1e-9).root
    np.testing.assert_allclose([made[k].root for k in order], found, rtol=1e-8)
    other = steady.contact
    assert abs(begin.contact.force / other.force - 1).max() > 0.01
    assert all(np.array_equal(mode.terms, other.force) and np.array_equal(mode.contacts, other.stiffness)
               for mode in made)


def reduced_bench(full, count=150):
    """Bench of a sparse SlidingModel in so many of its modes with closed contacts, without losses."""
    contacts, normal = replace(full.contacts, stiffness=5e11 * full.contacts.area), full.contacts.normal
    joints = replace(full.joints, stiffness=full.joints.stiffness.real)
    held = full.supported()[2].real + normal.T @ scipy.sparse.diags(contacts.stiffness) @ normal
    basis = scipy.sparse.linalg.eigsh(held, count, full.mass, sigma=-1e6)[1]
    matrices = {name: basis.T @ (getattr(full, name).real @ basis)
                for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")}
    made = replace(full, joints=joints, contacts=contacts, coordinate_body=np.full(count, -1), **matrices)
    rows = {name: getattr(made, name) @ basis for name in ("input_rows", "sensor_rows")}
    made = replace(made, joints=replace(joints, rows=joints.rows @ basis), **rows, contacts=replace(
        contacts, **{name: getattr(contacts, name) @ basis for name in ("normal", "tangent", "lateral")}))
    return Bench(made, Table(*LAW, LINEAR.damping_speed, 0.0), constant(0.4), 1e-6, ())


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


def test_families_share_a_tenth_of_frequency_or_250_hz():
    assert families(2 * np.pi * np.array([1e4, 1.09e4, 1.11e4, 2e4])) == [[0, 1], [2], [3]]
    assert families(2 * np.pi * np.array([300.0, 540.0, 560.0])) == [[0, 1], [2]]
