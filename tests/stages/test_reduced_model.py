"""Stage reduced_model on a brake of a few elements, against its unreduced matrices."""

from dataclasses import fields, replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh

from pipeline.contract import ConfigError
from pipeline.physics.fem.elasticity import assemble
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.sliding.model import sliding_model
from stages.reduced_model import Settings, reduced_model
from tests.stages.small_structure import CALIPER, DISC, INNER, OUTER, small_structure

BODIES = ("disc", "pad_outer", "pad_inner", "caliper")


@pytest.fixture(scope="module")
def structure():
    return small_structure()


@pytest.fixture(scope="module")
def model(structure):
    return reduced_model(structure, settings=Settings())


def unreduced(structure):
    """Mass and stiffness of the whole brake with joints and closed contacts, supports removed."""
    bodies = [getattr(structure, name) for name in BODIES]
    matrices = [assemble(b.node, b.element, str(b.kind), b.element_material, b.density, b.elasticity) for b in bodies]
    first = np.cumsum([0, *(3 * len(b.node) for b in bodies)])
    stiffness, mass = (sp.block_diag(m, format="csr") for m in zip(*matrices, strict=True))
    for rows, springs in ((structure.joint_rows, structure.joint_stiffness),
                          (structure.contact_normal, structure.contact_stiffness[0])):
        column = first[rows.body] + 3 * rows.node + rows.axis
        incidence = sp.csr_matrix((rows.weight, (rows.row, column)), (len(springs), first[-1]))
        stiffness = stiffness + incidence.T @ sp.diags(springs) @ incidence
    held = 3 * structure.disc.supported[:, None] + np.arange(3)
    free = np.setdiff1d(np.arange(first[-1]), held)
    return stiffness[free][:, free], mass[free][:, free]


@pytest.mark.exact
def test_frequencies_of_the_closed_brake_are_those_of_the_unreduced_one(structure, model):
    full, _ = lowest_modes(*unreduced(structure), "superlu", count=30, shift=100.0)
    mass, _, stiffness = sliding_model(model, 0, 0.0).frictionless()
    error = np.sqrt(eigh(stiffness, mass, eigvals_only=True)[:30]) / (2 * np.pi * full) - 1
    assert error.min() > -1e-7 and error.max() < 1e-5


@pytest.mark.exact
@pytest.mark.parametrize(("body", "side"), [(OUTER, 1.0), (INNER, -1.0)])
def test_rigid_motion_of_a_pad_opens_its_contacts_alike(model, body, side):
    along = rigid_translation(model, body, [0.0, 0.0, 1.0])
    np.testing.assert_allclose(model.contact_normal @ along, np.where(model.contact_body == body, side, 0.0), atol=1e-5)
    np.testing.assert_allclose(model.contact_tangent @ along, 0.0, atol=1e-5)
    outwards = rigid_translation(model, body, [1.0, 0.0, 0.0])
    angle = np.arctan2(model.contact_position[:, 1], model.contact_position[:, 0])
    touched = model.contact_body == body
    np.testing.assert_allclose(model.contact_lateral @ outwards, np.cos(angle) * touched, atol=1e-5)
    np.testing.assert_allclose(model.contact_tangent @ outwards, -np.sin(angle) * touched, atol=1e-5)


def rigid_translation(model, body, direction):
    """Coordinates of a translation of one free body, out of the six motions without strain energy."""
    own = np.flatnonzero(model.coordinate_body == body)
    _, motions = eigh(model.stiffness[np.ix_(own, own)], model.mass[np.ix_(own, own)], subset_by_index=[0, 5])
    seen = model.recovery[model.visible_body == body][..., own].astype(float) @ motions
    amplitude, miss, _, _ = np.linalg.lstsq(seen.reshape(-1, 6), np.tile(direction, len(seen)))
    assert miss[0] < 1e-8 * len(seen)
    coordinates = np.zeros(len(model.mass))
    coordinates[own] = motions @ amplitude
    return coordinates


@pytest.mark.exact
def test_mass_of_a_translated_pad_is_its_mass(structure, model):
    along = rigid_translation(model, OUTER, [0.0, 1.0, 0.0])
    body = structure.pad_outer
    _, mass = assemble(body.node, body.element, str(body.kind), body.element_material, body.density, body.elasticity)
    moved = np.tile([0.0, 1.0, 0.0], len(body.node))
    assert along @ model.mass @ along == pytest.approx(moved @ (mass @ moved), rel=1e-5)


@pytest.mark.exact
def test_matrices_are_symmetric_and_rotation_belongs_to_the_disc(model):
    for name in ("mass", "stiffness", "damping", "centrifugal"):
        matrix = getattr(model, name)
        np.testing.assert_allclose(matrix, matrix.T, atol=1e-9 * abs(matrix).max())
    np.testing.assert_array_equal(model.gyroscopic, -model.gyroscopic.T)
    turning = model.coordinate_body == DISC
    for matrix in (model.gyroscopic, model.centrifugal):
        assert abs(matrix[np.ix_(turning, turning)]).max() > 0
        assert not matrix[~turning].any() and not matrix[:, ~turning].any()


def test_rows_inputs_and_sensors_move_with_the_surface(model):
    moving = np.random.default_rng(0).standard_normal(len(model.mass))
    distance = np.linalg.norm(model.visible_position - model.sensor_position[0], axis=1) + (model.visible_body != DISC)
    seen = (model.recovery[distance.argmin()] @ moving)[2]
    assert (model.sensor_rows @ moving)[0] == pytest.approx(seen, rel=1e-4)
    apart = rigid_translation(model, INNER, [0, 0, 1.0]) - rigid_translation(model, CALIPER, [0, 0, 1.0])
    np.testing.assert_allclose(model.input_rows @ apart, 2.0, rtol=1e-4)


def test_surface_faces_point_to_nodes_of_one_body(model):
    assert (model.visible_body[model.visible_face] == model.visible_body[model.visible_face[:, :1]]).all()
    assert model.visible_face.max() == len(model.visible_position) - 1


def test_limits_decide_the_size(structure, model):
    fewer = reduced_model(structure, settings=Settings(fixed_below="10 kHz", residual_below="40 kHz"))
    assert len(fewer.mass) < len(model.mass)
    assert set(np.unique(fewer.coordinate_body)) == {DISC, OUTER, INNER, CALIPER}


def test_turning_body_without_mount_is_refused(structure):
    free = replace(structure.disc, supported=np.empty(0, int))
    values = {f.name: getattr(structure, f.name) for f in fields(structure)}
    with pytest.raises(ConfigError, match="supports"):
        reduced_model(type(structure)(**{**values, "disc": free}), settings=Settings())
