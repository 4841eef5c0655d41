"""The graph of nodes that share an element, and sums on it, beside SciPy's products and sums."""

import numpy as np
import pytest
import scipy

from pipeline.physics.fem.node_graph import block_csr, diagonal_csr, node_graph, summed_blocks, summed_scalars

pytestmark = pytest.mark.exact
NODES = 9
#: two elements share two nodes, one names a node twice, the last node belongs to none
ELEMENT = np.array([[0, 3, 5, 1], [5, 1, 7, 2], [6, 6, 4, 0]])


def by_scipy(matrix, width):
    """(width n, width n) dense sum of (e, width v, width v) matrices, entry by entry."""
    dof = (width * ELEMENT[..., None] + np.arange(width)).reshape(len(ELEMENT), -1)
    rows, columns = (np.broadcast_to(d, matrix.shape).ravel() for d in (dof[:, :, None], dof[:, None, :]))
    return scipy.sparse.coo_array((matrix.ravel(), (rows, columns)), (width * NODES,) * 2).toarray()


def test_neighbours_are_those_of_the_incidence():
    indptr, indices = node_graph(ELEMENT, NODES)
    incidence = np.zeros((len(ELEMENT), NODES))
    incidence[np.arange(len(ELEMENT))[:, None], ELEMENT] = 1
    expected = scipy.sparse.csr_array(incidence.T @ incidence > 0)
    np.testing.assert_array_equal(indptr, expected.indptr)
    np.testing.assert_array_equal(indices, expected.indices)


def test_sums_are_those_of_coordinate_lists():
    random = np.random.default_rng(2)
    scalar, block = random.standard_normal((3, 4, 4)), random.standard_normal((3, 12, 12))
    summed = summed_scalars(scalar, ELEMENT, NODES)
    np.testing.assert_allclose(summed.toarray(), np.kron(by_scipy(scalar, 1), np.eye(3)), atol=1e-15)
    np.testing.assert_allclose(summed_blocks(block, ELEMENT, NODES).toarray(), by_scipy(block, 3), atol=1e-15)
    assert summed.has_sorted_indices and (summed != summed_scalars(scalar, ELEMENT, NODES)).nnz == 0


def test_data_lie_row_by_row():
    graph = node_graph(ELEMENT, NODES)
    blocks, diagonal = (np.arange(width * len(graph[1]), dtype=float) + 1 for width in (9, 3))
    degree = np.diff(graph[0])
    rows = block_csr(graph, blocks)
    np.testing.assert_array_equal(np.diff(rows.indptr), np.repeat(3 * degree, 3))
    np.testing.assert_array_equal(rows[:1].toarray()[0][rows[:1].toarray()[0] > 0], np.arange(3 * degree[0]) + 1)
    assert set((diagonal_csr(graph, diagonal).tocoo().row - diagonal_csr(graph, diagonal).tocoo().col) % 3) == {0}
