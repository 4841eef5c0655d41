"""Where two unlike surfaces lie on each other: quadrature on what each pair of their faces has in common.

Each face of the second surface is laid on the tangent plane of a face of the first one, clipped there, and cut into
triangles (segment-based integration, Puso, Int. J. Numer. Meth. Engng 59 (2004) 315). Exact for plane faces with
straight edges.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.physics.fem.face_averages import project
from pipeline.physics.fem.mesh import face_kind, face_normals
from pipeline.physics.fem.reference_cells import by_kind, quadrature, shape_functions

#: order of quadrature on a triangle
_ORDER = 4
#: smallest piece, in squares of the size of its face, and how far faces that bend may rise, in sizes
_SMALLEST, _SLOPE = 1e-9, 0.1


@dataclass(frozen=True)
class Overlap:
    """Quadrature points where a face of one ``kind`` meets another face of one kind.

    ``first`` and ``second`` (p,): numbers of the faces; ``local`` (p, 2): on the first one; ``shape`` (p, v) and
    ``below`` (p, w): shape functions of both; ``area`` (p,) m^2.
    """

    kind: str
    first: np.ndarray
    second: np.ndarray
    local: np.ndarray
    shape: np.ndarray
    below: np.ndarray
    area: np.ndarray


def overlaps(node, first, second, distance):
    """[Overlap] of the faces ``first`` (f, v) with ``second`` (g, w) of nodes (n, 3) m, less than ``distance`` apart.

    Empty where they do not meet.
    """
    found = [_of_kinds(node, (kind, rows, cells), each, distance)
             for kind, rows, cells in by_kind(face_kind(first), first) for each in by_kind(face_kind(second), second)]
    return [overlap for overlap in found if overlap is not None]


def _of_kinds(node, one, other, distance):
    """The Overlap of faces (kind, rows, cells) of one kind each; None without any."""
    (kind, rows, cells), (kind_below, rows_below, cells_below) = one, other
    pieces = list(_pieces(node, cells, cells_below, distance))
    if not pieces:
        return None
    number, below = (np.repeat([piece[k] for piece in pieces], [len(piece[3]) for piece in pieces]) for k in (0, 1))
    point, area = (np.concatenate([piece[k] for piece in pieces]) for k in (2, 3))
    local = project(node[cells[number]], kind, point)[0]
    shape = shape_functions(kind, local)[0]
    there, gap = project(node[cells_below[below]], kind_below, np.einsum("pv,pvx->px", shape, node[cells[number]]))
    near = gap < distance
    return Overlap(kind, rows[number[near]], rows_below[below[near]], local[near], shape[near],
                   shape_functions(kind_below, there[near])[0], area[near])


def _pieces(node, cells, cells_below, distance):
    """Yield (face, face below, points (p, 3), areas (p,)) of the pairs that have something in common."""
    (normal, middle), (_, middle_below) = face_normals(node, cells), face_normals(node, cells_below)
    corner, corner_below = (node[each[:, :_corners(each)]] for each in (cells, cells_below))
    reach, reach_below = (np.linalg.norm(each - centre[:, None], axis=2).max(axis=1)
                          for each, centre in ((corner, middle), (corner_below, middle_below)))
    near = scipy.spatial.cKDTree(middle_below).query_ball_point(middle, reach + reach_below.max())
    for i, members in enumerate(near):
        first = corner[i, 1] - corner[i, 0]
        first = first - (first @ normal[i]) * normal[i]
        plane = np.array([first / np.linalg.norm(first), np.cross(normal[i], first / np.linalg.norm(first))])
        bounds = (corner[i] - middle[i]) @ plane.T
        for j in members:
            if abs((middle_below[j] - middle[i]) @ normal[i]) < distance + _SLOPE * reach[i]:
                point, area = _common(bounds, (corner_below[j] - middle[i]) @ plane.T)
                if area.sum() > _SMALLEST * reach[i] ** 2:
                    yield i, j, middle[i] + point @ plane, area


def _corners(cells):
    """Number of corners of faces of one kind."""
    return 3 if face_kind(cells) == "triangle6" else 4


def _common(bounds, outline):
    """Points (p, 2) and areas (p,) on what two convex polygons (c, 2) have in common, ``bounds`` anticlockwise."""
    for begin, end in zip(bounds, np.roll(bounds, -1, axis=0), strict=True):
        along = end - begin
        height = along[0] * (outline[:, 1] - begin[1]) - along[1] * (outline[:, 0] - begin[0])
        if height.max() <= 0:
            return np.empty((0, 2)), np.empty(0)
        outline = outline if height.min() >= 0 else _clipped(outline, height)
    edges = np.stack((outline, np.roll(outline, -1, axis=0)), axis=1) - outline.mean(axis=0)
    twice = np.abs(edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0])
    point, weight = quadrature("triangle6", _ORDER)
    points = np.einsum("qk,tkx->tqx", point, edges) + outline.mean(axis=0)
    return points.reshape(-1, 2), np.outer(twice, weight).ravel()


def _clipped(outline, height):
    """The part of a convex polygon (c, 2) where ``height`` (c,), linear between its corners, is not negative."""
    kept = []
    for k in range(len(outline)):
        if height[k - 1] * height[k] < 0:
            share = height[k - 1] / (height[k - 1] - height[k])
            kept.append(outline[k - 1] + share * (outline[k] - outline[k - 1]))
        if height[k] >= 0:
            kept.append(outline[k])
    return np.array(kept)
