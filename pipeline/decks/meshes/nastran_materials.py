"""Materials of a Nastran deck, MAT1, MAT9 and MAT11, and the coordinate systems that PSOLID gives them."""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.axes import Axes, in_elements, through
from pipeline.decks.meshes.deck import whole
from pipeline.decks.meshes.material import BY_ROWS, Material, Unread, symmetric
from pipeline.decks.meshes.nastran_cards import number

#: the strains that x, y, z, xy, yz and zx are among xx, yy, zz, yz, xz, xy
_STRAINS = (0, 1, 2, 5, 3, 4)
#: materials that are not read, and what they are
_OTHERS = {"MAT2": "of shells", "MAT3": "of axisymmetric elements", "MAT8": "of shells, which holds in a plane only",
           "MAT10": "a fluid", "MAT12": "orthotropic", "MAT9OR": "orthotropic", "MAT9ORT": "orthotropic",
           "MATHE": "hyperelastic", "MATHP": "hyperelastic", "MATG": "of gaskets"}
_WRITE = "write MAT1, MAT9 or MAT11"
#: coordinate systems that are not read
_SYSTEMS = ("CORD1R", "CORD1C", "CORD1S", "CORD2S", "CORD3G")


def _named(card, draft, held):
    """The name of a new material of a card; ConfigError for a number that is taken."""
    label = whole(card.get(2), card.where)
    if label in held["materials"]:
        raise ConfigError(card.where, "each material once", f"{card.name} {label} again", "leave one of them out")
    held["materials"][label] = f"{card.name} {label}"
    return f"{card.name} {label}"


def _values(card, fields):
    """Numbers of a card in its ``fields``, None of empty ones."""
    return [number(text, card.where) if text else None for text in map(card.get, fields)]


def _damped(card, name, damping, draft):
    if damping:
        draft.notes.append(f"{name}: GE {damping:g} (structural damping) is not taken; state a loss factor")


def _mat1(card, draft, held):
    name = _named(card, draft, held)
    young, shear, poisson, density, damping = _values(card, (3, 4, 5, 6, 9))
    material, given = Material(name, density=density), (young, shear, poisson)
    if young is None and None not in (shear, poisson):
        young = 2 * (1 + poisson) * shear
    if poisson is None and young is not None and shear:
        poisson = young / (2 * shear) - 1
    if None not in (young, poisson):
        material = material.with_isotropic(young, poisson)
        if shear is not None and abs(shear / material.shear[0] - 1) > 0.01:
            draft.notes.append(f"{name}: G {shear:g} is not E / (2 (1 + nu)); E and nu are taken")
    elif any(value is not None for value in given):
        material = replace(material, unread=Unread(card.where, f"one constant alone of {name}",
                                                   "write two of E, G, NU"))
    _damped(card, name, damping, draft)
    draft.materials[name] = material


def _mat9(card, draft, held):
    """The 21 constants of the upper triangle row by row, the density, thermal expansion and damping."""
    name = _named(card, draft, held)
    values, (density, damping) = _values(card, range(3, 24)), _values(card, (24, 32))
    matrix = symmetric([value or 0.0 for value in values], BY_ROWS, _STRAINS)
    draft.materials[name] = Material(name, density=density).with_matrix(matrix, card.where)
    _damped(card, name, damping, draft)


def _mat11(card, draft, held):
    name = _named(card, draft, held)
    values, (density, damping) = _values(card, range(3, 12)), _values(card, (12, 17))
    if None in values:
        raise ConfigError(card.where, f"E1, E2, E3, NU12, NU13, NU23, G12, G13, G23 of {name}",
                          f"{len(values) - values.count(None)} of them", "write all nine")
    e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 = values
    draft.materials[name] = Material(name, density=density).with_constants(
        (e1, e2, e3), (nu23, nu13, nu12), (g23, g13, g12))
    _damped(card, name, damping, draft)


def _other(card, draft, held, what):
    name = _named(card, draft, held)
    draft.unread[card.name] += 1
    draft.materials[name] = Material(name, unread=Unread(card.where, f"{name}, {what}", _WRITE))


def _system(card, draft, held):
    """CORD2R and CORD2C: a point on the origin, one on the third axis, one in the plane of first and third."""
    label = whole(card.get(2), card.where)
    if card.get(3) not in ("", "0"):
        held["systems"][label] = f"{card.name} {label} in the system {card.get(3)}"
        return
    origin, third, plane = np.array([value or 0.0 for value in _values(card, range(4, 13))]).reshape(3, 3)
    held["systems"][label] = Axes(through(third - origin, plane - origin, card.where), origin, card.name == "CORD2C")


def _other_system(card, draft, held):
    draft.unread[card.name] += 1
    for field in (2, 6) if card.name.startswith("CORD1") else (2,):     # two systems stand on one card of points
        if card.get(field):
            held["systems"][whole(card.get(field), card.where)] = f"{card.name} {card.get(field)}"


def axes(draft, numbers, material, system, systems, where):
    """Axes of a ``material`` in the elements ``numbers`` (k,): (3, 3), or (k, 3, 3) of each; None: those of the deck.

    ``system``: text of CORDM, the coordinate system of a PSOLID at ``where``; ``systems`` {number: Axes, or what it is
    instead}. Raises ConfigError for a material with directions along axes that are not read.
    """
    if system in ("", "0") or material.young is None or material.isotropic:
        return None
    label = whole(system, where)
    found = systems.get(label, f"a system {label} that no card defines" if label > 0 else
                        f"CORDM {label}: the axes of each element")
    if isinstance(found, str):
        raise ConfigError(where, f"axes of {material.name} that are read", found,
                          "write CORDM 0, or a CORD2R or CORD2C in the basic system")
    return in_elements(found, draft, numbers, material, label)


HANDLERS = {"MAT1": _mat1, "MAT9": _mat9, "MAT11": _mat11, "CORD2R": _system, "CORD2C": _system,
            **{name: partial(_other, what=what) for name, what in _OTHERS.items()},
            **dict.fromkeys(_SYSTEMS, _other_system)}
