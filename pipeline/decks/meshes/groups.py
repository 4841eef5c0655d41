"""Named groups of a deck on the mesh that is made of it: sets of nodes and elements, and surfaces."""

from functools import cache

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.deck import FREE
from pipeline.physics.fem.mesh import Mesh, boundary_faces, corners
from pipeline.physics.fem.reference_cells import by_kind, cell_faces, padded

#: corners, from 1, of the faces S1, S2, ... of Abaqus and CalculiX
_HEXAHEDRON = (1, 2, 3, 4), (5, 8, 7, 6), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 8, 4), (4, 8, 5, 1)
_FACES = {"tetra10": ((1, 2, 3), (1, 4, 2), (2, 4, 3), (3, 4, 1)), "hexahedron20": _HEXAHEDRON,
          "hexahedron27": _HEXAHEDRON,
          "wedge15": ((1, 2, 3), (4, 6, 5), (1, 4, 5, 2), (2, 5, 6, 3), (3, 6, 4, 1))}


def rows_of(labels, numbers):
    """Rows of those ``numbers`` that ``labels`` has, ascending."""
    return np.flatnonzero(np.isin(labels, numbers))


def surfaces(deck, mesh, labels, node_labels):
    """{name: (f, v) nodes of the faces, or (k, 1) nodes of a surface of nodes} of the surfaces of ``deck``.

    ``labels`` (e,) and ``node_labels`` (n,): numbers of the elements and nodes of ``mesh``. Raises ConfigError for a
    face that an element does not have.
    """
    return {name: _surface(name, parts, mesh, labels, node_labels) for name, parts in deck.surfaces.items()}


def _surface(name, parts, mesh, labels, node_labels):
    sides = {side: np.concatenate([numbers for numbers, each in parts if each == side])
             for side in dict.fromkeys(side for _, side in parts)}
    faces = [face for side, numbers in sides.items() for face in _faces(name, numbers, side, mesh, labels, node_labels)]
    width = max((face.shape[1] for face in faces), default=1)
    return np.concatenate([padded(face, width) for face in faces]) if faces else np.empty((0, 1), int)


def _faces(name, numbers, side, mesh, labels, node_labels):
    """Yield the nodes (f, v) of the faces ``side``, such as S3, of the elements ``numbers``."""
    if side == FREE:
        chosen = Mesh(mesh.node, mesh.element[np.isin(labels, numbers)], mesh.kind, mesh.cell)
        if len(chosen.element):
            outer = boundary_faces(mesh)
            yield outer[_among(outer, boundary_faces(chosen))]
        return
    if not side.startswith("S") or not side[1:].isdigit():
        if not side:
            yield rows_of(node_labels, numbers)[:, None]
        return
    for kind, rows, cells in by_kind(mesh.kind, mesh.element):
        chosen = np.isin(labels[rows], numbers)
        if chosen.any():
            count = len(_FACES[kind])
            if not 1 <= int(side[1:]) <= count:
                raise ConfigError(f"surface {name}", f"faces S1 to S{count} of {kind}", side)
            yield cells[chosen][:, _vertices(kind, int(side[1:]) - 1)]


def _among(faces, others):
    """(f,) True where faces have the corners of one of ``others``."""
    keys = {tuple(sorted(row)) for row in corners(others)}
    return np.array([tuple(sorted(row)) in keys for row in corners(faces)], bool)


def faces_of(mesh, surface):
    """(f, v) faces of a surface, which may be given by its nodes (k, 1): those of the boundary with no other nodes."""
    if surface.shape[1] > 1:
        return surface
    outer = boundary_faces(mesh)
    return outer[np.isin(outer, surface).all(axis=1)]


@cache
def _vertices(kind, face):
    """Vertices of a face of Abaqus, as ``cell_faces`` has them."""
    wanted = {corner - 1 for corner in _FACES[kind][face]}
    return next(each for each in cell_faces(kind) if set(each[:len(wanted)]) == wanted)


def named_nodes(body, name, where):
    """Rows of the nodes of the set or surface ``name`` of a MeshedBody; ConfigError at ``where`` for no such one."""
    sets = {each: np.unique(face) for each, face in body.surfaces.items()} | body.node_sets
    nodes = sets.get(name.upper(), ())
    if not len(nodes):
        filled = sorted(each for each, rows in sets.items() if len(rows))
        raise ConfigError(where, f"a set of nodes or a surface of the mesh file: {', '.join(filled) or 'it has none'}",
                          repr(name))
    return nodes
