"""Stiffness and mass of solid elements, each added where it belongs as soon as it is formed, compiled.

The stiffness of an element follows from the products of the gradients of its shape functions,
P = sum w (grad N)^T grad N, a product of two small matrices, and from the elasticity c_ikjl that weighs them:
K_ab^ij = c_ikjl P_ab^kl.
"""

import numpy as np

from pipeline.physics.fem.node_graph import (
    add_block,
    add_value,
    block_csr,
    diagonal_csr,
    node_graph,
    place_of,
    rows_of,
)
from pipeline.physics.numerics.compiled import njit


def elastic_sums(node, element, material, cell, elasticity, density):
    """Stiffness and mass (3n, 3n) CSR of elements of one kind, or (None, (element, volume)) of one turned inside out.

    ``cell`` (reference gradients (q, v, 3), weights (q,), shape functions (p, v), their weights (p,)): points of the
    stiffness, the first p of which are those of the mass. ``elasticity`` (m, 6, 6), ``density`` (m,) of each
    ``material`` (e,).
    """
    graph = node_graph(element, len(node))
    stiffness, mass = np.zeros(9 * len(graph[1])), np.zeros(3 * len(graph[1]))
    worst, volume = add_elastic(
        np.ascontiguousarray(node, float), rows_of(element), np.ascontiguousarray(material, np.int64),
        tuple(np.ascontiguousarray(part, float) for part in cell), _pairs_of_axes(np.asarray(elasticity, float)),
        np.ascontiguousarray(density, float), *graph, (stiffness, mass))
    if worst >= 0:
        return None, (worst, volume)
    return block_csr(graph, stiffness), diagonal_csr(graph, mass)


def _pairs_of_axes(elasticity):
    """(m, 9, 9): stress i k of a displacement gradient j l, from (m, 6, 6); row 3 i + j, column 3 k + l."""
    voigt = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
    full = elasticity[:, voigt[:, :, None, None], voigt[None, None]]        # m, i, k, j, l
    return np.ascontiguousarray(full.transpose(0, 1, 3, 2, 4).reshape(-1, 9, 9))


@njit(error_model="numpy")
def add_elastic(node, element, material, cell, elasticity, density, indptr, indices, sums):
    """Add stiffness and mass of elements to ``sums`` (data of a ``block_csr`` and a ``diagonal_csr``).

    Returns (-1, 0), or the first element whose Jacobian is not positive, and its least value.
    """
    reference, weight, shape, mass_weight = cell
    points, vertices, carried = reference.shape[0], element.shape[1], len(mass_weight)
    gradient, weighted = np.empty((points, 3 * vertices)), np.empty((points, 3 * vertices))
    heavy, volume = np.empty((carried, vertices)), np.empty(points)
    pairs, masses = np.empty((3 * vertices, 3 * vertices)), np.empty((vertices, vertices))
    for e in range(element.shape[0]):
        _gradients(node, element[e], reference, gradient, volume)
        if not volume.min() > 0:
            return e, volume.min()
        for q in range(points):
            weighted[q] = (weight[q] * volume[q]) * gradient[q]
        for q in range(carried):
            heavy[q] = (mass_weight[q] * volume[q] * density[material[e]]) * shape[q]
        np.dot(weighted.T, gradient, pairs)
        np.dot(heavy.T, shape, masses)
        _add_element(element[e], pairs, masses, elasticity[material[e]], indptr, indices, sums)
    return -1, 0.0


@njit(error_model="numpy")
def _gradients(node, vertex, reference, gradient, volume):
    """Gradients (q, 3v) of the shape functions of one element, and determinants (q,) of its Jacobian."""
    jacobian, inverse = np.empty((3, 3)), np.empty((3, 3))
    for q in range(reference.shape[0]):
        jacobian[:] = 0.0
        for v in range(len(vertex)):
            for x in range(3):
                for r in range(3):
                    jacobian[x, r] += node[vertex[v], x] * reference[q, v, r]
        for x in range(3):
            for r in range(3):
                y, z, s, t = (x + 1) % 3, (x + 2) % 3, (r + 1) % 3, (r + 2) % 3
                inverse[r, x] = jacobian[y, s] * jacobian[z, t] - jacobian[y, t] * jacobian[z, s]
        volume[q] = jacobian[0, 0] * inverse[0, 0] + jacobian[0, 1] * inverse[1, 0] + jacobian[0, 2] * inverse[2, 0]
        for v in range(len(vertex)):
            for x in range(3):
                gradient[q, 3 * v + x] = (reference[q, v, 0] * inverse[0, x] + reference[q, v, 1] * inverse[1, x]
                                          + reference[q, v, 2] * inverse[2, x]) / volume[q]


@njit
def _add_element(vertex, pairs, masses, elasticity, indptr, indices, sums):
    """Add one element: products of gradients (3v, 3v) under ``elasticity`` (9, 9), and node masses (v, v).

    One half is formed and mirrored, so that the sums are symmetric to the last bit.
    """
    stiffness, mass = sums
    block = np.empty((3, 3))
    for a in range(len(vertex)):
        for b in range(a, len(vertex)):
            for i in range(3):
                for j in range(3):
                    total = 0.0
                    for k in range(3):
                        for m in range(3):
                            total += elasticity[3 * i + j, 3 * k + m] * pairs[3 * a + k, 3 * b + m]
                    block[i, j] = total
            if a == b:
                for i in range(3):
                    for j in range(i):
                        block[i, j] = block[j, i]
            _add_pair(vertex[a], vertex[b], block, masses[a, b], indptr, indices, stiffness, mass)
            if a != b:
                _add_pair(vertex[b], vertex[a], block.T, masses[a, b], indptr, indices, stiffness, mass)


@njit
def _add_pair(row, column, block, mass, indptr, indices, stiffness, masses):
    place = place_of(indptr, indices, row, column)
    add_value(mass, row, place, indptr, masses)
    add_block(block, row, place, indptr, stiffness)
