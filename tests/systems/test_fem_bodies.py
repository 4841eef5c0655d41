"""Solids and rows as products, and back: nothing is lost on the way."""

from dataclasses import fields

import numpy as np
import pytest
import scipy.sparse as sp

from pipeline.physics.fem.supports import free_freedoms
from pipeline.products import PinOnDisc, Structure
from pipeline.systems.fem_bodies import body_product, body_rows, elastic_body, incidence, row_fields
from pipeline.systems.solids import Rows
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
