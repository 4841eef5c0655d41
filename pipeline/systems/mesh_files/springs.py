"""Springs of a deck between the bodies of a brake, as joints."""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, first_of
from pipeline.systems.mesh_files.bodies import bodies_of_decks
from pipeline.systems.solids import Rows


def deck_springs(parameters, names, meshes):
    """([name], (s,) stiffness N/m, Rows) of the springs whose ends belong to bodies from one deck.

    ``names`` and ``meshes``: of all bodies. Raises ConfigError for a spring along a line of no length.
    """
    found = [(spring, [(names.index(body), node) for body, node in ends])
             for _, spring, ends in _springs(parameters) if None not in ends]
    rows = [_row(spring, ends, meshes) for spring, ends in found]
    parts = tuple(scipy.sparse.vstack([row[k] for row in rows], format="csr") if rows else
                  scipy.sparse.csr_matrix((0, 3 * len(mesh.node))) for k, mesh in enumerate(meshes))
    return [f"spring_{s.name}" for s, _ in found], np.array([s.stiffness for s, _ in found]), Rows(parts)


def unread_springs(parameters):
    """Sentences on springs with an end in none of the bodies, which are left out."""
    lost = {}
    for file, spring, ends in _springs(parameters):
        if None in ends:
            lost.setdefault(file.name, []).append(spring.name)
    return tuple(f"{file}: not read: springs that end outside the bodies: {first_of(names, 8)}"
                 for file, names in lost.items())


def _springs(parameters):
    """Yield (file, Spring, [(body, row of its mesh) or None of each end]) of all decks."""
    for file, held in bodies_of_decks(parameters).items():
        for k, spring in enumerate(next(iter(held.values())).springs):
            yield file, spring, [_end(held, k, end) for end in range(len(spring.nodes))]


def _end(held, spring, end):
    """(body, row of its mesh) of an end of a spring; None where it is in none."""
    return next(((body, each.springs[spring].nodes[end]) for body, each in held.items()
                 if each.springs[spring].nodes[end] >= 0), None)


def _row(spring, ends, meshes):
    """[(1, 3n)] of each body: elongation of a Spring between ``ends`` [(body, node)]."""
    places = [meshes[body].node[node] for body, node in ends]
    if spring.freedoms:
        directions = [np.eye(3)[spring.freedoms[k if len(spring.freedoms) > 1 else 0]] for k in range(len(ends))]
    else:
        line = places[-1] - places[0]
        if not np.linalg.norm(line) > 0:
            raise ConfigError(f"spring {spring.name}", "a line between its ends", "ends in one place",
                              "write it as SPRING2 with its degrees of freedom")
        directions = [-line / np.linalg.norm(line)] * 2
    row = [np.zeros((1, 3 * len(mesh.node))) for mesh in meshes]
    for sign, (body, node), direction in zip((1, -1), ends, directions, strict=False):
        row[body][0, 3 * node:3 * node + 3] += sign * direction
    return [scipy.sparse.csr_matrix(part) for part in row]
