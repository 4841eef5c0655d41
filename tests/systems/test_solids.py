"""Solids weigh what they are made of; rows of several bodies stand side by side."""

import numpy as np
import pytest
import scipy.sparse as sp

from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import block
from pipeline.systems.solids import Rows, Solid

pytestmark = pytest.mark.exact


def solid(materials=(0, 0)):
    """Two cells of 0.1 m x 0.2 m x 0.3 m, of two materials of which the second is twice as dense."""
    mesh = block(np.array([0, 0.1, 0.2]), np.array([0, 0.2]), np.array([0, 0.3]))
    return Solid(mesh, np.array(materials), ("light", "heavy"), np.array([1000.0, 2000.0]),
                 np.array([isotropic(1e9, 0.3)] * 2), 0.01, np.array([0]))


@pytest.mark.parametrize("materials, weight", [((0, 0), 12.0), ((0, 1), 18.0), ((1, 1), 24.0)])
def test_a_solid_weighs_its_volume_times_density_and_moves_freely(materials, weight):
    body = solid(materials)
    stiffness, mass = body.matrices()
    along = np.tile([1.0, 0.0, 0.0], len(body.mesh.node))
    assert along @ mass @ along == pytest.approx(weight)
    assert stiffness @ along == pytest.approx(0, abs=1e-9 * abs(stiffness).max())


def test_rows_of_all_bodies_stand_side_by_side():
    parts = (sp.csr_matrix([[1.0, 0, 0]]), sp.csr_matrix([[0, -1.0, 0, 0, 0, 2.0]]))
    assert Rows(parts).matrix.toarray().tolist() == [[1, 0, 0, 0, -1, 0, 0, 0, 2]]
