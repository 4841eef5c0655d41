"""Axes of materials in decks, rectangular or cylindrical, and those of the program in the axes of a file."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError

#: axes of a file
_LETTERS = "xyz"


@dataclass(frozen=True)
class Axes:
    """A coordinate system: ``rows`` (3, 3), its unit vectors, about an ``origin`` (3,).

    Of a ``cylindrical`` one, the first two vectors are radial and tangential at each place, the third is its axis.
    ``further`` ((number of a vector, angle in rad), ...): turns of the vectors about one of themselves.
    """

    rows: np.ndarray
    origin: np.ndarray = (0.0, 0.0, 0.0)
    cylindrical: bool = False
    further: tuple = ()

    def at(self, place):
        """(k, 3, 3) unit vectors, as rows, at each ``place`` (k, 3); those of ``rows`` on the axis itself."""
        place = np.asarray(place, float).reshape(-1, 3)
        rows = np.broadcast_to(self.rows, (len(place), 3, 3))
        if self.cylindrical:
            away = place - self.origin
            away = away - np.outer(away @ self.rows[2], self.rows[2])
            length = np.linalg.norm(away, axis=1, keepdims=True)
            radial = np.where(length > 0, away / np.where(length > 0, length, 1.0), self.rows[0])
            rows = np.stack([radial, np.cross(self.rows[2], radial), np.tile(self.rows[2], (len(place), 1))], axis=1)
        for number, angle in self.further:
            rows = turn(number, angle) @ rows
        return rows


def turn(number, angle):
    """(3, 3) that turns three unit vectors, given as rows, by an ``angle`` in rad about that of a ``number``."""
    first, second = (number + 1) % 3, (number + 2) % 3
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = np.cos(angle)
    matrix[first, second], matrix[second, first] = np.sin(angle), -np.sin(angle)
    return matrix


def through(third, first, where):
    """(3, 3) unit vectors as rows: the third one along ``third`` (3,), the first in the plane of that and ``first``.

    Raises ConfigError at ``where`` for vectors along one line.
    """
    second = np.cross(third, first)
    if not np.linalg.norm(second) > 0:
        raise ConfigError(where, "points that span a plane", "points on one line")
    rows = np.array([np.cross(second, third), second, third], float)
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def in_elements(axes, draft, numbers, material, name):
    """Axes of a ``material`` along a system ``axes``, of this ``name`` in the deck, as of ``Draft.sections``: (3, 3),
    or of a cylindrical one, which the Draft notes, (k, 3, 3) of each of its elements ``numbers`` (k,)."""
    if not axes.cylindrical:
        return axes.at((0.0, 0.0, 0.0))[0]
    draft.notes.append(f"{material.name}: along the cylindrical axes {name}, in each element those at its middle")
    return axes.at(middles(draft, numbers))


def middles(draft, numbers):
    """(k, 3) mean of the nodes of each element of a Draft, by their ``numbers`` (k,)."""
    position = dict(zip(draft.label, draft.position, strict=True))
    nodes = {number: each for rows in draft.elements.values() for number, each in rows}
    lacking = [(0.0,) * 3]
    return np.array([np.mean([position.get(k, lacking[0]) for k in nodes[n]] if n in nodes else lacking, axis=0)
                     for n in numbers]).reshape(-1, 3)


def file_axes(names):
    """(3, 3): rows are the axes x, y, z of the program in those of a file, by their ``names``, such as y, z, x or
    -y, x, z.

    Raises ConfigError for others than three axes that make a right-handed system.
    """
    rows = np.zeros((3, 3))
    for row, name in zip(rows, names, strict=False):
        row[_LETTERS.index(name[-1])] = -1.0 if name.startswith("-") else 1.0
    if len(names) != 3 or not np.isclose(np.linalg.det(rows), 1.0):
        raise ConfigError("mesh_axes", "three axes of the file that make a right-handed system, as y, z, x do",
                          ", ".join(names), "put - before the axis that points the other way")
    return rows


def names_of(rows):
    """Names of axes for ``file_axes``: ``rows`` (3, 3) with one 1 or -1 in each row."""
    return tuple(f"{'-' if row.sum() < 0 else ''}{_LETTERS[int(np.argmax(abs(row)))]}" for row in rows)
