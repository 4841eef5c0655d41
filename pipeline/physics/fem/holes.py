"""Round holes through a ring: where rows of them lie, and a lattice of revolution drilled there."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.reference_cells import reference_vertices

#: width of the cells that are drilled, in diameters of the hole: wider ones soften a plate by too much (12 % at 2)
ROOM = 1.3
#: share of the room between holes that their cells may take
_CLOSEST = 0.95
#: once around a cell, its corners and the middles of its sides, clockwise, in halves of the cell
_AROUND = ((0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0))


@dataclass(frozen=True)
class HoleRows:
    """``rows`` circles of ``count`` holes each, along the axis, spread over a ring from ``inner`` to ``outer`` radius.

    Neighbouring rows are staggered. ``channels`` > 0 and ``wall``: holes lie in the middles of so many channels around,
    each behind a wall that takes the share ``wall`` of its pitch; ``channels`` is then a multiple of ``count``.
    Lengths in m.
    """

    diameter: float
    count: int
    rows: int
    inner: float
    outer: float
    channels: int = 0
    wall: float = 0.0

    @property
    def radius(self):
        """(rows,) radii of the circles."""
        return self.inner + (self.outer - self.inner) * (np.arange(self.rows) + 0.5) / self.rows

    @property
    def angle(self):
        """(rows, count) angles of the holes, ascending."""
        each, row = np.arange(self.count), np.arange(self.rows)[:, None]
        if not self.channels:
            return 2 * np.pi / self.count * (each + (row + 0.5) / self.rows)
        apart = self.channels // self.count
        return 2 * np.pi / self.channels * (each * apart + row * apart // self.rows + (1 + self.wall) / 2)

    @property
    def largest(self):
        """Largest diameter [m] whose cells leave some room between two circles, two holes and two walls."""
        free = (1 - self.wall) / self.channels if self.channels else 1 / (self.count * self.rows)
        return _CLOSEST / ROOM * min((self.outer - self.inner) / self.rows, 2 * np.pi * free * self.radius[0])

    def lines(self):
        """Radii and angles of the sides of the cells that are drilled, each ascending: ``ROOM`` diameters along the
        radius and on the innermost circle."""
        middle, half = np.unique(self.angle.round(12)), ROOM * self.diameter * np.array([-0.5, 0.5])
        return ((self.radius[:, None] + half).ravel(), (middle[:, None] + half / self.radius[0]).ravel())

    def cells(self, radius, angle):
        """(c, 2) indices of the cells between the lattice lines ``radius`` and ``angle`` that hold a hole."""
        return np.concatenate([np.stack((np.full(self.count, np.searchsorted(radius, r) - 1),
                                         np.searchsorted(angle, a) - 1), axis=1)
                               for r, a in zip(self.radius, self.angle, strict=True)])


def drilled(mesh, cells, diameter):
    """The mesh of a lattice of revolution with a hole along z through each of (c, 2) ``cells`` of radius and angle.

    Each such cell, at every height, becomes four around the hole. The arcs are parabolas through points of the circle,
    whose area is 1 % too small, and a plate is softened by 4 to 7 % more than by Kirsch's hole. Raises ConfigError for
    cells that the hole does not fit into, or of another kind than hexahedra of 20 nodes.
    """
    if mesh.kind != "hexahedron20":
        raise ConfigError("holes", "hexahedra of 20 nodes", mesh.kind)
    column = (cells[:, None] == mesh.cell[:, :2]).all(axis=2)
    chosen = column.any(axis=0)
    parent, lattice = mesh.element[chosen], mesh.cell[chosen]
    around = _Around((2 * reference_vertices(mesh.kind)).astype(int))
    element = np.empty((len(parent), *around.place.shape), int)
    element[:, around.known] = parent[:, around.parent[around.known]]
    height = 2 * lattice[:, 2, None, None] + around.up
    key = np.stack(np.broadcast_arrays(column[:, chosen].argmax(axis=0)[:, None, None], height, around.place,
                                       around.inwards), axis=-1)[:, ~around.known].reshape(-1, 4)
    _, first, number = np.unique(key, axis=0, return_index=True, return_inverse=True)
    element[:, ~around.known] = len(mesh.node) + number.reshape(len(parent), -1)
    node = around.places(mesh.node[parent], diameter)[:, ~around.known].reshape(-1, 3)[first]
    return replace(mesh, node=np.concatenate((mesh.node, node)),
                   element=np.concatenate((mesh.element[~chosen], element.reshape(-1, parent.shape[1]))),
                   cell=np.concatenate((mesh.cell[~chosen], np.repeat(lattice, 4, axis=0))))


class _Around:
    """Four cells around a hole in a cell: of each vertex, (4, 20), where it lies and which vertex of the parent it is.

    ``vertex`` (20, 3): halves along the axes of the cell, which for the four are inwards, along the side, and up.
    """

    def __init__(self, vertex):
        self.place = (2 * np.arange(4)[:, None] + vertex[:, 1]) % 8     # of _AROUND
        self.inwards, self.up = (np.broadcast_to(vertex[:, axis], self.place.shape) for axis in (0, 2))
        self.known = self.inwards == 0
        number = {tuple(at): k for k, at in enumerate(vertex.tolist())}
        table = np.array([[number.get((*at, up), -1) for up in range(3)] for at in _AROUND])
        self.parent, self.ring, self.top = table[self.place, self.up], table[:, 0], table[:, 2]

    def places(self, corner, diameter):
        """(cells, 4, 20, 3) of the vertices; ``corner`` (cells, 20, 3) [m] of the parents."""
        outer = corner[:, self.ring, :2]                                # (cells, 8, 2), the same at every height
        middle = outer[:, ::2].mean(axis=1)
        radial = middle / np.linalg.norm(middle, axis=1, keepdims=True)
        unit = np.array(_AROUND) - 1.0
        unit /= np.linalg.norm(unit, axis=1, keepdims=True)
        direction = unit @ np.stack((radial, radial[:, ::-1] * (-1, 1)), axis=1)
        circle = middle[:, None] + diameter / 2 * direction
        if (((outer - circle) * direction).sum(axis=2) <= 0).any():
            raise ConfigError("holes", "holes that fit into their cells", f"a diameter of {diameter:g} m")
        share = self.inwards[..., None] / 2
        flat = outer[:, self.place] * (1 - share) + circle[:, self.place] * share
        low, high = (corner[:, rows[0], 2, None, None, None] for rows in (self.ring, self.top))
        height = low + (high - low) * self.up[..., None] / 2
        return np.concatenate((flat, height), axis=3)
