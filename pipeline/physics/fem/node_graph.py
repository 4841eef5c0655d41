"""Which nodes share an element, and sums of the matrices of elements on that graph, compiled.

    node_graph(element, nodes) -> (indptr, indices)
    summed_scalars(matrix, element, nodes), summed_blocks(matrix, element, nodes) -> (3n, 3n) CSR

Sums run in the order of the elements, so that the same mesh gives the same bits.
"""

import numpy as np
import scipy

from pipeline.physics.numerics.compiled import njit


def node_graph(element, nodes):
    """(indptr (n + 1,), indices) of the nodes that share an element with each of n ``nodes``, itself among them,
    ascending."""
    return _graph(rows_of(element), nodes)


def block_csr(graph, data):
    """CSR (3n, 3n) of ``data``: row by row the blocks of three columns of every neighbour."""
    return _csr(graph, data, 3)


def diagonal_csr(graph, data):
    """CSR (3n, 3n) of ``data``: row by row one column of every neighbour, that of its own axis."""
    return _csr(graph, data, 1)


def _csr(graph, data, width):
    """CSR of ``data`` whose rows hold ``width`` columns a neighbour."""
    degree = np.diff(graph[0])
    kind = np.int32 if len(data) < np.iinfo(np.int32).max else np.int64
    columns, rows = np.empty(len(data), kind), np.zeros(3 * len(degree) + 1, kind)
    np.cumsum(np.repeat(width * degree, 3), out=rows[1:])
    _fill_columns(*graph, width, columns)
    return scipy.sparse.csr_matrix((data, columns, rows), (3 * len(degree),) * 2)


def summed_scalars(matrix, element, nodes):
    """Sum (e, v, v) node matrices to (3 nodes, 3 nodes) CSR, the same for each axis."""
    graph = node_graph(element, nodes)
    data = np.zeros(3 * len(graph[1]))
    add_scalars(np.ascontiguousarray(matrix, float), rows_of(element), *graph, data)
    return diagonal_csr(graph, data)


def summed_blocks(matrix, element, nodes):
    """Sum (e, 3v, 3v) matrices of elements with (e, v) nodes to (3 nodes, 3 nodes) CSR."""
    graph = node_graph(element, nodes)
    data = np.zeros(9 * len(graph[1]))
    add_blocks(np.ascontiguousarray(matrix, float), rows_of(element), *graph, data)
    return block_csr(graph, data)


def rows_of(element):
    """Elements (e, v) as kernels take them."""
    return np.ascontiguousarray(element, np.int64)


@njit
def _graph(element, nodes):
    owned = np.zeros(nodes + 1, np.int64)
    for e in range(element.shape[0]):
        for a in element[e]:
            owned[a + 1] += 1
    owned = np.cumsum(owned)
    owner, filled = np.empty(owned[nodes], np.int64), owned[:nodes].copy()
    for e in range(element.shape[0]):
        for a in element[e]:
            owner[filled[a]] = e
            filled[a] += 1
    seen, indptr = np.full(nodes, -1), np.zeros(nodes + 1, np.int64)
    for a in range(nodes):
        for k in range(owned[a], owned[a + 1]):
            for b in element[owner[k]]:
                if seen[b] != a:
                    seen[b] = a
                    indptr[a + 1] += 1
    indptr = np.cumsum(indptr)
    indices = np.empty(indptr[nodes], np.int32)
    seen[:] = -1
    for a in range(nodes):
        last = indptr[a]
        for k in range(owned[a], owned[a + 1]):
            for b in element[owner[k]]:
                if seen[b] != a:
                    seen[b] = a
                    indices[last] = b
                    last += 1
        indices[indptr[a]:last] = np.sort(indices[indptr[a]:last])
    return indptr, indices


@njit
def _fill_columns(indptr, indices, width, columns):
    at = 0
    for a in range(len(indptr) - 1):
        for axis in range(3):
            first = axis if width == 1 else 0
            for b in indices[indptr[a]:indptr[a + 1]]:
                for k in range(width):
                    columns[at] = 3 * b + first + k
                    at += 1


@njit
def place_of(indptr, indices, row, column):
    """Position of ``column`` among the neighbours of ``row``."""
    low, high = indptr[row], indptr[row + 1]
    while high - low > 1:
        middle = (low + high) // 2
        if indices[middle] <= column:
            low = middle
        else:
            high = middle
    return low - indptr[row]


@njit
def add_value(value, row, place, indptr, data):
    """Add a value for each axis to ``data`` of a ``diagonal_csr``, at the neighbour of a row at this ``place``."""
    degree = indptr[row + 1] - indptr[row]
    for axis in range(3):
        data[3 * indptr[row] + axis * degree + place] += value


@njit
def add_block(block, row, place, indptr, data):
    """Add a ``block`` (3, 3) to ``data`` of a ``block_csr``, at the neighbour of a row at this ``place``."""
    first, width = 9 * indptr[row] + 3 * place, 3 * (indptr[row + 1] - indptr[row])
    for i in range(3):
        for j in range(3):
            data[first + i * width + j] += block[i, j]


@njit
def add_scalars(matrix, element, indptr, indices, data):
    """Add node matrices (e, v, v) to ``data`` of a ``diagonal_csr``."""
    for e in range(element.shape[0]):
        for a, row in enumerate(element[e]):
            for b, column in enumerate(element[e]):
                add_value(matrix[e, a, b], row, place_of(indptr, indices, row, column), indptr, data)


@njit
def add_blocks(matrix, element, indptr, indices, data):
    """Add matrices (e, 3v, 3v) to ``data`` of a ``block_csr``."""
    for e in range(element.shape[0]):
        for a, row in enumerate(element[e]):
            for b, column in enumerate(element[e]):
                block = matrix[e, 3 * a:3 * a + 3, 3 * b:3 * b + 3]
                add_block(block, row, place_of(indptr, indices, row, column), indptr, data)
