"""Ties of unlike meshes: two faces that meet are held together in the mean over each node, by stiff springs.

The jump [u] = u_a - u_b over the surface a, projected on the linear functions N_i of its corners (a mortar tie whose
multipliers are of lower order than the displacement; Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989), costs the energy

    1/2 sum_i k d_i (int N_i [u] dA / d_i)^2,    d_i = int N_i dA,

with k so stiff that the tie yields less than a hundredth of what the layer of elements beside it does. A uniform stress
passes exactly between plane faces with straight edges.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.mesh import face_kind
from pipeline.physics.fem.overlaps import overlaps
from pipeline.physics.fem.reference_cells import by_kind, quadrature, shape_functions

#: stiffness of a tie, times Young's modulus over the size of a face
_STIFFNESS = 100.0
#: faces meet where they are nearer than this share of their size
_NEAR = 0.1
#: least share of a surface that must meet the other
_LEAST = 0.01
#: least area of a node that counts, in those of the largest
_SMALLEST = 1e-6


@dataclass(frozen=True)
class Tie:
    """Springs of a tie: ``rows`` (r, n) sparse, relative means of a scalar over nodes, their ``area`` (r,) m^2, the
    ``stiffness`` per area in N/m^3, and the ``share`` of the first surface that meets the second."""

    rows: "scipy.sparse.csr_matrix"
    area: np.ndarray
    stiffness: float
    share: float


def tie(node, first, second, young, where):
    """Tie of the faces ``first`` (f, v) to the faces ``second`` (g, w) of nodes (n, 3) m.

    ``young``: the larger Young's modulus in Pa of what they belong to. Where the second surface does not lie below the
    first one, nothing holds it. Raises ConfigError at ``where`` for surfaces that do not meet.
    """
    whole = sum(_areas(node, kind, cells).sum() for kind, _, cells in by_kind(face_kind(first), first))
    size = np.sqrt(whole / len(first))
    parts = overlaps(node, first, second, _NEAR * size)
    share = sum(part.area.sum() for part in parts) / whole
    if share < _LEAST:
        raise ConfigError(where, "two surfaces that lie on each other", f"ones that meet over {share:.1%} of the first",
                          "check positions and units of the parts, and which surfaces the tie names")
    hat, jump, weight = (join(each) for join, each in zip(
        (scipy.sparse.vstack, scipy.sparse.vstack, np.concatenate),
        zip(*(_at_points(part, first, second, len(node)) for part in parts), strict=True), strict=True))
    area = hat.T @ weight
    held = np.flatnonzero(area > _SMALLEST * area.max())
    rows = scipy.sparse.diags(1 / area[held]) @ (hat.T @ scipy.sparse.diags(weight) @ jump).tocsr()[held]
    return Tie(rows.tocsr(), area[held], _STIFFNESS * young / size, float(share))


def tie_stiffness(ties, nodes):
    """(3 nodes, 3 nodes) CSR of the Ties of a body, alike in all directions."""
    total = scipy.sparse.csr_matrix((nodes, nodes))
    for each in ties:
        total = total + each.rows.T @ scipy.sparse.diags(each.stiffness * each.area) @ each.rows
    return scipy.sparse.kron(total, scipy.sparse.identity(3), format="csr")


def refuse_loose(mesh, ties, where):
    """ConfigError at ``where`` for parts of a Mesh that neither nodes nor ``ties`` hold, where their surfaces miss."""
    count, (cells, width) = len(mesh.node), mesh.element.shape
    of_cells = scipy.sparse.csr_matrix((np.ones(cells * width), (np.repeat(np.arange(cells), width),
                                                                 mesh.element.ravel())), (cells, count))
    held = scipy.sparse.vstack([of_cells, *(abs(tie.rows) > 0 for tie in ties)], format="csr")
    whole, part = scipy.sparse.csgraph.connected_components(scipy.sparse.bmat([[None, held], [held.T, None]]), False)
    if whole > 1:
        part = part[held.shape[0]:]
        nodes = mesh.node[part != np.bincount(part).argmax()]
        raise ConfigError(where, "ties that hold all parts of the body together", f"{len(nodes)} nodes about"
                          f" {np.array2string(nodes.mean(axis=0), precision=4)} m that none holds",
                          "let the surfaces of a tie meet there, or merge nodes")


def _areas(node, kind, cells):
    """(f, q) areas of the quadrature points of faces of one kind."""
    local, weight = quadrature(kind)
    tangent = np.einsum("fvx,qvr->fqrx", node[cells], shape_functions(kind, local)[1])
    return np.linalg.norm(np.cross(tangent[..., 0, :], tangent[..., 1, :]), axis=-1) * weight


def _at_points(part, first, second, nodes):
    """(p, n) sparse of the linear functions of the corners and of the jump at the points of an Overlap; areas (p,)."""
    x, y = part.local.T
    linear = (np.column_stack((1 - x - y, x, y)) if part.kind == "triangle6" else
              np.column_stack(((1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y)))
    shape, below = (_scattered(values, cells, nodes) for values, cells in (
        (part.shape, first[part.first]), (part.below, second[part.second])))
    return _scattered(linear, first[part.first], nodes), shape - below, part.area


def _scattered(values, cells, nodes):
    """(p, nodes) sparse of ``values`` (p, v) at the first v nodes of ``cells`` (p, w)."""
    count, width = values.shape
    return scipy.sparse.csr_matrix((values.ravel(), (np.repeat(np.arange(count), width), cells[:, :width].ravel())),
                                   (count, nodes))
