"""Meshes of bodies from files that meshio reads, in declared units, with the checks that a body needs."""

from pathlib import Path

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.process import answered
from pipeline.physics.fem.mesh import Mesh, joined
from pipeline.physics.fem.reference_cells import MIXED, by_kind, quadrature, shape_functions

#: system of units of a mesh -> its length in metres
LENGTH = {"SI": 1.0, "mm-t-s": 1e-3, "mm-kg-ms": 1e-3}
#: formats that are read: none of them takes data from another file
_FORMATS = (".inp", ".msh", ".vtu", ".vtk", ".bdf", ".nas", ".fem")
_REMEDY = "check that the file is whole, or write it as Abaqus .inp, gmsh or VTU"
_KINDS = ("hexahedron20", "hexahedron27", "tetra10")
_LINEAR = ("hexahedron", "tetra", "wedge")
#: smallest and largest extent [m] of a part of a brake
_SIZES = 5e-3, 2.0
#: nodes nearer than this share of the extent are one node
_SAME = 1e-7
_BATCH = 2048
_MESH = "mesh.npz"


def read_mesh(path, units="SI"):
    """Mesh [m] of a file that meshio reads, in one of the systems of units LENGTH; read in a process of its own.

    Raises ConfigError for an unreadable file, cells not served, a size that no part of a brake has, nodes that lie in
    one place, disconnected parts and elements turned inside out.
    """
    return answered(f"{__name__}:leave", path, _mesh, units=units)


def leave(path, folder, units):
    """In the child process: read the mesh and leave it in ``folder``."""
    where, read = f"mesh file {path}", _read(path)
    blocks = _served(where, [(b.type, b.data) for b in read.cells if b.dim == 3])
    _check_nodes(where, blocks, len(read.points))
    kind, element = joined(blocks)
    used, compact = np.unique(element, return_inverse=True)
    node = np.asarray(read.points[used], float)
    _check_size(where, np.ptp(node, axis=0).max(), units)
    mesh = Mesh(LENGTH[units] * node, compact.reshape(element.shape), kind, np.zeros((len(element), 3), int))
    check(mesh, where)
    np.savez(Path(folder) / _MESH, node=mesh.node, element=mesh.element, kind=kind, cell=mesh.cell)


def _mesh(folder):
    with np.load(folder / _MESH) as held:
        return Mesh(held["node"], held["element"], str(held["kind"]), held["cell"])


def check(mesh, where):
    """Raises ConfigError, which begins with ``where``, for a Mesh that is no one sound body."""
    extent = np.ptp(mesh.node, axis=0).max()
    pair = scipy.spatial.cKDTree(mesh.node).query_pairs(_SAME * extent, output_type="ndarray")
    if len(pair):
        raise ConfigError(where, "one node in one place", f"{len(pair)} pairs of them, the first at "
                          f"{np.array2string(mesh.node[pair[0, 0]], precision=5)} m",
                          "merge coincident nodes (equivalence) and write the mesh again")
    v = mesh.element.shape[1]
    link = scipy.sparse.coo_matrix((np.ones(mesh.element.size, bool), (np.repeat(mesh.element[:, 0], v),
                                                                       mesh.element.ravel())), (len(mesh.node),) * 2)
    parts, part = scipy.sparse.csgraph.connected_components(link, directed=False)
    if parts > 1:
        raise ConfigError(where, "one connected body", f"{parts} parts of {np.sort(np.bincount(part))[::-1][:5]} nodes",
                          "write this body alone, or merge the nodes that its parts share")
    for kind, rows, cells in by_kind(mesh.kind, mesh.element):
        _check_jacobians(where, mesh.node, kind, rows, cells)


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


def _check_jacobians(where, node, kind, rows, cells):
    gradient = shape_functions(kind, quadrature(kind)[0])[1]
    for start in range(0, len(cells), _BATCH):
        batch = slice(start, start + _BATCH)
        volume = np.linalg.det(np.einsum("evx,qvr->eqxr", node[cells[batch]], gradient, optimize=True)).min(axis=1)
        bad = np.flatnonzero(volume <= 0)
        if len(bad):
            number = rows[start + bad[0]]
            raise ConfigError(where, "positive Jacobians", f"element {number} ({kind}, counted from 0) with"
                              f" {volume[bad[0]]:.3g}",
                              "check the order of its vertices, and mid-side nodes far off their edges")
