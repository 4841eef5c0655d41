"""Hexahedral meshes: a masked lattice of revolution, a Cartesian block, and files that meshio reads."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import reference_vertices

_FACE_OF = {"hexahedron": "quad", "hexahedron20": "quad8", "hexahedron27": "quad9"}
_TURN = 2 * np.pi


@dataclass(frozen=True)
class Mesh:
    """Nodes (n, 3) [m], elements (e, v) in the order of meshio, and their lattice cell (e, 3)."""

    node: np.ndarray
    element: np.ndarray
    kind: str
    cell: np.ndarray


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
    """Ascending lattice lines: all ``edges``, and between two of them equal cells of at most ``size``."""
    spans = list(zip(edges, edges[1:], strict=False))
    cells = [max(int(np.ceil((last - first) / size - 1e-9)), 1) for first, last in spans]
    parts = [np.linspace(*span, count + 1)[1:] for span, count in zip(spans, cells, strict=True)]
    return np.concatenate([edges[:1], *parts])


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


def read_mesh(path):
    """Mesh of a file that meshio reads; one type of hexahedra, coordinates in metres.

    Raises ConfigError for an unreadable file, other cells or none.
    """
    import meshio

    try:
        read = meshio.read(path)
    except (OSError, SystemExit, meshio.ReadError, ValueError) as error:
        raise ConfigError(f"mesh file {path}", "a mesh that meshio can read", str(error) or "none") from None
    solid = [b for b in read.cells if b.dim == 3]
    kinds = {b.type for b in solid}
    if len(kinds) != 1 or not kinds <= set(_FACE_OF):
        raise ConfigError(f"mesh file {path}", f"cells of one type out of {', '.join(_FACE_OF)}",
                          ", ".join(sorted(kinds)) or "no solid cells")
    element = np.concatenate([b.data for b in solid])
    used, compact = np.unique(element, return_inverse=True)
    return Mesh(np.asarray(read.points[used], float), compact.reshape(element.shape), kinds.pop(),
                np.zeros((len(element), 3), int))


def boundary_faces(mesh):
    """(f, v) nodes of the faces that belong to one element only, corners anticlockwise seen from outside."""
    square, cube = reference_vertices(_FACE_OF[mesh.kind]), reference_vertices(mesh.kind)
    faces = np.concatenate([mesh.element[:, _face_vertices(square, cube, axis, side)]
                            for axis in range(3) for side in (0, 1)])
    _, group, times = np.unique(np.sort(faces[:, :4], axis=1), axis=0, return_inverse=True, return_counts=True)
    return faces[times[group.ravel()] == 1]


def face_kind(face):
    """meshio cell type of (f, v) faces."""
    return {4: "quad", 8: "quad8", 9: "quad9"}[face.shape[1]]


def face_normals(node, face):
    """(f, 3) unit normals at the middle of the faces, outwards, and (f, 3) middles [m]."""
    corner = node[face[:, :4]]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    return normal / np.linalg.norm(normal, axis=1, keepdims=True), corner.mean(axis=1)


def _face_vertices(square, cube, axis, side):
    """Vertices of one face of the cube; its two axes are ordered so that the normal points outwards."""
    first, second = ((axis + 1) % 3, (axis + 2) % 3)[::1 if side else -1]
    place = np.full((len(square), 3), float(side))
    place[:, first], place[:, second] = square.T
    return [int(np.argmin(np.abs(cube - p).sum(axis=1))) for p in place]
