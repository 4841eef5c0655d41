"""Meshes of bodies from files that meshio reads, in declared units, with the checks that a body needs."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.process import answered
from pipeline.physics.fem.mesh import Mesh, joined
from pipeline.physics.fem.reference_cells import MIXED, by_kind, quadrature, reference_vertices, shape_functions

#: system of units of a mesh -> its length in metres
LENGTH = {"SI": 1.0, "mm-t-s": 1e-3, "mm-kg-ms": 1e-3}
#: formats that meshio reads and that take no data from another file
_FORMATS = (".inp", ".msh", ".vtu", ".vtk", ".bdf", ".nas", ".fem")
_REMEDY = "check that the file is whole, or write it as Abaqus .inp, gmsh or VTU"
_KINDS = ("hexahedron20", "hexahedron27", "tetra10", "wedge15")
_LINEAR = ("hexahedron", "tetra", "wedge")
#: smallest and largest extent [m] of a part of a brake
_SIZES = 5e-3, 2.0
#: nodes nearer than this share of the extent are one node
_SAME = 1e-7
#: mid-side nodes lie within this share of an edge from its middle: at a quarter the element begins to fold
_MIDDLE = 0.3
_BATCH = 2048
_MESH = "mesh.npz"


def read_mesh(path, units="SI"):
    """(Mesh [m], groups, sentences on what was not taken) of a file that meshio reads, in one of the systems of LENGTH.
    It is read in a process of its own.

    ``groups``: physical groups of gmsh, {name in capitals: rows of elements (k,), or nodes of faces (f, v)}. Raises
    ConfigError for an unreadable file, and as ``mesh_of``.
    """
    return answered(f"{__name__}:leave", path, _mesh, units=units)


def leave(path, folder, units):
    """In the child process: read the mesh and leave it in ``folder``."""
    where, read = f"mesh file {path}", _read(path)
    mesh, used = mesh_of(where, read.points, [(b.type, b.data) for b in read.cells if b.dim == 3], units)
    groups = _groups(read, used)
    left = [f"{len(b.data)} cells {b.type}" for b in read.cells if b.dim < 3 and b.type != "vertex" and not groups]
    named = {"sets of points": read.point_sets, "sets of cells": read.cell_sets, "data at points": read.point_data,
             "data in cells": read.cell_data, "groups": read.field_data}
    members = ((kind, [n for n in map(str, names) if n.upper() not in groups and not n.startswith("gmsh:")])
               for kind, names in named.items())
    left += [f"{kind} {', '.join(names)}" for kind, names in members if names]
    np.savez(Path(folder) / _MESH, *groups.values(), node=mesh.node, element=mesh.element, cell=mesh.cell,
             told=json.dumps({"kind": mesh.kind, "groups": list(groups), "left": left}))


def _mesh(folder):
    """What ``leave`` has left there."""
    with np.load(folder / _MESH) as held:
        told = json.loads(str(held["told"]))
        return (Mesh(held["node"], held["element"], told["kind"], held["cell"]),
                {name: held[f"arr_{k}"] for k, name in enumerate(told["groups"])},
                (f"not read: {'; '.join(told['left'])}",) if told["left"] else ())


def _groups(read, used):
    """Physical groups of gmsh on the mesh of the points ``used``: its solids by rows, its faces by their nodes."""
    groups = {}
    for name, (tag, dim) in ((n, each) for n, each in read.field_data.items() if np.shape(each) == (2,)):
        parts, first = [], 0
        for block, physical in zip(read.cells, read.cell_data.get("gmsh:physical", ()), strict=False):
            rows = np.flatnonzero(physical == tag) if block.dim == dim else np.empty(0, int)
            if len(rows) and dim == 3:
                parts.append(first + rows)
            elif len(rows) and dim == 2:
                place = np.minimum(np.searchsorted(used, block.data[rows]), len(used) - 1)
                parts.append(place[(used[place] == block.data[rows]).all(axis=1)])
            first += len(block.data) if block.dim == 3 else 0
        if parts and len({part.shape[1:] for part in parts}) == 1:
            groups[name.upper()] = np.concatenate(parts)
    return groups


def mesh_of(where, points, blocks, units, labels=None):
    """(Mesh [m], used rows of ``points``) of solid cells.

    Parameters
    ----------
    where : beginning of errors
    points : (n, 3) in one of the systems of units LENGTH
    blocks : [(kind, (c, v) rows of points in the order of meshio)]
    labels : (e,) numbers of the elements in the file, for errors; counted from 0 by default

    Raises ConfigError as ``unchecked`` and ``check``.
    """
    mesh, used = unchecked(where, points, blocks, units)
    check(mesh, where, labels)
    return mesh, used


def unchecked(where, points, blocks, units):
    """As ``mesh_of``, but refuses only cells not served, nodes that are not there and a size that no part has."""
    blocks = _served(where, blocks)
    _check_nodes(where, blocks, len(points))
    kind, element = joined(blocks)
    used, compact = np.unique(element, return_inverse=True)
    node = np.asarray(points[used], float)
    _check_size(where, np.ptp(node, axis=0).max(), units)
    return Mesh(LENGTH[units] * node, compact.reshape(element.shape), kind, np.zeros((len(element), 3), int)), used


def check(mesh, where, labels=None, ties=()):
    """Refuse a Mesh that is no one sound body: nodes that lie in one place, disconnected parts, mid-side nodes off
    their edges and elements turned inside out.

    ``labels`` (e,): numbers of its elements in the file; ``ties`` [(f, v) and (g, w) faces] that join its parts, whose
    nodes may lie in one place. Raises ConfigError, which begins with ``where``.
    """
    extent = np.ptp(mesh.node, axis=0).max()
    rows = [mesh.element, *(np.append(*map(np.ravel, tie))[None] for tie in ties)]
    part, whole = _parts(len(mesh.node), rows[:1]), _parts(len(mesh.node), rows)
    pair = scipy.spatial.cKDTree(mesh.node).query_pairs(_SAME * extent, output_type="ndarray")
    pair = pair[(part[pair[:, 0]] == part[pair[:, 1]]) | (whole[pair[:, 0]] != whole[pair[:, 1]])]
    if len(pair):
        raise ConfigError(where, "one node in one place", f"{len(pair)} pairs of them, the first at "
                          f"{np.array2string(mesh.node[pair[0, 0]], precision=5)} m",
                          "merge coincident nodes (equivalence) and write the mesh again, or tie the parts (*TIE)")
    if whole.max(initial=0):
        nodes = [mesh.node[whole == k] for k in range(min(whole.max() + 1, 5))]
        listed = [f"{len(each)} nodes about {np.array2string(each.mean(axis=0), precision=4)} m" for each in nodes]
        raise ConfigError(where, "one connected body", f"{whole.max() + 1} parts, of {', '.join(listed)}",
                          "write this body alone, merge the nodes that its parts share, or tie them (*TIE)")
    for kind, rows, cells in by_kind(mesh.kind, mesh.element):
        names = [f"{k}, counted from 0" for k in rows] if labels is None else labels[rows]
        _check_middles(where, mesh.node, kind, names, cells)
        _check_jacobians(where, mesh.node, kind, names, cells)


def _parts(nodes, rows):
    """(n,) number of the part to which each node belongs; ``rows`` [(r, v)] of nodes that hang together."""
    ends = [(np.repeat(each[:, 0], each.shape[1]), each.ravel()) for each in rows]
    first, other = (np.concatenate(each) for each in zip(*ends, strict=True))
    link = scipy.sparse.coo_matrix((np.ones(len(first), bool), (first, other)), (nodes, nodes))
    return scipy.sparse.csgraph.connected_components(link, directed=False)[1]


def _read(path):
    import meshio

    if Path(path).suffix.lower() not in _FORMATS:
        raise ConfigError(f"mesh file {path}", f"one of {', '.join(_FORMATS)}", repr(Path(path).suffix), _REMEDY)
    try:
        return meshio.read(path)
    except (OSError, SystemExit, meshio.ReadError, ValueError) as error:
        reason = str(error) or "none"
    except MemoryError:
        raise
    except Exception as error:  # meshio passes on whatever its parsers stumble over
        reason = f"one that stops its reader ({type(error).__name__}: {error})"
    raise ConfigError(f"mesh file {path}", "a mesh that meshio can read", reason, _REMEDY)


def _served(where, blocks):
    """The ``blocks`` [(kind, cells)] if the assembly has their kinds."""
    kinds = {kind for kind, _ in blocks}
    linear = sorted(kinds & set(_LINEAR))
    if linear:
        raise ConfigError(where, "elements of second order", ", ".join(linear),
                          "linear elements lock in shear: bending frequencies would be some 20 % too high; write"
                          " quadratic elements (C3D20, C3D10)")
    if not kinds or not kinds <= set(_KINDS) or (len(kinds) > 1 and "hexahedron27" in kinds):
        raise ConfigError(where, f"cells out of {', '.join(_KINDS)} ({MIXED} without hexahedron27)",
                          ", ".join(sorted(kinds)) or "no solid cells", "mesh with quadratic hexahedra or tetrahedra")
    return blocks


def _check_nodes(where, blocks, count):
    strange = [node for _, cells in blocks for node in np.unique(cells) if not 0 <= node < count]
    if strange:
        raise ConfigError(where, f"elements of its {count} nodes", f"a vertex at row {strange[0]}",
                          "the file is damaged, or lacks nodes: write it again")


def _check_size(where, extent, units):
    """``extent``: largest one in the units of the file."""
    low, high = _SIZES
    if low <= LENGTH[units] * extent <= high:
        return
    others = [name for name, length in LENGTH.items() if low <= length * extent <= high]
    raise ConfigError(where, f"a part of {low:g} to {high:g} m", f"{LENGTH[units] * extent:.4g} m with mesh_units:"
                      f" {units}",
                      f"declare mesh_units: {' or '.join(others)}" if others else "check the units of the mesh")


def _check_middles(where, node, kind, names, cells):
    """Refuse mid-side nodes that do not lie between their corners, as nodes in another order do."""
    for middle, *ends in _edges(kind):
        first, last = (node[cells[:, end]] for end in ends)
        length = np.linalg.norm(last - first, axis=1)
        distance = np.linalg.norm(node[cells[:, middle]] - (first + last) / 2, axis=1)
        off = distance / np.maximum(length, np.finfo(float).tiny)
        worst = int(np.argmax(off))
        if off[worst] > _MIDDLE:
            raise ConfigError(where, "mid-side nodes near the middles of their edges", f"node {middle + 1} of element"
                              f" {names[worst]} ({kind}) {off[worst]:.2g} of its edge away",
                              "check the order of the nodes, and mid-side nodes that were moved")


@cache
def _edges(kind):
    """(vertex in the middle, corner, corner) of each edge of a cell."""
    vertex = reference_vertices(kind)
    corner = [k for k in range(len(vertex)) if (vertex[k] != 0.5).all()]
    joined_by_edges = [(a, b) for a in corner for b in corner if a < b and (
        kind.startswith("tetra") or np.count_nonzero(vertex[a] != vertex[b]) == 1 or
        kind.startswith("wedge") and vertex[a][2] == vertex[b][2])]
    return [(k, a, b) for a, b in joined_by_edges for k in range(len(vertex))
            if np.array_equal(2 * vertex[k], vertex[a] + vertex[b])]


def _check_jacobians(where, node, kind, names, cells):
    gradient = shape_functions(kind, quadrature(kind)[0])[1]
    for start in range(0, len(cells), _BATCH):
        batch = slice(start, start + _BATCH)
        volume = np.linalg.det(np.einsum("evx,qvr->eqxr", node[cells[batch]], gradient, optimize=True)).min(axis=1)
        bad = np.flatnonzero(volume <= 0)
        if len(bad):
            raise ConfigError(where, "positive Jacobians", f"element {names[start + bad[0]]} ({kind}) with"
                              f" {volume[bad[0]]:.3g}",
                              "check the order of its vertices, and mid-side nodes far off their edges")
