"""Lumped systems: masses, springs, dampers, contacts, inputs and sensors, all by name, as rows and matrices.

Every connection is a combination {coordinate: weight}, its elongation the sum of weight times coordinate. Coordinates
are mass.motion; those of grounded masses, and ``ground`` itself, stand still. A rotation counts as the way in m at a
radius of 1 m, so that weights of rotations are radii in m and torsional springs are springs at a radius of 1 m.
"""

from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from pipeline.contract.errors import ConfigError

TRANSLATIONS, ROTATIONS = ("x", "y", "z"), ("rotation", "tilt_x", "tilt_y")
GROUND = "ground"


@dataclass(frozen=True)
class Mass:
    """A rigid body that moves along ``moves``: ``mass`` kg, ``inertia`` kg m^2 about every axis; or grounded."""

    moves: tuple
    mass: float = 0.0
    inertia: float = 0.0
    grounded: bool = False


@dataclass(frozen=True)
class Spring:
    """Spring (N/m) and damper (N s/m) along ``ends``, a combination."""

    ends: dict
    stiffness: float = 0.0
    damping: float = 0.0


@dataclass(frozen=True)
class Contact:
    """Rubbing along ``tangent``; ``normal`` opens it, or ``normal_force`` N makes it a friction joint.

    ``stiffness`` N/m, None for a hard contact; ``gap``, ``lever`` in m; ``area`` m^2, None: as the stiffness asks.
    """

    tangent: dict
    normal: dict
    lateral: dict
    normal_force: float | None = None
    stiffness: float | None = None
    gap: float = 0.0
    lever: float = 1.0
    area: float | None = None


@dataclass(frozen=True)
class Gyro:
    """Polar inertia (kg m^2) of a mass that turns with the drive and tilts about the ``axes``, two coordinates."""

    axes: tuple
    polar_inertia: float


@dataclass(frozen=True)
class Coordinates:
    """Names of the free coordinates, the index of the mass of each, and the names that stand still."""

    names: tuple
    body: tuple
    still: tuple

    def row(self, combination, where):
        """(n,) of a {coordinate: weight}; ConfigError at ``where`` for an unknown name."""
        row = np.zeros(len(self.names))
        for name, weight in combination.items():
            if name in self.names:
                row[self.names.index(name)] += weight
            elif name not in self.still:
                raise self._unknown(name, where)
        return row

    def connected(self, combination, where):
        """As ``row``; ConfigError where nothing that can move is left in it."""
        row = self.row(combination, where)
        if not row.any():
            raise ConfigError(where, "two different ends, at least one of them free to move",
                              ", ".join(combination) or "none", "connect it to a coordinate of a mass, or delete it")
        return row

    def _unknown(self, name, where):
        known = (*self.names, *self.still)
        near = get_close_matches(str(name), known, 1)
        return ConfigError(where, f"a coordinate, one of {', '.join(known)}", repr(name),
                           f"did you mean '{near[0]}'?" if near else "name a mass and one of its moves, as in block.x")


def coordinates(masses, where="masses", massless=False):
    """Coordinates of ``masses`` (name -> Mass). ConfigError for unknown moves and, unless they may be ``massless``, for
    coordinates without inertia."""
    names, body, still = [], [], [GROUND]
    for index, (mass_name, mass) in enumerate(masses.items()):
        for move in mass.moves:
            if move not in (*TRANSLATIONS, *ROTATIONS):
                near = get_close_matches(str(move), (*TRANSLATIONS, *ROTATIONS), 1)
                raise ConfigError(f"{where}.{mass_name}.moves", f"of {', '.join((*TRANSLATIONS, *ROTATIONS))}",
                                  repr(move), f"did you mean '{near[0]}'?" if near else None)
            if mass.grounded:
                still.append(f"{mass_name}.{move}")
                continue
            _check_inertia(mass, move, f"{where}.{mass_name}", massless)
            names.append(f"{mass_name}.{move}")
            body.append(index)
    if not names:
        raise ConfigError(where, "a mass that can move", "none", "add one, or set grounded: false")
    return Coordinates(tuple(names), tuple(body), tuple(still))


def _check_inertia(mass, move, where, massless):
    key, unit = ("inertia", "kg m^2") if move in ROTATIONS else ("mass", "kg")
    value = getattr(mass, key)
    if not (value > 0 or (massless and value == 0)):
        raise ConfigError(f"{where}.{key}", f"above 0 {unit}, because it moves along {move}", f"{value:g} {unit}",
                          f"give it {'an inertia' if key == 'inertia' else 'a mass'}, or set grounded: true")


def mass_matrix(masses, named):
    """(n, n) of ``masses`` in the Coordinates ``named``."""
    bodies = list(masses.values())
    return np.diag([bodies[body].inertia if name.rpartition(".")[2] in ROTATIONS else bodies[body].mass
                    for name, body in zip(named.names, named.body, strict=True)])


def gyroscopic_matrix(gyros, named, where="gyros"):
    """(n, n) per rad/s of drive speed: W J on the rate of the second tilt in the first equation, minus it in turn."""
    matrix = np.zeros((len(named.names),) * 2)
    for name, gyro in gyros.items():
        first, second = (named.row({axis: 1.0}, f"{where}.{name}.axes") for axis in gyro.axes)
        matrix += gyro.polar_inertia * (np.outer(first, second) - np.outer(second, first))
    return matrix


def normal_law(contacts, where="contacts"):
    """(closure, pressure, area): one linear law and the areas (c,) that give each contact its stiffness.

    Hard contacts and friction joints alone leave the law empty. Without stated areas the law has 1 Pa/m. ConfigError
    where hard and yielding contacts mix, or where stated areas ask for different laws.
    """
    touching = {name: c for name, c in contacts.items() if c.normal_force is None}
    soft = {name: c for name, c in touching.items() if c.stiffness is not None}
    if not soft:
        return np.empty(0), np.empty(0), np.array([1.0 if c.area is None else c.area for c in contacts.values()])
    if len(soft) < len(touching):
        hard = next(name for name in touching if name not in soft)
        raise ConfigError(f"{where}.{hard}.stiffness", "a stiffness, because other contacts have one", "none",
                          "let all contacts yield, or none")
    ratios = [1.0 if c.area is None else c.stiffness / c.area for c in soft.values()]
    if not np.allclose(ratios, ratios[0], rtol=1e-9):
        raise ConfigError(f"{where}.{list(soft)[-1]}.area", f"stiffness over area {ratios[0]:g} Pa/m as in the others",
                          f"{ratios[-1]:g} Pa/m", "leave out the areas, or make them fit the stiffnesses")
    area = [c.stiffness / ratios[0] if name in soft else (1.0 if c.area is None else c.area)
            for name, c in contacts.items()]
    return np.array([0.0, 1.0]), np.array([0.0, ratios[0]]), np.array(area)


def index_of(name, known, where):
    """Place of ``name`` in ``known``; ConfigError at ``where`` with the nearest name where it is none of them."""
    if name in known:
        return list(known).index(name)
    near = get_close_matches(str(name), known, 1)
    raise ConfigError(where, f"one of {', '.join(known) or 'none that are there'}", repr(name),
                      f"did you mean '{near[0]}'?" if near else None)
