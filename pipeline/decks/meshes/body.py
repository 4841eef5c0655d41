"""One body from the mesh file of any program: its mesh and materials in SI units, and what was not read."""

import re
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.includes import following, read_lines
from pipeline.decks.meshes import abaqus, ansys, groups, nastran
from pipeline.decks.meshes.axes import file_axes
from pipeline.physics.fem.mesh import Mesh
from pipeline.physics.fem.mesh_file import LENGTH, check, read_mesh, unchecked

#: ending of a deck -> its reader; meshio reads all others
READERS = {".inp": abaqus.read, ".cdb": ansys.read, **dict.fromkeys((".bdf", ".nas", ".fem"), nastran.read)}
#: system of units -> (its stress in Pa, its density in kg/m^3)
_UNITS = {"SI": (1.0, 1.0), "mm-t-s": (1e6, 1e12), "mm-kg-ms": (1e9, 1e9)}
#: densities [kg/m^3] and Young's moduli [Pa] of parts of a brake, from foams and rubbers to tungsten and ceramics
_DENSITIES, _MODULI = (100.0, 25e3), (1e5, 2e12)
#: digits of unit vectors to which elements have the same axes
_DIGITS = 9


@dataclass(frozen=True)
class MeshedBody:
    """Mesh [m], ``materials`` in SI units that its elements have, ``element_material`` (e,) rows of them or -1 where
    the file says none, and ``notes``: sentences on what the file holds and was not read.

    Named groups, in capitals: ``node_sets`` and ``element_sets`` {name: rows of the mesh}, ``surfaces`` {name: (f, v)
    nodes of faces, or (k, 1) nodes}; ``ties`` ((name, faces (f, v), faces (g, w)), ...) between parts of the body;
    ``springs``: all Springs [N/m] of the deck, with rows of the mesh as nodes, -1 for nodes of others.
    """

    mesh: Mesh
    materials: tuple
    element_material: np.ndarray
    notes: tuple
    node_sets: dict = field(default_factory=dict)
    element_sets: dict = field(default_factory=dict)
    surfaces: dict = field(default_factory=dict)
    ties: tuple = ()
    springs: tuple = ()
    known: tuple = ()       # names of all materials of the deck


def read_body(path, units="SI", sets=(), axes=()):
    """MeshedBody of a file, or of the elements in ``sets`` of it, names of sets of elements.

    A file is a deck of Abaqus or CalculiX (.inp), Nastran (.bdf) or Ansys (.cdb), a .dat of one of them, or what meshio
    reads, of which the whole is taken. ``units``: one of the systems of ``mesh_file.LENGTH``. ``axes``: those of the
    file that become x, y and z, as ``axes.file_axes`` names them; none = as they are. Raises ConfigError for what
    cannot be read, what no body can be made of, and for sizes, densities and moduli that no part of a brake has.
    """
    path = Path(path)
    files = (path, *following(path))
    state = tuple((str(file), file.stat().st_mtime_ns, file.stat().st_size) for file in files)
    return _turned(path, units, tuple(each.upper() for each in sets), tuple(axes), state)


@lru_cache(maxsize=8)
def _turned(path, units, sets, axes, state):
    """The body with its axes as those of the program."""
    body = _read(path, units, sets, state)
    if not axes:
        return body
    rows = file_axes(axes)
    materials = tuple(material if material.young is None or material.isotropic else replace(
        material, axes=(np.eye(3) if material.axes is None else material.axes) @ rows.T) for material in body.materials)
    springs = tuple(_turned_spring(path, spring, rows) for spring in body.springs)
    return replace(body, mesh=replace(body.mesh, node=body.mesh.node @ rows.T), materials=materials, springs=springs)


def _turned_spring(path, spring, rows):
    """The Spring along the axes ``rows`` (3, 3) of the program; ConfigError for one between axes of unlike signs."""
    place = [int(np.argmax(abs(rows[:, freedom]))) for freedom in spring.freedoms]
    if len({rows[new, old] for new, old in zip(place, spring.freedoms, strict=True)}) > 1:
        raise ConfigError(f"mesh file {path}: spring {spring.name}", "degrees of freedom whose axes mesh_axes turns"
                          " alike", f"{[freedom + 1 for freedom in spring.freedoms]}", "turn the mesh in the deck")
    return replace(spring, freedoms=tuple(place))


@lru_cache(maxsize=8)
def _read(path, units, sets, state):
    """The body; ``state`` of its files makes what changed read again."""
    deck, where = _deck(path, state), f"mesh file {path}"
    if deck is None and sets:
        raise ConfigError(where, "a deck of Abaqus, Nastran or Ansys, of which sets of elements can be taken",
                          path.suffix, "write a file for each body, or one deck of all")
    if deck is None:
        mesh, named, notes = read_mesh(path, units)
        return MeshedBody(mesh, (), np.full(len(mesh.element), -1), notes, {},
                          {name: rows for name, rows in named.items() if rows.ndim == 1},
                          {name: faces for name, faces in named.items() if faces.ndim == 2})
    blocks = _chosen(deck, sets, where)
    labels = np.concatenate([numbers for _, numbers, _ in blocks] or [np.empty(0, int)])
    mesh, used = unchecked(where, deck.node, [(kind, rows) for kind, _, rows in blocks], units)
    nodes = deck.label[used]
    surfaces = groups.surfaces(deck, mesh, labels, nodes)
    ties, notes = _ties(deck, mesh, surfaces)
    check(mesh, where + f", {' and '.join(sets)}" * bool(sets), labels, [faces for _, *faces in ties])
    materials, row = _materials(deck, labels)
    return MeshedBody(mesh, tuple(_in_si(where, material, units) for material in materials), row, deck.notes + notes,
                      {name: groups.rows_of(nodes, numbers) for name, numbers in deck.node_sets.items()},
                      {name: groups.rows_of(labels, numbers) for name, numbers in deck.element_sets.items()},
                      surfaces, ties, _springs(deck, nodes, LENGTH[units] * _UNITS[units][0]),
                      tuple(deck.materials))


@lru_cache(maxsize=2)
def _deck(path, _state):
    """The deck; None for what meshio reads."""
    reader = _reader(path)
    return None if reader is None else reader(path)


def _chosen(deck, sets, where):
    """Blocks of the elements in ``sets``, all without any; ConfigError for sets without solid elements."""
    if not sets:
        return deck.blocks
    kept = np.empty(0, np.int64)
    solid = np.concatenate([numbers for _, numbers, _ in deck.blocks] or [kept])
    for name in sets:
        members = np.intersect1d(deck.element_sets.get(name, kept), solid)
        if not len(members):
            known = [each for each, numbers in deck.element_sets.items() if np.isin(numbers, solid).any()]
            raise ConfigError(where, f"sets of solid elements, of {', '.join(known) or 'which it has none'}",
                              repr(name), "name sets, or instances, of the file")
        kept = np.union1d(kept, members)
    chosen = [(kind, np.isin(numbers, kept), numbers, rows) for kind, numbers, rows in deck.blocks]
    return [(kind, numbers[of], rows[of]) for kind, of, numbers, rows in chosen if of.any()]


def _springs(deck, labels, force):
    """Springs of the deck in N/m, at rows of ``labels`` (n,), ascending; ``force``: N/m of its unit of stiffness."""
    order, made = np.argsort(labels), []
    for spring in deck.springs:
        place = np.minimum(np.searchsorted(labels, spring.nodes, sorter=order), len(labels) - 1)
        rows = np.where(labels[order[place]] == spring.nodes, order[place], -1)
        made.append(replace(spring, nodes=tuple(int(row) for row in rows), stiffness=force * spring.stiffness))
    return tuple(made)


def _ties(deck, mesh, surfaces):
    """(ties between parts of the body, sentences on those with other bodies, which are not taken)."""
    held, notes = [], []
    for name, *pair in deck.ties:
        faces = [groups.faces_of(mesh, surfaces[each]) for each in pair]
        if all(map(len, faces)):
            held.append((name, *faces))
        elif any(map(len, faces)):
            notes.append(f"not read: *TIE {name} with another body")
    return tuple(held), tuple(notes)


def _reader(path):
    """Reader by the ending of a file; of .dat, which several programs write, by its content. None: meshio's."""
    if path.suffix.lower() != ".dat":
        return READERS.get(path.suffix.lower())
    text = "\n".join(read_lines(path)).upper()
    signs = {r"NBLOCK\b": ansys.read, r"\*NODE\b": abaqus.read, r"GRID\b": nastran.read}
    return next((reader for sign, reader in signs.items() if re.search(rf"^\s*{sign}", text, re.MULTILINE)), None)


def _materials(deck, labels):
    """([Material with its axes], (e,) row of each element or -1); a later section overrules an earlier one."""
    order, row, members, index = np.argsort(labels), np.full(len(labels), -1), [], {}
    for numbers, name, axes in deck.sections:
        found = order[np.minimum(np.searchsorted(labels, numbers, sorter=order), len(labels) - 1)]
        here = labels[found] == numbers
        each, which = _different(axes, here)
        for k, one in enumerate(each):
            key = name, None if one is None else one.tobytes()
            if key not in index:
                index[key] = len(members)
                members.append(replace(deck.materials[name], axes=one))
            row[found[here][which == k]] = index[key]
    used, compact = np.unique(row[row >= 0], return_inverse=True)
    row[row >= 0] = compact.reshape(-1)
    return [members[k] for k in used], row


def _different(axes, here):
    """([(3, 3) or None], (k,) row of them of each element) of the ``axes`` of a section in those ``here`` (n,) bool."""
    if axes is None or axes.ndim == 2:
        return [axes], np.zeros(np.count_nonzero(here), int)
    rows, which = np.unique(axes[here].round(_DIGITS).reshape(-1, 9), axis=0, return_inverse=True)
    return list(rows.reshape(-1, 3, 3)), which.ravel()


def _in_si(where, material, units):
    """The material in SI units; ConfigError for constants that no part has."""
    checked = [("density", material.density, _DENSITIES, "kg/m^3", 1)] * (material.density is not None)
    checked += [("Young's modulus", value, _MODULI, "Pa", 0) for value in material.young or ()]
    checked += [("shear modulus", value, _MODULI, "Pa", 0) for value in material.shear or ()]
    for name, value, (low, high), unit, column in checked:
        if low <= value * _UNITS[units][column] <= high:
            continue
        others = [each for each, factors in _UNITS.items() if low <= value * factors[column] <= high]
        raise ConfigError(f"{where}, material {material.name}", f"a {name} of {low:g} to {high:g} {unit}",
                          f"{value * _UNITS[units][column]:.4g} {unit} with mesh_units: {units}",
                          f"declare mesh_units: {' or '.join(others)}" if others else f"correct the {name}")
    scaled = material.scaled(*_UNITS[units])
    if scaled.young is not None:
        try:
            scaled.elasticity()
        except ConfigError as error:
            raise ConfigError(f"{where}, material {material.name}", error.expected, error.found) from None
    return scaled
