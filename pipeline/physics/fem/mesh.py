"""Meshes: a masked lattice of revolution, a Cartesian block, and the faces of any."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.reference_cells import (
    MIXED,
    MIXED_FACES,
    by_kind,
    cell_faces,
    padded,
    reference_vertices,
)

_TURN = 2 * np.pi


@dataclass(frozen=True)
class Mesh:
    """Nodes (n, 3) [m], elements (e, v) in the order of meshio, and their lattice cell (e, 3).

    ``kind``: a cell type of meshio, or "mixed" as ``reference_cells`` describes it; ``groups`` {name: faces (f, v), or
    nodes (k, 1)} of a mesh from a file, None of others.
    """

    node: np.ndarray
    element: np.ndarray
    kind: str
    cell: np.ndarray
    groups: dict | None = None


def revolve(radius, angle, height, mask=None, kind="hexahedron20"):
    """Mesh of the cells of a lattice of revolution about z where ``mask`` is true.

    Parameters
    ----------
    radius, angle, height : ascending lattice lines [m, rad, m]; angles that span 2 pi close the ring
    mask : (radii - 1, angles - 1, heights - 1) bool, all cells by default

    Nodes between the lines lie on the circles. Raises ConfigError for lines that do not ascend.
    """
    if not radius[0] > 0:
        raise ConfigError("mesh of revolution", "a bore: inner radius > 0", f"{radius[0]:g} m")
    closed = bool(np.isclose(angle[-1] - angle[0], _TURN))

    def place(r, a, z):
        return np.stack((r * np.cos(a), r * np.sin(a), z), axis=-1)

    return _lattice((radius, angle, height), mask, kind, place, closed)


def block(x, y, z, mask=None, kind="hexahedron20"):
    """Mesh of the cells of a Cartesian lattice with lines ``x``, ``y``, ``z`` [m] where ``mask`` is true."""
    return _lattice((x, y, z), mask, kind, lambda *lines: np.stack(lines, axis=-1), closed=False)


def divided(edges, size):
    """Ascending lattice lines: all ``edges``, and between two of them equal cells of at most ``size``, which is one for
    all spans or one for each."""
    spans = list(zip(edges, edges[1:], strict=False))
    parts = [edges[:1]]
    for (first, last), most in zip(spans, np.broadcast_to(size, len(spans)), strict=True):
        cells = max(int(np.ceil((last - first) / most - 1e-9)), 1)
        parts.append(np.linspace(first, last, cells + 1)[1:])
    return np.concatenate(parts)


def graded(edges, size, cells):
    """Lattice lines as of ``divided``, whose cells shrink towards every inner edge, ``cells`` or more a side.

    Their distances from the edge are as squares, which suits the stresses at a re-entrant corner: those of elements of
    second order then converge about as fast as smooth ones (I. Babuska, R. B. Kellogg, J. Pitkaranta, Numer. Math. 33
    (1979) 447).
    """
    edges, parts = np.asarray(edges, float), [edges[:1]]
    for k, (first, last) in enumerate(zip(edges, edges[1:], strict=False)):
        corners = (k > 0) + (k < len(edges) - 2)
        count = max(len(divided((first, last), size)) - 1, corners * cells)
        parts.append(first + (last - first) * _towards(np.linspace(0, 1, count + 1)[1:], k > 0, k < len(edges) - 2))
    return np.concatenate(parts)


def _towards(place, first, last):
    """Places from 0 to 1 moved towards the ``first`` end, the ``last`` one, both or neither."""
    if first and last:
        return np.where(place < 0.5, 2 * place**2, 1 - 2 * (1 - place) ** 2)
    return place**2 if first else 1 - (1 - place) ** 2 if last else place


def _lattice(lines, mask, kind, place, closed):
    for name, line in zip(("first", "second", "third"), lines, strict=True):
        if len(line) < 2 or not (np.diff(line) > 0).all():
            raise ConfigError(f"mesh, {name} lattice direction", "at least two ascending lines (sizes > 0)",
                              np.array2string(np.asarray(line), precision=5, threshold=8))
    fine = [np.interp(np.arange(2 * len(line) - 1) / 2, np.arange(len(line)), line) for line in lines]
    cells = tuple(len(line) - 1 for line in lines)
    cell = np.argwhere(np.ones(cells, bool) if mask is None else mask)
    if not len(cell):
        raise ConfigError("mesh", "at least one cell", "an empty mask")
    index = 2 * cell[:, None] + (2 * reference_vertices(kind)).astype(int)
    if closed:
        index[..., 1] %= 2 * cells[1]
    used, element = np.unique(np.ravel_multi_index(np.moveaxis(index, -1, 0), [len(f) for f in fine]),
                              return_inverse=True)
    position = np.unravel_index(used, [len(f) for f in fine])
    node = place(*(f[i] for f, i in zip(fine, position, strict=True)))
    return Mesh(node, element.reshape(index.shape[:2]), kind, cell)


def joined(blocks):
    """(kind, (e, v) elements) of one mesh with the ``blocks`` [(kind, (c, v) elements)], padded where kinds differ."""
    kinds = {kind for kind, _ in blocks}
    if len(kinds) == 1:
        return kinds.pop(), np.concatenate([element for _, element in blocks])
    width = len(reference_vertices("hexahedron20"))
    return MIXED, np.concatenate([padded(element, width) for _, element in blocks])


def boundary_faces(mesh):
    """(f, v) nodes of the faces that belong to one element only, corners anticlockwise seen from outside."""
    faces = [cells[:, face] for kind, _, cells in by_kind(mesh.kind, mesh.element) for face in cell_faces(kind)]
    width = max(face.shape[1] for face in faces)
    faces = np.concatenate([padded(face, width) for face in faces])
    key = corners(faces)
    key[key[:, 3] == key[:, 0], 3] = -1
    key = np.sort(key, axis=1)
    _, group, times = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    return faces[times[group.ravel()] == 1]


def face_kind(face):
    """Cell type of (f, v) faces."""
    if face.shape[1] == 8 and (face[:, 6:] == face[:, :1]).all(axis=1).any():
        return MIXED_FACES
    return {4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}[face.shape[1]]


def corners(face):
    """(f, 4) corners of faces, of triangles the first one twice."""
    triangle = (face[:, 6:] == face[:, :1]).all(axis=1) if face.shape[1] in (6, 8) else np.zeros(len(face), bool)
    return np.where(triangle[:, None], face[:, [0, 1, 2, 0]], face[:, :4])


def face_normals(node, face):
    """(f, 3) unit normals at the middle of the faces, outwards, and (f, 3) middles [m]."""
    rows = corners(face)
    corner, triangle = node[rows], rows[:, 3] == rows[:, 0]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    middle = np.where(triangle[:, None], corner[:, :3].mean(axis=1), corner.mean(axis=1))
    return normal / np.linalg.norm(normal, axis=1, keepdims=True), middle
