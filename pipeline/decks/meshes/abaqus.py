"""Decks of Abaqus and CalculiX (.inp): mesh, sets, surfaces, materials, solid sections, ties, parts and instances."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes import abaqus_materials
from pipeline.decks.meshes.abaqus_parts import Parts
from pipeline.decks.meshes.deck import BY_COUNT, FREE, Draft, span, whole
from pipeline.decks.meshes.keywords import blocks, number

_SOLID = re.compile(r"C3D(\d+)[A-Z]*")
#: rows of the nodes of C3D27 (centre, then the middles of faces 1 to 6) in the order of meshio
_TWENTYSEVEN = (*range(20), 26, 24, 23, 25, 21, 22, 20)
#: springs by their number of nodes
_SPRINGS = {"SPRING1": 1, "SPRING2": 2, "SPRINGA": 2}
#: keywords that make or move nodes and elements: without them the mesh would be another one
_GENERATORS = {"NGEN", "NCOPY", "NFILL", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "IMPERFECTION", "SUBMODEL"}
#: keywords that say nothing of the body
_HOLLOW = {"HEADING", "PREPRINT", "END INSTANCE", "END STEP"}


def read(path):
    """Deck of the file at ``path``; raises ConfigError for what cannot be read as a mesh, with file and line."""
    draft = Draft(f"mesh file {path}")
    parts, state = Parts(draft), abaqus_materials.Materials()
    for block in blocks(path):
        if block.name in _GENERATORS:
            raise ConfigError(block.where, "a mesh that is written out", f"*{block.name}",
                              "have the preprocessor write all nodes and elements")
        if block.name in _HANDLERS:
            _HANDLERS[block.name](block, parts)
        elif not (block.name in _HOLLOW or parts.takes(block) or state.takes(block, parts.current)):
            draft.unread[f"*{block.name}"] += 1
    state.leave(draft, parts)
    return draft.deck()


def _node(block, parts):
    draft = parts.current
    if block.given.get("SYSTEM", "R").upper() != "R":
        raise ConfigError(block.where, "Cartesian coordinates (SYSTEM=R)", f"SYSTEM={block.given['SYSTEM']}",
                          "write the nodes in Cartesian coordinates")
    first = len(draft.label)
    for where, fields in block.rows:
        values = (*fields[1:4], "", "", "")[:3]
        draft.label.append(whole(fields[0], where))
        draft.position.append(tuple([number(text, where, 0.0) for text in values]))
    if "NSET" in block.given:
        draft.node_sets.setdefault(block.given["NSET"].upper(), []).extend(draft.label[first:])


def _element(block, parts):
    draft = parts.current
    kind_name = block.need("TYPE").upper()
    solid = _SOLID.fullmatch(kind_name)
    if solid and int(solid[1]) not in BY_COUNT:
        raise ConfigError(block.where, "C3D20, C3D27, C3D10 or C3D15, with R, H and the like", kind_name,
                          "mesh with hexahedra, tetrahedra or wedges of second order")
    if kind_name in _SPRINGS and not draft.scope:
        _spring_elements(block, kind_name, parts)
        return
    first = []
    for where, values in _records(block, int(solid[1]) if solid else None):
        label, *nodes = [whole(text, where) for text in values] if solid else [whole(values[0], where)]
        first.append(label)
        if solid:
            order = _TWENTYSEVEN if len(nodes) == 27 else range(len(nodes))
            draft.add_element(BY_COUNT[len(nodes)], label, [nodes[k] for k in order])
    if not solid:
        draft.unread[f"*ELEMENT of type {kind_name}"] += len(first)
    if "ELSET" in block.given:
        draft.element_sets.setdefault(block.given["ELSET"].upper(), []).extend(first)


def _spring_elements(block, kind, parts):
    """Keep springs by their set; their nodes may be written as INSTANCE.NUMBER."""
    held = parts.current.spring_elements.setdefault(block.given.get("ELSET", "").upper(), [])
    for where, (label, *nodes) in block.rows:
        ends = [number for text in filter(None, nodes) for number in parts.members(text, "nodes", block, where)]
        if len(ends) != _SPRINGS[kind]:
            raise ConfigError(where, f"{_SPRINGS[kind]} nodes of an element of type {kind}", f"{len(ends)}")
        held.append((whole(label, where), kind, ends))


def _spring(block, parts):
    """Stiffness of a set of springs, in the last line; degrees of freedom before it, which SPRINGA has not."""
    name, draft = block.need("ELSET").upper(), parts.current
    if draft.scope or {"NONLINEAR", "COMPLEX STIFFNESS", "ORIENTATION"} & set(block.given):
        draft.unread["*SPRING that is nonlinear, complex, oriented or of a part"] += 1
        return
    *before, last = block.rows or [(block.where, [""])]
    freedoms = tuple(whole(text, where) - 1 for where, fields in before[:1] for text in fields if text)
    if not set(freedoms) <= {0, 1, 2}:
        raise ConfigError(block.where, "degrees of freedom 1, 2 or 3 of *SPRING", str([f + 1 for f in freedoms]),
                          "springs of rotations have no place on solid elements")
    draft.spring_values[name] = freedoms, number(last[1][0], last[0])


def _records(block, count):
    """Yield (where, fields) of each element; a line that ends with a comma goes on in the next one.

    ``count``: nodes of the type, which are checked; None = any.
    """
    waiting, start = [], ""
    for where, fields in block.rows:
        start = where if not waiting else start
        waiting += fields[:-1] if fields[-1] == "" else fields
        if fields[-1] == "" and (count is None or len(waiting) <= count):
            continue
        yield start, _counted(waiting, count, start, block)
        waiting = []
    if waiting:
        yield start, _counted(waiting, count, start, block)


def _counted(values, count, where, block):
    if count is not None and len(values) != count + 1:
        raise ConfigError(where, f"{count} nodes of an element of type {block.given['TYPE']}",
                          f"{len(values) - 1} nodes", "end lines that go on in the next one with a comma")
    return values


def _set(kind):
    """Reader of *NSET or *ELSET, whose members are numbers, ranges and names of sets before it."""
    def read_set(block, parts):
        draft = parts.current
        if kind == "NSET" and "ELSET" in block.given:
            draft.unread["*NSET of an ELSET"] += 1
            return
        held, of = (draft.node_sets, "nodes") if kind == "NSET" else (draft.element_sets, "elements")
        members = []
        for where, fields in block.rows:
            if "GENERATE" in block.given:
                ends = [whole(text, where) for text in fields if text]
                if len(ends) not in (2, 3):
                    raise ConfigError(where, "first number, last and step", ", ".join(fields)[:60])
                first = parts.first_number(block)
                members.extend(n + first for n in span(*ends[:2], (*ends, 1)[2], where))
            else:
                for text in filter(None, fields):
                    members.extend(parts.members(text, of, block, where))
        held.setdefault(block.need(kind).upper(), []).extend(members)
    return read_set


def _surface(block, parts):
    draft = parts.current
    name, kind = block.need("NAME").upper(), block.given.get("TYPE", "ELEMENT").upper()
    if kind not in ("ELEMENT", "NODE"):
        draft.unread[f"*SURFACE of type {kind}"] += 1
        return
    of, side = ("nodes", "") if kind == "NODE" else ("elements", FREE)
    read = tuple((np.array(parts.members(fields[0], of, block, where), np.int64), (*fields, "")[1].upper() or side)
                 for where, fields in block.rows if fields[0])
    if kind == "NODE":
        read = tuple((numbers, "") for numbers, _ in read)
    draft.surfaces[name] = draft.surfaces.get(name, ()) + read


def _tie(block, parts):
    if "CYCLIC SYMMETRY" in block.given or "MULTIHARMONIC" in block.given:
        parts.current.unread["*TIE of cyclic symmetry"] += 1
        return
    for where, fields in block.rows:
        if len(list(filter(None, fields))) != 2:
            raise ConfigError(where, "two surfaces of *TIE", ", ".join(fields)[:60])
        parts.current.ties.append((where, block.given.get("NAME", "without a name").upper(),
                                   *(text.strip('"').upper() for text in fields[:2])))


_HANDLERS = {"NODE": _node, "ELEMENT": _element, "NSET": _set("NSET"), "ELSET": _set("ELSET"), "SURFACE": _surface,
             "TIE": _tie, "SPRING": _spring, "INCLUDE": lambda block, parts: None}
