"""One brick against scikit-fem, and its rigid motions."""

import numpy as np
import pytest

from pipeline.physics.rough.layer_element import brick_stiffness

EDGES = (1.0, 2.0, 0.5)


def corners():
    """Vertex positions (2, 2, 2, 3) of the brick, z outwards."""
    a, b, c = np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij")
    return np.stack([a * EDGES[0], b * EDGES[1], -c * EDGES[2]], axis=-1)


@pytest.mark.exact
def test_uniform_strain_stores_its_energy():
    stiffness = brick_stiffness(EDGES, 3.0, 0.3).reshape(24, 24)
    stretch = corners() * np.array([1e-3, 0.0, 0.0])
    lame = 3.0 * 0.3 / (1.3 * 0.4)
    energy = 0.5 * (lame + 3.0 / 1.3) * 1e-6 * np.prod(EDGES)
    assert 0.5 * stretch.ravel() @ stiffness @ stretch.ravel() == pytest.approx(energy, rel=1e-13)


@pytest.mark.exact
def test_six_rigid_motions_cost_nothing_and_no_more():
    stiffness = brick_stiffness(EDGES, 3.0, 0.3).reshape(24, 24)
    turns = [np.cross(axis, corners()).ravel() for axis in np.eye(3)]
    moves = [np.broadcast_to(axis, (2, 2, 2, 3)).ravel() for axis in np.eye(3)]
    assert np.abs(stiffness @ np.array(turns + moves, dtype=float).T).max() < 1e-13
    eigenvalues = np.linalg.eigvalsh(stiffness)
    assert np.sum(eigenvalues < 1e-12 * eigenvalues[-1]) == 6


@pytest.mark.exact
def test_agrees_with_scikit_fem():
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = skfem.MeshHex.init_tensor([0, EDGES[0]], [0, EDGES[1]], [-EDGES[2], 0])
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=2)
    reference = linear_elasticity(*lame_parameters(3.0, 0.3)).assemble(basis).toarray()
    order = [np.flatnonzero(np.all(np.abs(mesh.p.T - corner) < 1e-12, axis=1))[0] for corner in corners().reshape(8, 3)]
    degrees = basis.nodal_dofs[:, order].T.ravel()
    ours = brick_stiffness(EDGES, 3.0, 0.3).reshape(24, 24)
    np.testing.assert_allclose(ours, reference[np.ix_(degrees, degrees)], atol=1e-14)
