"""Rows and matrices of what connects the coordinates of a lumped system.

An angle, a combination of rotations with numbers as weights, counts as the way at a radius of 1 m: torsional
stiffnesses and torques of it have the size of stiffnesses and forces there.
"""

import numpy as np

from pipeline.contract import ConfigError
from pipeline.contract.units import to_si
from pipeline.systems.lumped import ROTATIONS


def rotates(coordinate):
    """Whether a coordinate mass.motion is a rotation."""
    return coordinate.rpartition(".")[2] in ROTATIONS


def is_angle(combination):
    """Whether a {coordinate: weight} consists of rotations with numbers as weights."""
    return bool(combination) and all(rotates(c) and not isinstance(w, str) for c, w in combination.items())


def sees_angle(combination):
    """Whether a {coordinate: weight} is an angle: numbers, or radii the largest of which is 1 m."""
    rotations = all(map(rotates, combination))
    return rotations and (is_angle(combination) or max(map(abs, weights(combination, "").values())) == 1)


def weights(combination, where, angles=True):
    """{coordinate: weight} with numbers for translations and radii in m for rotations, or numbers of an angle.

    Raises ConfigError for rotations without a radius beside translations, or where there must be a way
    (``angles`` False).
    """
    if angles and is_angle(combination):
        return {name: float(weight) for name, weight in combination.items()}
    return {name: to_si(weight, "m" if rotates(name) else "1", f"{where}.{name}")
            for name, weight in combination.items()}


def connected(coordinates, combination, where):
    """Row (n,) of a {coordinate: weight} that can move."""
    return coordinates.connected(weights(combination, where), where)


def row_along(coordinates, combination, torsional, where):
    """Row (n,) of what acts along a combination; ConfigError where torques meet ways, or forces angles."""
    if torsional and not is_angle(combination):
        raise ConfigError(where, "rotations alone with numbers as weights, for torques and angles",
                          ", ".join(f"{c}: {w}" for c, w in combination.items()) or "none")
    if is_angle(combination) and not torsional:
        raise ConfigError(where, "values of torques and angles (torsional_stiffness, torque, inertia) along rotations"
                          " alone", "those of forces and ways", "change the key, or state radii in m")
    return connected(coordinates, combination, f"{where}.along")


def rows(read, coordinates):
    """(r, n) of rows; none of no rows."""
    return np.reshape(read, (len(read), len(coordinates.names)))


def joint_fields(springs, pendulums, coordinates):
    """Name, rows (j, n), stiffness and damping of the sections of springs and of pendulums, as Lumped has them."""
    both = [name for name in pendulums if name in springs]
    if both:
        raise ConfigError(f"lumped.pendulums.{both[0]}", "a name that no spring has", both[0])
    read = [_spring_row(spring, coordinates, f"lumped.springs.{name}") for name, spring in springs.items()]
    read += [row_along(coordinates, p.swings, True, f"lumped.pendulums.{name}") for name, p in pendulums.items()]
    stiffness = [s.torsional_stiffness or s.stiffness for s in springs.values()]
    damping = [s.torsional_damping or s.damping for s in springs.values()]
    return {"joint_name": [*springs, *pendulums], "joint_rows": rows(read, coordinates),
            "joint_stiffness": [*stiffness, *(p.mass * p.gravity * p.length for p in pendulums.values())],
            "joint_damping": [*damping, *(0.0 for _ in pendulums)]}


def inertia_matrix(inertias, coordinates):
    """(n, n) that sections Inertia add: mass times the outer product of the row along which it moves."""
    matrix = np.zeros((len(coordinates.names),) * 2)
    for name, given in inertias.items():
        where = f"lumped.inertias.{name}"
        if (given.mass is None) == (given.inertia is None):
            raise ConfigError(where, "either mass, or inertia where rotations alone move it",
                              "neither" if given.mass is None else "both")
        row = row_along(coordinates, given.along, given.inertia is not None, where)
        matrix += (given.mass or given.inertia) * np.outer(row, row)
    return matrix


def turning(settings):
    """Names of joints, inputs and masses that act about an axis, of a section ``lumped``."""
    torsional = {name for name, spring in settings.springs.items() if is_torsional(spring)} | set(settings.pendulums)
    inputs = [name for name, given in settings.inputs.items() if given.torque is not None or given.angle is not None]
    masses = [name for name, mass in settings.masses.items()
              if len(mass.moves) == 1 and mass.moves[0] in ROTATIONS and not mass.grounded]
    return sorted([*(f"joints.{n}" for n in torsional), *(f"inputs.{n}" for n in inputs),
                   *(f"masses.{n}" for n in masses)])


def is_torsional(spring):
    """Whether a section Spring states what acts about an axis."""
    return spring.torsional_stiffness is not None or spring.torsional_damping is not None


def _spring_row(spring, coordinates, where):
    if (spring.between is None) == (spring.along is None):
        raise ConfigError(where, "either between or along", "both" if spring.between else "neither",
                          "name what the spring connects, as in between: [block.x, ground]")
    if is_torsional(spring) and (spring.stiffness or spring.damping):
        raise ConfigError(where, "torsional_stiffness and torsional_damping, or stiffness and damping", "both")
    if spring.along is not None:
        return row_along(coordinates, spring.along, is_torsional(spring), where)
    first, second = spring.between
    if is_torsional(spring) and not all(rotates(end) or end == "ground" for end in spring.between):
        raise ConfigError(where, "ends that rotate, for a torsional spring", " and ".join(spring.between))
    row = coordinates.row({first: 1.0}, f"{where}.between") - coordinates.row({second: 1.0}, f"{where}.between")
    return row if row.any() else coordinates.connected({}, f"{where}.between")
