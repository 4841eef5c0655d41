"""A bar held at one end against its closed form; held nodes keep still, and nothing held is a free body."""

import numpy as np
import pytest

from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block
from pipeline.physics.fem.supports import free_freedoms, held_modes
from pipeline.physics.numerics.sparse_solver import available

pytestmark = pytest.mark.exact
YOUNG, DENSITY, SPEED = 2e11, 8000.0, 5000.0


@pytest.fixture(scope="module")
def bar():
    """(mesh, stiffness, mass) of a bar of 1 m x 0.4 m x 0.3 m without lateral contraction."""
    mesh = block(np.linspace(0, 1, 7), np.linspace(0, 0.4, 3), np.linspace(0, 0.3, 3))
    return mesh, *assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), [DENSITY],
                           [isotropic(YOUNG, 0.0)])


def test_a_held_bar_moves_along_its_axis_as_a_quarter_wave(bar):
    """f = c / (4 L) with c = sqrt(E / rho); the mode that moves along x alone."""
    mesh, stiffness, mass = bar
    held = np.flatnonzero(mesh.node[:, 0] == 0)
    frequency, shape = held_modes(stiffness, mass, held, available()[0], count=12)
    along = (np.abs(shape.reshape(-1, 3, 12)) ** 2).sum(axis=0)
    axial = np.flatnonzero(along[0] > 0.99 * along.sum(axis=0))
    assert frequency[axial[0]] == pytest.approx(SPEED / 4, rel=1e-4)
    assert not shape.reshape(-1, 3, 12)[held].any()
    assert shape.T @ mass @ shape == pytest.approx(np.eye(12), abs=1e-8)


def test_nothing_held_is_a_free_body(bar):
    _, stiffness, mass = bar
    frequency, _ = held_modes(stiffness, mass, np.empty(0, int), available()[0], count=7)
    assert frequency[:6] == pytest.approx(0, abs=0.1) and frequency[6] > 100


def test_freedoms_are_those_of_the_other_nodes():
    assert free_freedoms(4, np.array([0, 2])).tolist() == [3, 4, 5, 9, 10, 11]
