"""Where the points of a modal test lie on the meshes of a model, and which motion each of its responses shows."""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract import ConfigError, Quantities, Section, option

#: largest distance of a point from the nearest node, as a share of the size of the body
_FAR = 0.05
#: power of i w by which the motion of a response is the derivative of a displacement
_ORDER = {"m": 0, "m/s": 1, "m/s^2": 2}


class Point(Section):
    """A point of the modal test on the body, in the axes of the model."""

    place: str = option(..., "name of the point in the responses, as in 'node 12'")
    position: Quantities("m") = option(..., "x, y and z; the disc turns about z, pads are centred on x", min_length=3,
                                       max_length=3)
    direction: tuple[float, ...] = option((), "x, y and z of the measured direction, where the place of the response"
                                          " names none ('direction 3' is z)", max_length=3)
    body: str | None = option(None, "body of an assembled brake that it lies on, such as pad_outer")


@dataclass(frozen=True)
class Rows:
    """Responses that a model can show: their ``index`` (n,) in the test, motions of nodes that response and reference
    are, ``moved`` and ``struck`` (n, 3 nodes) sparse, ``order`` (n,) of the derivative, and the ``distance`` (n,) m of
    the farther node; ``struck`` is None where the references are unknown and all the same."""

    index: np.ndarray
    moved: object
    struck: object
    order: np.ndarray
    distance: np.ndarray

    def products(self, shape):
        """(n, k (k+1)/2) of shapes (3 nodes, k): residues, to a factor, of all mixtures of these modes."""
        moved = self.moved @ shape
        if self.struck is None:
            return moved
        struck = self.struck @ shape
        first, second = np.triu_indices(moved.shape[1])
        return 0.5 * (moved[:, first] * struck[:, second] + moved[:, second] * struck[:, first])

    def of_shown(self):
        """Rows of the same responses on shapes that hold their motions alone, those of the references below."""
        count = len(self.index)
        parts = 1 if self.struck is None else 2
        moved, struck = (scipy.sparse.eye(count, parts * count, k, format="csr") for k in (0, count))
        return replace(self, moved=moved, struck=struck if parts == 2 else None)


def refuse_unplaced(points, bodies, where):
    """ConfigError where points lie on none of ``bodies``, or on one of several that is not named."""
    for point in points:
        if point.body not in (*bodies, *((None,) if len(bodies) == 1 else ())):
            raise ConfigError(f"{where}.points: {point.place}.body", f"one of {', '.join(bodies)}",
                              "none" if point.body is None else point.body)


def rows(points, places, references, units, nodes, where, far=_FAR):
    """Rows of responses at ``places`` per ``references``, in ``units``; None without points.

    ``nodes`` {body: (k, 3)}, degrees of freedom in the order of the bodies. Raises ConfigError for points off their
    body, further than the share ``far`` of its size from its nodes, and for responses without a direction.
    """
    if not points:
        return None
    refuse_unplaced(points, tuple(nodes), where)
    meshes, first = {}, 0
    for body, each in nodes.items():
        meshes[body] = _Mesh(scipy.spatial.cKDTree(each), far * np.ptp(each, axis=0).max(), first)
        first += 3 * len(each)
    known = {point.place: (point, meshes[point.body or next(iter(nodes))]) for point in points}
    found = [_row(known, str(place), where) for place in places]
    struck = [_row(known, str(reference), where) for reference in references]
    index = [i for i, row in enumerate(found) if row is not None]
    if index and any(struck[i] is None for i in index):
        first_reference = str(references[index[0]])
        index, struck = [i for i in index if str(references[i]) == first_reference], None
    if not index:
        raise ConfigError(f"{where}.points", f"places of the responses: {', '.join(map(str, places[:6]))}",
                          ", ".join(known), "a place is named as in the file, without its direction")
    order = [_ORDER.get(str(units[i]).split("/N")[0].split("*")[0], 0) for i in index]
    distance = [max(found[i][1], struck[i][1] if struck else 0.0) for i in index]
    parts = [_stacked([each[i][0] for i in index], first) if each else None for each in (found, struck)]
    return Rows(np.array(index), *parts, np.array(order), np.array(distance))


@dataclass(frozen=True)
class _Mesh:
    """Nodes of a body, the most that a point may be off them in m, and its first degree of freedom."""

    tree: object
    reach: float
    first: int


def _row(known, name, where):
    """(([degrees of freedom], [weights]), distance in m) of a place such as 'node 12 direction -3'; None if unknown."""
    place, _, code = name.partition(" direction ")
    if place not in known:
        return None
    point, mesh = known[place]
    direction = np.array(point.direction, float)
    if code.lstrip("-") in ("1", "2", "3"):
        direction = np.where(np.arange(3) == int(code.lstrip("-")) - 1, -1.0 if code.startswith("-") else 1.0, 0.0)
    size = np.linalg.norm(direction)
    if direction.shape != (3,) or not size > 0:
        raise ConfigError(f"{where}.points: {place}", "a direction of three numbers, not all 0, or one that its place"
                          " names", f"{name!r} and {list(point.direction)}")
    distance, node = mesh.tree.query(point.position)
    if distance > mesh.reach:
        raise ConfigError(f"{where}.points: {place}", f"a point of the body, within {mesh.reach:.2g} m of a"
                          " node", f"one {distance:.2g} m away", "positions are in m, in the axes of the model")
    return (mesh.first + 3 * node + np.arange(3), direction / size), float(distance)


def _stacked(found, columns):
    freedoms, weights = (np.array(each) for each in zip(*found, strict=True))
    row = np.repeat(np.arange(len(freedoms)), 3)
    return scipy.sparse.csr_matrix((weights.ravel(), (row, freedoms.ravel())), shape=(len(freedoms), columns))
