"""Displacement of a surface: weighted means over points on its faces, and elastic foundations.

A row of ``surface_rows`` conserves what it transmits: its weights sum to one, and with the shape
functions of the faces they carry a force to the nodes with the force's resultant and moment.
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.mesh import face_kind, face_normals
from pipeline.physics.fem.node_graph import summed_blocks
from pipeline.physics.fem.reference_cells import MIXED_FACES, by_kind, quadrature, shape_functions

#: faces that are tried at a point, those of the nearest middles, and more where it lies on none of them, as on wide
#: faces beside narrow ones; how far from the middle of a face a point may lie on it, over its farthest node
_CANDIDATES, _REACH = (9, 100), 1.1
_NEWTON_STEPS = 12
#: how far outside a face (share of its size) a point still counts as on it
_SLACK = 1e-6


def face_points(node, face, count=None):
    """Gauss points (f, q, 3) [m] of the faces and the area (f, q) [m^2] that each stands for.

    ``count``: points per direction of quadrilateral faces, exact to the order 2 ``count`` - 1, of triangles to one
    less, as rules of odd order have points there that stand for a negative area; by default as many as the kind of face
    asks for. Faces are of one kind, else ConfigError.
    """
    kind = face_kind(face)
    if kind == MIXED_FACES:
        raise ConfigError("surface", "faces of one kind", "triangles and quadrilaterals")
    point, weight = quadrature(kind, count and (max(2 * count - 2, 1) if kind == "triangle6" else 2 * count - 1))
    shape, gradient = shape_functions(kind, point)
    tangent = np.einsum("fvx,qvr->fqrx", node[face], gradient)
    area = np.linalg.norm(np.cross(tangent[..., 0, :], tangent[..., 1, :]), axis=-1)
    return np.einsum("qv,fvx->fqx", shape, node[face]), area * weight


def interpolation(node, face, point, where="surface point", distance=1e-6, slack=_SLACK):
    """Face (p,) and vertex weights (p, v) of each (p, 3) point on the faces.

    ``distance`` [m] is how far off the surface a point may lie, ``slack`` how far beside its face, in sizes of the
    face; farther raises ConfigError.
    """
    nearest, weight = nearest_faces(node, face, point, distance, slack)
    if (nearest < 0).any():
        raise ConfigError(where, "a point on the surface", f"{point[np.argmin(nearest)]} m, off it",
                          "check radii, angles and heights")
    return nearest, weight


def nearest_faces(node, face, point, distance=1e-6, slack=_SLACK):
    """As ``interpolation``, but with face -1 and weights 0 for points off the surface."""
    nearest, weight = np.full(len(point), -1), np.zeros((len(point), face.shape[1]))
    for kind, rows, cells in by_kind(face_kind(face), face):
        left = np.flatnonzero(nearest < 0)
        at, local = _nearest(node, cells, kind, point[left], distance, slack)
        on = at >= 0
        nearest[left[on]] = rows[at[on]]
        weight[left[on], :cells.shape[1]] = shape_functions(kind, local[on])[0]
    return nearest, weight


def _nearest(node, face, kind, point, distance, slack):
    """Face (p,) of one kind below each (p, 3) point, -1 for none, and its reference coordinates (p, 2) there."""
    middle = face_normals(node, face)[1]
    reach = (_REACH + 2 * slack) * np.linalg.norm(node[face] - middle[:, None], axis=2).max(axis=1) + distance
    tree, nearest, local = scipy.spatial.cKDTree(middle), np.full(len(point), -1), np.zeros((len(point), 2))
    for count in _CANDIDATES:
        missing = np.flatnonzero(nearest < 0)
        if not len(missing):
            break
        found = tree.query(point[missing], k=np.arange(1, min(count, len(face)) + 1))
        for apart, candidate in zip(*(each.T for each in found), strict=True):
            left = np.flatnonzero((nearest[missing] < 0) & (apart < reach[candidate]))
            if not len(left):
                continue
            at, chosen = missing[left], candidate[left]
            inner, gap = project(node[face[chosen]], kind, point[at])
            inside = _inside(kind, inner, slack) & (gap < distance)
            nearest[at[inside]], local[at[inside]] = chosen[inside], inner[inside]
    return nearest, local


def _inside(kind, local, slack):
    """True where reference coordinates (p, 2) lie in the face."""
    if kind == "triangle6":
        return (local.min(axis=1) > -slack) & (local.sum(axis=1) < 1 + slack)
    return np.abs(local - 0.5).max(axis=1) < 0.5 + slack


def surface_rows(node, face, point, weight, group, where="surface point", distance=1e-6):
    """(groups, n) CSR: mean displacement of each group of points on the faces.

    Parameters
    ----------
    point : (p, 3) array [m], weight : (p,) array, e.g. the area of each point; group : (p,) integers

    Weights within a row sum to one.
    """
    return mean_rows(len(node), face, *interpolation(node, face, point, where, distance), weight, group)


def mean_rows(nodes, face, nearest, shape, weight, group):
    """As ``surface_rows``, of points whose faces ``nearest`` (p,) and vertex weights ``shape`` (p, v) are known."""
    share = weight / np.bincount(group, weight)[group]
    rows = np.repeat(group, face.shape[1])
    return scipy.sparse.csr_matrix(((share[:, None] * shape).ravel(), (rows, face[nearest].ravel())),
                         (group.max() + 1, nodes))


def face_mean(node, face):
    """(1, n) CSR: mean over the area of faces (f, v), which may be of several kinds."""
    total = np.zeros(len(node))
    for kind, _, cells in by_kind(face_kind(face), face):
        area = face_points(node, cells)[1]
        np.add.at(total, cells, area @ shape_functions(kind, quadrature(kind)[0])[0])
    return scipy.sparse.csr_matrix(total / total.sum())


def along(mean, direction):
    """(rows, 3n): means (rows, n) of the displacement component along ``direction`` (rows, 3)."""
    mean = mean.tocoo()
    column = (3 * mean.col[:, None] + np.arange(3)).ravel()
    weight = (mean.data[:, None] * direction[mean.row]).ravel()
    return scipy.sparse.csr_matrix((weight, (np.repeat(mean.row, 3), column)), (mean.shape[0], 3 * mean.shape[1]))


def foundation(node, face, stiffness):
    """(3n, 3n) CSR of springs spread over the faces; ``stiffness`` (3, 3) in Pa/m along x, y, z."""
    shape = shape_functions(face_kind(face), quadrature(face_kind(face))[0])[0]
    product = np.einsum("fq,qa,qb->fab", face_points(node, face)[1], shape, shape, optimize=True)
    blocks = np.einsum("fab,ij->faibj", product, stiffness)
    size = 3 * face.shape[1]
    return summed_blocks(blocks.reshape(-1, size, size), face, len(node))


def project(corner, kind, point):
    """Reference coordinates (p, 2) of the nearest point of each face and its distance (p,), by Gauss-Newton."""
    local = np.full((len(point), 2), 0.5)
    for _ in range(_NEWTON_STEPS):
        shape, gradient = shape_functions(kind, local)
        miss = point - np.einsum("pv,pvx->px", shape, corner)
        tangent = np.einsum("pvr,pvx->pxr", gradient, corner)
        normal = tangent.swapaxes(1, 2) @ tangent
        step = np.linalg.solve(normal, tangent.swapaxes(1, 2) @ miss[..., None])[..., 0]
        local = np.clip(local + step, -1, 2)
    miss = point - np.einsum("pv,pvx->px", shape_functions(kind, local)[0], corner)
    return local, np.linalg.norm(miss, axis=1)
