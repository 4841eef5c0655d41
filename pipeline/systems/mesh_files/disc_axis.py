"""The axis that a disc from a mesh file turns about, by the second moments of its volume."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.axes import file_axes, names_of
from pipeline.physics.fem.reference_cells import by_kind, quadrature, shape_functions

#: second moments of a body of revolution across its axis agree within this share
_ROUND = 0.05
#: most that the axis may lie off z: angle in degrees, distance as a share of the outer radius
_TILT, _OFF = 1.0, 0.01


def turning_axis(mesh):
    """(centre (3,), unit vector (3,)) of the axis of a Mesh that is a body of revolution, or has holes and vanes in
    equal steps; None where two of its second moments do not agree."""
    weight, centre, square = 0.0, np.zeros(3), np.zeros((3, 3))
    for kind, _, cells in by_kind(mesh.kind, mesh.element):
        points, weights = quadrature(kind)
        shape, gradient = shape_functions(kind, points)
        corner = mesh.node[cells]
        size = weights * np.linalg.det(np.einsum("evx,qvr->eqxr", corner, gradient, optimize=True))
        place = np.einsum("qv,evx->eqx", shape, corner)
        weight += size.sum()
        centre += np.einsum("eq,eqx->x", size, place)
        square += np.einsum("eq,eqx,eqy->xy", size, place, place, optimize=True)
    centre /= weight
    moment, vector = np.linalg.eigh(square / weight - np.outer(centre, centre))
    apart = np.diff(moment) / moment[1:]
    if apart.min() > _ROUND or apart.max() < _ROUND:
        return None
    axis = vector[:, 2 if apart[0] < apart[1] else 0]
    return centre, axis * np.sign(axis[np.argmax(abs(axis))])


def refuse_other_axis(mesh, named):
    """ConfigError for a Mesh of the disc that does not turn about z, with the setting that turns its file.

    ``named``: axes of the file that are x, y, z in ``mesh``, none for the same.
    """
    found = turning_axis(mesh)
    if found is None:
        return
    centre, axis = found
    most = int(np.argmax(abs(axis)))
    tilt = np.degrees(np.arccos(min(abs(axis[most]), 1.0)))
    where, expected = "structure.disc.mesh_file", "a disc that turns about the axis z"
    if tilt > _TILT:
        raise ConfigError(where, expected, f"one that turns about ({', '.join(f'{c:.3g}' for c in axis)}),"
                          f" {tilt:.3g} degrees off {'xyz'[most]}", "turn the mesh and write it again")
    if most != 2:
        given = file_axes(named) if named else np.eye(3)
        about = next(name.removeprefix("-") for name in names_of(given[most:most + 1]))
        ways = [", ".join(names_of(np.array(rows) @ given)) for rows in _ways(most)]
        raise ConfigError(where, expected, f"one that turns about {about}", f"write structure.disc.mesh_axes:"
                          f" [{ways[0]}], or [{ways[1]}] where the mounting face looks the other way"
                          " (structure.mesh_axes of a deck of several bodies), or turn the mesh")
    reach = np.hypot(*(mesh.node[:, :2] - centre[:2]).T).max()
    if np.hypot(*centre[:2]) > _OFF * reach:
        raise ConfigError(where, expected, f"one that turns about a line through ({centre[0]:.4g}, {centre[1]:.4g}) m",
                          "move the mesh so that it turns about z")


def _ways(axis):
    """Two rotations (3, 3) that bring an ``axis``, 0 or 1, to z: in one direction and in the other."""
    x, y, z = np.eye(3)
    return ((y, z, x), (y, -z, -x)) if axis == 0 else ((z, x, y), (z, -x, -y))
