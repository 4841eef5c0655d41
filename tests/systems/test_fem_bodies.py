"""Solids and rows as products, and back: nothing is lost on the way."""

from dataclasses import fields, replace

import numpy as np
import pytest
import scipy.sparse as sp

from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.reduction.body import rotation
from pipeline.physics.sliding.model import FrictionState
from pipeline.products import PinOnDisc, Structure
from pipeline.systems.fem_bodies import body_product, body_rows, elastic_body, full_model, incidence, row_fields
from pipeline.systems.solids import Rows
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_structure
from tests.systems.test_solids import solid

pytestmark = pytest.mark.exact


def test_rows_come_back_from_their_incidence():
    """Explicit zeros are left out; a body that a row does not move has no entry."""
    parts = (sp.random(4, 9, 0.5, "csr", random_state=1), sp.csr_matrix((4, 6)),
             sp.csr_matrix((np.array([0.0, 2.0]), ([0, 3], [1, 2])), (4, 3)))
    found = incidence(Rows(parts))
    assert (found.weight != 0).all() and set(found.body) == {0, 2}
    for number, part in enumerate(parts):
        assert np.array_equal(body_rows(found, number, part.shape[1] // 3).toarray(), part.toarray())


def test_a_body_keeps_its_modes_node_by_node():
    body = solid()
    size = 3 * len(body.mesh.node)
    shape = np.arange(2.0 * size).reshape(size, 2)
    found = body_product(body, [1.0, 2.0], shape)
    assert found.shape[1, 4].tolist() == shape[12:15, 1].tolist()
    assert body_product(body).shape.shape == (0, len(body.mesh.node), 3)


def test_an_elastic_body_has_the_matrices_of_the_solid_that_it_was():
    structure = small_structure()
    body = elastic_body(structure, "pad_inner")
    assert body.modes.shape == (3 * len(body.node), 0) and not body.turns
    assert len(body.interface) == body.rows.shape[0] - int(structure.sensor_rows.rows)
    disc = elastic_body(structure, "disc")
    assert disc.turns and disc.modes.shape[1] == len(structure.disc.frequency)
    stiffness, mass = disc.matrices()
    residual = stiffness @ disc.modes - mass @ disc.modes * (2 * np.pi * disc.frequency) ** 2
    free = free_freedoms(len(disc.node), disc.supported)
    assert np.abs(residual[free]).max() < 1e-6 * np.abs(stiffness @ disc.modes).max()


@pytest.mark.parametrize("product", [Structure, PinOnDisc])
def test_the_rows_that_are_read_are_fields_of_the_product(product):
    assert set(row_fields(product.__new__(product))) <= {f.name for f in fields(product)}


def test_the_full_model_has_the_matrices_and_rows_of_all_bodies():
    """Supported nodes are left out; loss factors are imaginary stiffness of bodies and joints."""
    structure = small_structure()
    lossy = {f.name: getattr(structure, f.name) for f in fields(structure)}
    lossy["joint_loss_factor"] = np.linspace(0.0, 0.1, len(structure.joint_name))
    lossy["pad_outer"] = replace(structure.pad_outer, loss_factor=np.array([0.03]))
    structure = Structure(**lossy)
    full = full_model(structure, "superlu")
    bodies = [elastic_body(structure, name) for name in structure.body_name]
    free = [free_freedoms(len(b.node), b.supported) for b in bodies]
    ends = np.cumsum([0, *map(len, free)])
    assert np.array_equal(np.bincount(full.coordinate_body), np.diff(ends))
    for k, (body, f) in enumerate(zip(bodies, free, strict=True)):
        here = slice(ends[k], ends[k + 1])
        stiffness, mass = (matrix[f][:, f] for matrix in body.matrices())
        assert abs(full.mass[here, here] - mass).max() == 0
        assert abs(full.stiffness[here, here] - stiffness - 1j * body.loss()[f][:, f]).max() == 0
        rows = body_rows(structure.contact_tangent, k, len(body.node))[:, f]
        assert abs(full.contacts.tangent[:, here] - rows).max() == 0
        turning = rotation(body, f, factorise(stiffness, "superlu")) if body.turns else (0 * mass, 0 * mass)
        for found, expected in zip((full.gyroscopic, full.centrifugal), turning, strict=True):
            assert abs(found[here, here] - expected).max() == 0
    np.testing.assert_allclose(full.joints.stiffness.imag, structure.joint_loss_factor * structure.joint_stiffness)


@pytest.mark.parametrize("friction_damping", [True, False])
def test_a_sparse_model_is_linearised_as_a_dense_one(friction_damping):
    full = replace(full_model(small_structure(), "superlu"), speed=10.0)
    names = ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")
    contacts = replace(full.contacts, damping=np.full(len(full.contacts.area), 3.0))
    dense = replace(full, **{name: getattr(full, name).toarray() for name in names},
                    joints=replace(full.joints, rows=full.joints.rows.toarray()),
                    contacts=replace(contacts, **{name: getattr(contacts, name).toarray()
                                                  for name in ("normal", "tangent", "lateral")}))
    friction = FrictionState(0.4, 1e-8, -0.02)
    sparse = replace(full, contacts=contacts).linearised(friction, friction_damping)
    for found, expected in zip(sparse, dense.linearised(friction, friction_damping), strict=True):
        assert abs(found.toarray() - expected).max() <= 1e-12 * abs(expected).max()


def test_the_full_model_has_the_fluid_of_the_reduced_one():
    """The column is a joint between the piston row and the mass of the line, which nothing else holds."""
    structure = replace(small_structure(), fluid_stiffness=[3e8], fluid_loss_factor=[0.02], line_inertia=[400.0],
                        line_drag=[1e4])
    dry, wet = full_model(small_structure(), "superlu"), full_model(structure, "superlu")
    reduced = reduced_model(structure, settings=Reduction(fixed_below="20 kHz"))
    assert wet.body_name == tuple(reduced.body_name) and wet.joints.name == tuple(reduced.joint_name)
    assert wet.mass[-1, -1] == 400.0 and wet.damping[-1, -1] == 1e4 and wet.coordinate_body[-1] == len(dry.body_name)
    for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal"):
        assert abs(getattr(wet, name)[:-1, :-1] - getattr(dry, name)).max() == 0
    column = wet.joints.rows[-1].toarray().ravel()
    assert column[-1] == -1 and np.array_equal(column[:-1], dry.input_rows.toarray().ravel())
    assert wet.joints.stiffness[-1] == 3e8 * (1 + 0.02j) and abs(wet.joints.rows[:-1, -1]).max() == 0
    assert wet.contacts.normal.shape[1] == wet.input_rows.shape[1] == wet.sensor_rows.shape[1] == wet.mass.shape[0]
