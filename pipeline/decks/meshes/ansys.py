"""Archives of Ansys (.cdb, as CDWRITE writes them, and inputs of Workbench): nodes, SOLID186 and SOLID187, components,
materials."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes import ansys_materials
from pipeline.decks.meshes.ansys_blocks import commands
from pipeline.decks.meshes.deck import Draft, span, whole

#: element types by their number: nodes of those of second order, and those of first order
_SECOND, _FIRST = {186: 20, 95: 20, 187: 10, 92: 10}, {185: "hexahedron", 45: "hexahedron", 285: "tetra"}
#: nodes in the lines of each type
_NODES = _SECOND | {185: 8, 45: 8, 285: 4}
#: rows of a collapsed hexahedron's nodes in the order of meshio
_COLLAPSED = {"hexahedron20": range(20), "wedge15": (0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18),
              "tetra10": (0, 1, 2, 4, 8, 9, 11, 16, 17, 18)}
#: commands that make nodes and elements, or take them from elsewhere
_GENERATORS = {"NGEN", "EGEN", "VMESH", "VSWEEP", "E", "EN", "EMORE", "/INPUT", "*DO", "*USE", "CDREAD"}
#: commands that say nothing of the body
_HOLLOW = {"/PREP7", "/COM", "/NOPR", "/TITLE", "/GO", "/GOPR", "/BATCH", "FINISH", "FINI", "NUMOFF", "MPTEMP", "/EOF"}
#: commands that say what the elements after them have: their number, 1 before any
_CURRENT = ("TYPE", "MAT", "ESYS")


def read(path):
    """Deck of the file at ``path``; raises ConfigError for what cannot be read as a mesh, with file and line."""
    draft = Draft(f"mesh file {path}")
    held = {"types": {}, "elements": {}, "current": {"TYPE": 1, "MAT": 1, "ESYS": 0}, **ansys_materials.empty()}
    for command in commands(path):
        if command.name in _GENERATORS or (command.name == "N" and command.get(0)[:1].isdigit()):
            raise ConfigError(command.where, "a mesh that is written out in blocks", command.name,
                              "write it with CDWRITE,DB and blocked format")
        if command.name in _HANDLERS:
            _HANDLERS[command.name](command, draft, held)
        elif command.name not in (*_HOLLOW, "N"):
            draft.unread[command.name] += 1
    ansys_materials.leave(draft, held)
    return draft.deck()


def _type(command, draft, held):
    """ET,1,186 or ET,1,SOLID186."""
    digits = re.search(r"\d+$", command.get(1))
    if digits:
        held["types"][whole(command.get(0), command.where)] = int(digits[0])


def _types(command, draft, held):
    for where, numbers, _ in command.table():
        if len(numbers) < 2:
            raise ConfigError(where, "a number and an element type", f"{len(numbers)} numbers")
        held["types"][numbers[0]] = numbers[1]


def _nodes(command, draft, held):
    for where, whole_numbers, values in command.table():
        if not whole_numbers:
            raise ConfigError(where, "a number of a node", "none")
        draft.label.append(whole_numbers[0])
        draft.position.append((*values[:3], 0.0, 0.0, 0.0)[:3])
    given = command.get(3)
    if given.isdigit() and int(given) != len(draft.label):
        raise ConfigError(command.where, f"{given} nodes, as NBLOCK says", f"{len(draft.label)}",
                          "write the file again")


def _attribute(command, draft, held):
    held["current"][command.name] = whole(command.get(0) or "1", command.where)


def _elements(command, draft, held):
    form = command.get(1).upper()
    if form not in ("SOLID", "COMPACT"):
        draft.unread["EBLOCK of surface or line elements"] += 1
        return
    count = 0
    for where, material, kind, system, label, nodes in (_compact if form == "COMPACT" else _complete)(command, held):
        count += 1
        _element(where, held["types"].get(kind), label, nodes, draft)
        held["elements"].setdefault((material, system), []).append(label)
    if command.get(3).isdigit() and int(command.get(3)) != count:
        raise ConfigError(command.where, f"{command.get(3)} elements, as EBLOCK says", f"{count}",
                          "write the file again")


def _complete(command, held):
    """Yield (where, material, type, coordinate system, number, nodes) of lines with 11 numbers before the nodes."""
    rows = command.table()
    for where, values, _ in rows:
        if len(values) < 12:
            raise ConfigError(where, "11 numbers and the nodes of an element", f"{len(values)} numbers")
        material, kind, _, _, system, _, _, _, given, _, label, *nodes = values
        while len(nodes) < given:
            nodes += next(rows, (0, (), 0))[1] or _refuse_short(where, label, given, nodes)
        yield where, material, kind, system, label, nodes


def _compact(command, held):
    """The same of lines with the number of an element and its nodes: all else is that of TYPE, MAT and ESYS before."""
    current, rows = held["current"], command.table()
    wanted = _NODES.get(held["types"].get(current["TYPE"]), 0)
    for where, (label, *nodes), _ in rows:
        while len(nodes) < wanted:
            nodes += next(rows, (0, (), 0))[1] or _refuse_short(where, label, wanted, nodes)
        yield where, current["MAT"], current["TYPE"], current["ESYS"], label, nodes


def _refuse_short(where, label, count, nodes):
    raise ConfigError(where, f"{count} nodes of element {label}", f"{len(nodes)}", "write the file again")


def _element(where, kind, label, nodes, draft):
    if kind in _FIRST:
        draft.add_element(_FIRST[kind], label, nodes[:8 if _FIRST[kind] == "hexahedron" else 4])
    elif kind not in _SECOND:
        draft.unread[f"elements of {'no type' if kind is None else f'type {kind}'}"] += 1
    elif len(nodes) != _SECOND[kind]:
        raise ConfigError(where, f"{_SECOND[kind]} nodes of SOLID{kind} {label}", f"{len(nodes)}",
                          "write all mid-side nodes")
    else:
        name = "tetra10" if len(nodes) == 10 else _shape(where, nodes, label)
        chosen = nodes if len(nodes) == 10 else [nodes[k] for k in _COLLAPSED[name]]
        if not all(chosen):
            raise ConfigError(where, f"mid-side nodes on all edges of element {label}", "edges without (node 0)",
                              "write elements of second order throughout")
        draft.add_element(name, label, chosen)


def _shape(where, nodes, label):
    """Kind of a hexahedron by the corners that coincide."""
    _, _, third, fourth, *upper = nodes[:8]
    if third == fourth and len(set(upper)) == 1:
        return "tetra10"
    if third == fourth and upper[2] == upper[3] and len(set(nodes[:8])) == 6:
        return "wedge15"
    if len(set(nodes[:8])) == 8:
        return "hexahedron20"
    raise ConfigError(where, "a hexahedron, wedge or tetrahedron", f"element {label} with {len(set(nodes[:8]))} corners"
                      + " (a pyramid)" * (len(set(upper)) == 1), "mesh without pyramids")


def _component(command, draft, held):
    """CMBLOCK,NAME,NODE,count; a number below 0 ends a range."""
    sets = draft.node_sets if command.get(1).upper().startswith("NODE") else draft.element_sets
    numbers = [number for _, row, _ in command.table() for number in row]
    if command.get(2).isdigit() and int(command.get(2)) != len(numbers):
        raise ConfigError(command.where, f"{command.get(2)} numbers, as CMBLOCK says", f"{len(numbers)}")
    members = []
    for number in numbers:
        if number < 0 and not members:
            raise ConfigError(command.where, "the first number of a range", f"{number}")
        members.extend([number] if number >= 0 else span(members[-1] + 1, -number, 1, command.where))
    sets[command.get(0).upper()] = np.array(members, np.int64)


_HANDLERS = {"ET": _type, "ETBLOCK": _types, "NBLOCK": _nodes, "EBLOCK": _elements, "CMBLOCK": _component,
             **dict.fromkeys(_CURRENT, _attribute), **ansys_materials.HANDLERS}
