"""Reference cells: vertices in the order of meshio, shape functions, quadrature and faces.

A mesh of several kinds ("mixed") has rows as long as those of its largest cells; shorter ones repeat their first
vertex. The faces of such a mesh are triangles of six nodes and quadrilaterals of eight in the same manner.
"""

from functools import cache
from itertools import product

import numpy as np

from pipeline.contract.errors import ConfigError

MIXED, MIXED_FACES = "mixed", "mixed faces"
#: corners, edge middles, face middles, centre of the reference cube 0..1
_CUBE = np.array([
    (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
    (.5, 0, 0), (1, .5, 0), (.5, 1, 0), (0, .5, 0), (.5, 0, 1), (1, .5, 1), (.5, 1, 1), (0, .5, 1),
    (0, 0, .5), (1, 0, .5), (1, 1, .5), (0, 1, .5),
    (0, .5, .5), (1, .5, .5), (.5, 0, .5), (.5, 1, .5), (.5, .5, 0), (.5, .5, 1), (.5, .5, .5)])
_SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (.5, 0), (1, .5), (.5, 1), (0, .5), (.5, .5)])
_TRIANGLE = np.array([(0, 0), (1, 0), (0, 1), (.5, 0), (.5, .5), (0, .5)])
_TETRAHEDRON = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (.5, 0, 0), (.5, .5, 0), (0, .5, 0),
                         (0, 0, .5), (.5, 0, .5), (0, .5, .5)])
_WEDGE = np.array([(*_TRIANGLE[k], z) for z, rows in ((0, range(3)), (1, range(3)), (0, range(3, 6)),
                                                      (1, range(3, 6)), (.5, range(3))) for k in rows])
#: meshio cell type -> (scikit-fem element or None, reference vertices, order of quadrature); of tetrahedra the
#: rule of order 5 is the first one with positive weights that is exact to 4, the order of their mass
_CELL = {"hexahedron": ("ElementHex1", _CUBE[:8], 3), "hexahedron20": ("ElementHexS2", _CUBE[:20], 5),
         "hexahedron27": ("ElementHex2", _CUBE, 5), "tetra10": (None, _TETRAHEDRON, 5), "wedge15": (None, _WEDGE, 5),
         "quad": ("ElementQuad1", _SQUARE[:4], 3), "quad8": ("ElementQuadS2", _SQUARE[:8], 5),
         "quad9": ("ElementQuad2", _SQUARE, 5), "triangle6": (None, _TRIANGLE, 4)}
#: powers of the monomials that span the shape functions of simplices and wedges
_POWERS = {"triangle6": [p for p in product(range(3), repeat=2) if sum(p) < 3],
           "tetra10": [p for p in product(range(3), repeat=3) if sum(p) < 3],
           "wedge15": [p for p in product(range(3), repeat=3) if p[0] + p[1] + max(p[2] - 1, 0) < 3]}
#: corners of the faces of tetrahedra and wedges, anticlockwise seen from outside
_FACES = {"tetra10": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
          "wedge15": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))}
_SQUARE_OF = {"hexahedron": "quad", "hexahedron20": "quad8", "hexahedron27": "quad9"}
#: kinds that a mixed mesh may hold, and its faces, fewest vertices first
_WITHIN = {MIXED: ("tetra10", "wedge15", "hexahedron20"), MIXED_FACES: ("triangle6", "quad8")}


def reference_vertices(kind):
    """(v, d) vertices of the reference cell within 0..1; ConfigError for a cell type not served."""
    if kind not in _CELL:
        raise ConfigError("mesh", f"cells of type {', '.join(_CELL)}", repr(kind),
                          "mesh with hexahedra, tetrahedra or wedges of second order")
    return _CELL[kind][1]


def shape_functions(kind, point):
    """Shape functions (p, v) and their gradients (p, v, d) at (p, d) points of the reference cell."""
    if kind in _POWERS:
        return _polynomials(kind, np.asarray(point, float))
    finite, order = _finite_element(kind)
    columns = np.ascontiguousarray(np.asarray(point, float).T)
    shape, gradient = np.empty((len(order), columns.shape[1])), np.empty((len(order), *columns.shape))
    for k, i in enumerate(order):
        shape[k], gradient[k] = finite.lbasis(columns, i)
    return shape.T, gradient.transpose(2, 0, 1)


@cache
def quadrature(kind, order=None):
    """Gauss points (q, d) and weights (q,) of the reference cell by ``order``; the weights sum to its measure."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefLine, RefTet, RefTri

    order = order or _CELL[kind][2]
    if kind == "wedge15":
        (flat, area), (line, length) = get_quadrature(RefTri, order), get_quadrature(RefLine, order)
        point = np.vstack((np.repeat(flat, line.shape[1], axis=1), np.tile(line, flat.shape[1])))
        return point.T, np.outer(area, length).ravel()
    simplex = {"tetra10": RefTet, "triangle6": RefTri}.get(kind)
    point, weight = get_quadrature(simplex or _finite_element(kind)[0], order)
    return point.T, weight


def by_kind(kind, cell):
    """[(kind, rows, (c, v) cells)] of ``cell`` (e, v): of a mesh with several kinds each of them, else all."""
    if kind not in _WITHIN:
        reference_vertices(kind)
        return [(kind, np.arange(len(cell)), cell)]
    left, blocks = np.arange(len(cell)), []
    for each in _WITHIN[kind]:
        count = len(reference_vertices(each))
        fits = (cell[left, count:] == cell[left, :1]).all(axis=1)
        if fits.any():
            blocks.append((each, left[fits], cell[left[fits], :count]))
        left = left[~fits]
    return blocks


def padded(cell, width):
    """(c, width) cells whose rows repeat their first vertex where they are shorter."""
    return np.hstack((cell, np.repeat(cell[:, :1], width - cell.shape[1], axis=1)))


@cache
def cell_faces(kind):
    """Vertices of each face of a cell, corners first and anticlockwise seen from outside."""
    cell = reference_vertices(kind)
    if kind in _SQUARE_OF:
        square = reference_vertices(_SQUARE_OF[kind])
        return [_square_face(square, cell, axis, side) for axis in range(3) for side in (0, 1)]
    return [[*corners, *(_nearest(cell, cell[[a, b]].mean(axis=0))
                         for a, b in zip(corners, (*corners[1:], corners[0]), strict=True))]
            for corners in _FACES[kind]]


@cache
def mirrored_vertices(kind):
    """Vertices of a cell in the order in which its mirror image is no longer turned inside out."""
    cell = reference_vertices(kind)
    image = cell[:, [1, 0, 2]] if kind.startswith("tetra") else np.column_stack((cell[:, :2], 1 - cell[:, 2]))
    return [_nearest(cell, place) for place in image]


def _square_face(square, cube, axis, side):
    """Vertices of one face of the cube; its two axes are ordered so that the normal points outwards."""
    first, second = ((axis + 1) % 3, (axis + 2) % 3)[::1 if side else -1]
    place = np.full((len(square), 3), float(side))
    place[:, first], place[:, second] = square.T
    return [_nearest(cube, p) for p in place]


def _nearest(vertices, position):
    return int(np.argmin(np.abs(vertices - position).sum(axis=1)))


def _polynomials(kind, point):
    """Polynomials of the monomials of the kind that are 1 at one vertex and 0 at the others."""
    power = np.array(_POWERS[kind])
    factor = point[:, None, :] ** power
    slope = power * point[:, None, :] ** np.maximum(power - 1, 0)
    gradient = [np.where(np.arange(power.shape[1]) == axis, slope, factor).prod(axis=2)
                for axis in range(power.shape[1])]
    weight = _weights(kind)
    return factor.prod(axis=2) @ weight, np.stack([each @ weight for each in gradient], axis=2)


@cache
def _weights(kind):
    return np.linalg.inv((reference_vertices(kind)[:, None, :] ** np.array(_POWERS[kind])).prod(axis=2))


@cache
def _finite_element(kind):
    """scikit-fem's element, and its number of each vertex in the order of meshio."""
    from skfem import element

    vertices = reference_vertices(kind)
    finite = getattr(element, _CELL[kind][0])()
    distance = np.abs(finite.doflocs[None] - vertices[:, None]).sum(axis=2)
    return finite, np.argmin(distance, axis=1)
