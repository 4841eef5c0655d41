"""Decks of Nastran (.bdf): grid points, solid elements, PSOLID and MAT1."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.deck import BY_COUNT, Draft, listed, whole
from pipeline.decks.meshes.material import Material
from pipeline.decks.meshes.nastran_cards import cards, number

#: card -> (corners, all nodes)
_SOLIDS = {"CHEXA": (8, 20), "CTETRA": (4, 10), "CPENTA": (6, 15), "CPYRAM": (5, 13), "CPYRA": (5, 13)}
#: rows of Nastran's nodes, whose edges between both faces stand before those of the upper one, in the order of meshio
_ORDER = {20: (*range(12), 16, 17, 18, 19, 12, 13, 14, 15), 15: (*range(9), 12, 13, 14, 9, 10, 11)}
#: materials and properties of solids that are not read; a PSOLID may name one
_OTHERS = ("MAT3", "MAT9", "MAT10", "MAT11")


def read(path):
    """Deck of the file at ``path``; raises ConfigError for what cannot be read as a mesh, with file and line."""
    draft, properties, held = Draft(f"mesh file {path}"), {}, {"psolid": {}, "others": set(), "scale": 1.0}
    head, members = cards(path)
    for card in members:
        if card.name in _SOLIDS:
            _solid(card, draft, properties)
        elif card.name in _HANDLERS:
            _HANDLERS[card.name](card, draft, held)
        else:
            draft.unread[card.name] += 1
            if card.name in _OTHERS:
                held["others"].add(whole(card.get(2), card.where))
    if head:
        draft.unread[f"executive and case control: {', '.join(_words(head))}"] += 1
    _sections(draft, properties, held)
    return draft.deck()


def _words(lines, most=12):
    """First words of ``lines``, each once."""
    words = list(dict.fromkeys(re.match(r"\W*\w*", line)[0].strip().upper() for line in lines))
    return words[:most] + ["..."] * (len(words) > most)


def _grid(card, draft, held):
    if card.get(3) not in ("", "0"):
        raise ConfigError(card.where, "grid points in the basic coordinate system (CP 0)", f"CP {card.get(3)} of GRID"
                          f" {card.get(2)}", "write the nodes in the basic system")
    draft.label.append(whole(card.get(2), card.where))
    draft.position.append(tuple([number(text, card.where) if text else 0.0 for text in map(card.get, (4, 5, 6))]))
    for name, text in (("CD (axes of displacements) of GRID", card.get(7)), ("PS (supports) of GRID", card.get(8))):
        if text not in ("", "0"):
            draft.unread[name] += 1


def _grdset(card, draft, held):
    if card.get(3) not in ("", "0"):
        raise ConfigError(card.where, "grid points in the basic coordinate system (CP 0)",
                          f"CP {card.get(3)} of GRDSET", "write the nodes in the basic system")
    draft.unread["GRDSET"] += 1


def _solid(card, draft, properties):
    corners, count = _SOLIDS[card.name]
    label = whole(card.get(2), card.where)
    nodes = [whole(text, card.where) if text else 0 for text in card.fields[2:]]
    given = len([node for node in nodes if node > 0])
    if any(nodes[count:]) or given not in (corners, count) or not all(nodes[:corners]):
        raise ConfigError(card.where, f"{corners} or {count} nodes of {card.name} {label}", f"{given} nodes",
                          "write mid-side nodes on all edges, and continue the card where a line is full")
    order = _ORDER.get(given, range(given))
    draft.add_element(BY_COUNT[given], label, [nodes[k] for k in order])
    properties.setdefault(whole(card.get(3) or card.get(2), card.where), []).append(label)


def _mat1(card, draft, held):
    name = f"MAT1 {whole(card.get(2), card.where)}"
    if name in draft.materials:
        raise ConfigError(card.where, "each material once", f"{name} again", "leave one of them out")
    young, shear, poisson, density, damping = (number(text, card.where) if text else None
                                               for text in map(card.get, (3, 4, 5, 6, 9)))
    material = Material(name, density=density)
    if young is None and None not in (shear, poisson):
        young = 2 * (1 + poisson) * shear
    if poisson is None and young is not None and shear:
        poisson = young / (2 * shear) - 1
    if None not in (young, poisson):
        material = material.with_isotropic(young, poisson)
        if shear is not None and abs(shear / material.shear[0] - 1) > 0.01:
            draft.notes.append(f"{name}: G {shear:g} is not E / (2 (1 + nu)); E and nu are taken")
    if damping:
        draft.notes.append(f"{name}: GE {damping:g} (structural damping) is not taken; state a loss factor")
    draft.materials[name] = material


def _psolid(card, draft, held):
    number_of, material = whole(card.get(2), card.where), whole(card.get(3), card.where)
    if number_of in held["psolid"]:
        raise ConfigError(card.where, "each PSOLID once", f"PSOLID {number_of} again", "leave one of them out")
    held["psolid"][number_of] = material, card.where


def _param(card, draft, held):
    if card.get(2).upper() == "WTMASS":
        held["scale"] = number(card.get(3), card.where)
        draft.notes.append(f"PARAM WTMASS {held['scale']:g}: densities are multiplied by it")
    else:
        draft.unread[f"PARAM {card.get(2).upper()}"] += 1


def _sections(draft, properties, held):
    """Sets of the elements of each property, and the materials of PSOLID."""
    draft.materials = {name: material.scaled(1.0, held["scale"]) for name, material in draft.materials.items()}
    lacking = {} if not held["psolid"] else {key: each for key, each in properties.items() if key not in held["psolid"]}
    if lacking:
        draft.notes.append(f"{sum(map(len, lacking.values()))} elements of {listed('PID', lacking)}, which no PSOLID"
                           " gives")
    for number_of, labels in properties.items():
        draft.element_sets[f"PROPERTY {number_of}"] = labels
        if number_of not in held["psolid"]:
            continue
        material, where = held["psolid"][number_of]
        if f"MAT1 {material}" in draft.materials:
            draft.sections.append((np.array(labels, np.int64), f"MAT1 {material}", None))
        elif material in held["others"]:
            draft.notes.append(f"PSOLID {number_of} names material {material}, which is none of MAT1 and is not read")
        else:
            raise ConfigError(where, "a material that the deck defines", f"{material}",
                              "write MAT1, or include the file that has it")


_HANDLERS = {"GRID": _grid, "GRDSET": _grdset, "MAT1": _mat1, "PSOLID": _psolid, "PARAM": _param}
