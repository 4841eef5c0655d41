"""Displacement of a surface: weighted means over points on its faces, and elastic foundations.

A row of ``surface_rows`` conserves what it transmits: its weights sum to one, and with the shape
functions of the faces they carry a force to the nodes with the force's resultant and moment.
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import quadrature, shape_functions, sum_blocks
from pipeline.physics.fem.mesh import face_kind

_CANDIDATES = 9
_NEWTON_STEPS = 12
#: how far outside a face (share of its size) a point still counts as on it
_SLACK = 1e-6


def face_points(node, face, count=None):
    """Gauss points (f, q, 3) [m] of the faces and the area (f, q) [m^2] that each stands for.

    ``count``: points per direction of quadrilateral faces; by default as many as the kind of face asks for.
    """
    kind = face_kind(face)
    point, weight = quadrature(kind, count and 2 * count - 1)
    shape, gradient = shape_functions(kind, point)
    tangent = np.einsum("fvx,qvr->fqrx", node[face], gradient)
    area = np.linalg.norm(np.cross(tangent[..., 0, :], tangent[..., 1, :]), axis=-1)
    return np.einsum("qv,fvx->fqx", shape, node[face]), area * weight


def interpolation(node, face, point, where="surface point", distance=1e-6, slack=_SLACK):
    """Face (p,) and vertex weights (p, v) of each (p, 3) point on the faces.

    ``distance`` [m] is how far off the surface a point may lie, ``slack`` how far beside its face, in sizes of the
    face; farther raises ConfigError.
    """
    kind, tree = face_kind(face), scipy.spatial.cKDTree(node[face[:, :4]].mean(axis=1))
    nearest = np.full(len(point), -1)
    local = np.zeros((len(point), 2))
    candidates = tree.query(point, k=min(_CANDIDATES, len(face)))[1].reshape(len(point), -1)
    for candidate in candidates.T:
        missing = np.flatnonzero(nearest < 0)
        if not len(missing):
            break
        inner, gap = _project(node[face[candidate[missing]]], kind, point[missing])
        inside = (np.abs(inner - 0.5).max(axis=1) < 0.5 + slack) & (gap < distance)
        nearest[missing[inside]] = candidate[missing[inside]]
        local[missing[inside]] = inner[inside]
    if (nearest < 0).any():
        raise ConfigError(where, "a point on the surface", f"{point[np.argmin(nearest)]} m, off it",
                          "check radii, angles and heights")
    return nearest, shape_functions(kind, local)[0]


def surface_rows(node, face, point, weight, group, where="surface point", distance=1e-6):
    """(groups, n) CSR: mean displacement of each group of points on the faces.

    Parameters
    ----------
    point : (p, 3) array [m], weight : (p,) array, e.g. the area of each point; group : (p,) integers

    Weights within a row sum to one.
    """
    nearest, shape = interpolation(node, face, point, where, distance)
    share = weight / np.bincount(group, weight)[group]
    rows = np.repeat(group, face.shape[1])
    return scipy.sparse.csr_matrix(((share[:, None] * shape).ravel(), (rows, face[nearest].ravel())),
                         (group.max() + 1, len(node)))


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
    return sum_blocks(blocks.reshape(-1, size, size), face, len(node))


def _project(corner, kind, point):
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
