"""Blocks and rings of tetrahedra, wedges and both, cut out of hexahedra with nodes on all faces."""

import numpy as np

from pipeline.physics.fem.mesh import Mesh, joined
from pipeline.physics.fem.reference_cells import reference_vertices

#: corners of the cells that fill a hexahedron; faces of neighbours on a lattice match
_TETRAHEDRA = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
_WEDGES = [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)]
_KINDS = {"tetra10": _TETRAHEDRA, "wedge15": _WEDGES, "hexahedron20": [tuple(range(8))]}


def cut(mesh, kind):
    """Mesh of the cells ``kind`` in a mesh of hexahedron27; "mixed": columns of hexahedra and of wedges."""
    if kind == "mixed":
        half = mesh.cell[:, :2].sum(axis=1) % 2 == 0
        return mesh_of(mesh, [("hexahedron20", mesh.element[half][:, :20]), ("wedge15", cells(mesh.element[~half],
                                                                                               "wedge15"))])
    return mesh_of(mesh, [(kind, cells(mesh.element, kind))])


def cells(element, kind):
    """(c, v) cells of a kind in hexahedra (e, 27)."""
    cube, vertices = reference_vertices("hexahedron27"), reference_vertices(kind)
    linear = np.linalg.norm(vertices - vertices.round(), axis=1) < 1e-9
    pieces = []
    for corner in _KINDS[kind]:
        weight = _corner_weights(kind, vertices, linear.sum())
        position = weight @ cube[list(corner)]
        pieces.append([int(np.abs(cube - p).sum(axis=1).argmin()) for p in position])
    return np.concatenate([element[:, piece] for piece in pieces])


def mesh_of(mesh, blocks):
    """The Mesh of ``blocks`` [(kind, elements)], without the nodes that none of them has."""
    kind, element = joined(blocks)
    used, element = np.unique(element, return_inverse=True)
    element = element.reshape(-1, len(element.ravel()) // sum(len(each) for _, each in blocks))
    return Mesh(mesh.node[used], element, kind, np.zeros((len(element), 3), int))


def _corner_weights(kind, vertices, count):
    """(v, c): each vertex as a mean of the corners next to it."""
    weight = np.zeros((len(vertices), count))
    for k, vertex in enumerate(vertices):
        pair = [(a, b) for a in range(count) for b in range(a, count)
                if np.allclose(vertices[[a, b]].mean(axis=0), vertex)]
        for index in pair[0]:
            weight[k, index] += 0.5
    return weight
