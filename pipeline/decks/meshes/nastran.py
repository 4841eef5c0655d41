"""Decks of Nastran (.bdf): grid points, solid elements, PSOLID, materials and the axes that they lie along."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes import nastran_materials
from pipeline.decks.meshes.deck import BY_COUNT, Draft, listed, whole
from pipeline.decks.meshes.nastran_cards import cards, number

#: card -> (corners, all nodes)
_SOLIDS = {"CHEXA": (8, 20), "CTETRA": (4, 10), "CPENTA": (6, 15), "CPYRAM": (5, 13), "CPYRA": (5, 13)}
#: rows of Nastran's nodes, whose edges between both faces stand before those of the upper one, in the order of meshio
_ORDER = {20: (*range(12), 16, 17, 18, 19, 12, 13, 14, 15), 15: (*range(9), 12, 13, 14, 9, 10, 11)}


def read(path):
    """Deck of the file at ``path``; raises ConfigError for what cannot be read as a mesh, with file and line."""
    draft, properties, held = Draft(f"mesh file {path}"), {}, {
        "psolid": {}, "materials": {}, "systems": {}, "scale": 1.0}
    head, members = cards(path)
    for card in members:
        if card.name in _SOLIDS:
            _solid(card, draft, properties)
        elif card.name in _HANDLERS:
            _HANDLERS[card.name](card, draft, held)
        else:
            draft.unread[card.name] += 1
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


def _psolid(card, draft, held):
    """PSOLID, or PLSOLID, whose law is not linear."""
    number_of, material = whole(card.get(2), card.where), whole(card.get(3), card.where)
    if number_of in held["psolid"]:
        raise ConfigError(card.where, f"each {card.name} once", f"{card.name} {number_of} again",
                          "leave one of them out")
    held["psolid"][number_of] = material, card.where, card.get(4) if card.name == "PSOLID" else ""


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
        material, where, system = held["psolid"][number_of]
        if material not in held["materials"]:
            raise ConfigError(where, "a material that the deck defines", f"{material}",
                              "write MAT1, MAT9 or MAT11, or include the file that has it")
        name, numbers = held["materials"][material], np.array(labels, np.int64)
        axes = nastran_materials.axes(draft, numbers, draft.materials[name], system, held["systems"], where)
        draft.sections.append((numbers, name, axes))


_HANDLERS = {"GRID": _grid, "GRDSET": _grdset, "PSOLID": _psolid, "PLSOLID": _psolid, "PARAM": _param,
             **nastran_materials.HANDLERS}
