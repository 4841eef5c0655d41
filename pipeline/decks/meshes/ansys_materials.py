"""Materials of an Ansys archive: MP and MPDATA along x, y, z, matrices of TB, coordinate systems of elements."""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.axes import Axes, in_elements, turn
from pipeline.decks.meshes.deck import listed, whole
from pipeline.decks.meshes.keywords import number
from pipeline.decks.meshes.material import BY_ROWS, Material, Unread, symmetric

_PLANES = ("YZ", "XZ", "XY")
_READ = {"DENS", "EX", "EY", "EZ", *(f"{kind}{plane}" for kind in ("PR", "NU", "G") for plane in _PLANES)}
#: the strains that x, y, z, xy, yz and xz are among xx, yy, zz, yz, xz, xy
_STRAINS = (0, 1, 2, 5, 3, 4)
#: tables of an elastic matrix: (first letters of the label, option) -> whether it is the compliance
_MATRICES = {("ANEL", ""): False, ("ANEL", "0"): False, ("ANEL", "1"): True, ("ELAS", "AELS"): False,
             ("ELAS", "AELF"): True}
_ISOTROPIC = ("", "ISOT")
#: tables of other elastic laws, which stand for the constants of MP
_LAWS = ("ELAS", "ANEL", "HYPE", "AHYP", "MOON", "BB", "USER", "GASK", "SMA", "COMP")
_WRITE = "write EX, EY, EZ, PRXY, PRYZ, PRXZ, GXY, GYZ, GXZ by MP, or TB,ANEL"
#: global coordinate systems of elements: Cartesian, and cylindrical about z and y
_GLOBAL = {0: Axes(np.eye(3)), 1: Axes(np.eye(3), np.zeros(3), True),
           5: Axes(np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), np.zeros(3), True)}


def empty():
    """What the commands of materials fill: values and matrices by material, tables, coordinate systems."""
    return {"values": {}, "where": {}, "table": None, "tables": [], "systems": {}}


def _given(command, draft, held):
    """Take the values of MP,LAB,MAT,C0,... or MPDATA,R5.0,1,LAB,MAT,1,C1,... into ``held['values']``."""
    texts, first = command.values, True
    if command.name == "MPDATA":
        texts = texts[2:] if texts and texts[0].upper().startswith("R") else texts
        first = texts[2:3] in (["1"], [""], [])
        texts = [*texts[:2], *texts[3:]]
    label, *rest = (*texts, "", "", "")
    name, material = label.upper(), whole(rest[0], command.where)
    if name not in _READ:
        draft.unread[f"MP {name} of material {material}"] += 1
        return
    numbers = [number(text, command.where) for text in rest[1:] if text]
    if not numbers:
        raise ConfigError(command.where, f"a value of {name}", "none")
    held["where"].setdefault(material, command.where)
    if first:
        held["values"].setdefault(material, {})[name] = numbers[0]
    if any(numbers[1:]) or not first:
        said = f"{name} of material {material} depends on temperature: its first value is taken"
        draft.notes += [said] * (said not in draft.notes)


def _table(command, draft, held):
    """TB,LAB,MAT,NTEMP,NPTS,TBOPT: what TBDATA after it belongs to."""
    label, option = command.get(0).upper()[:4], command.get(4).upper()
    material = whole(command.get(1) or "1", command.where)
    held["table"] = {"kind": (label, option), "material": material, "where": command.where, "name": command.get(0),
                     "values": {}, "temperatures": 0}
    if label in _LAWS:
        held["tables"].append(held["table"])
    else:
        draft.unread[f"TB {command.get(0).upper()} of material {material}"] += 1


def _temperature(command, draft, held):
    table = held["table"]
    if table is not None:
        table["temperatures"] += 1
        if table["temperatures"] == 2 and table in held["tables"]:
            draft.notes.append(f"TB {table['name'].upper()} of material {table['material']} depends on temperature:"
                               " that of the first one is taken")


def _constants(command, draft, held):
    """TBDATA,STLOC,C1,C2,...: constants of a table from number STLOC on."""
    table = held["table"]
    if table is None or table["temperatures"] > 1:
        return
    first = whole(command.get(0) or "1", command.where)
    for k, text in enumerate(command.values[1:]):
        table["values"][first + k] = number(text, command.where, 0.0)


def _local(command, draft, held):
    """LOCAL,R5.3,LOC,KCN,KCS,x,y,z with ANG lines after it, or LOCAL,KCN,KCS,x,y,z,thxy,thyz,thzx."""
    values, what = command.values, "LOC"
    if values and values[0].upper().startswith("R"):
        what, values = command.get(1).upper(), values[2:]
    label, kind = whole(values[0], command.where), whole((*values, "0", "0")[1] or "0", command.where)
    numbers = [number(text, command.where, 0.0) for text in values[2:]] + [0.0] * 6
    place, angles = held["systems"].get(label, (np.zeros(3), np.zeros(3), kind))[:2]
    if what == "LOC":
        place, angles = np.array(numbers[:3]), np.array(numbers[3:6])
    elif what == "ANG":
        angles = np.array(numbers[:3])
    elif any(value not in (0, 1) for value in numbers):
        kind = -1       # an elliptical system
    held["systems"][label] = place, angles, kind


def leave(draft, held):
    """Give the draft its materials, and sections of the elements of each.

    Raises ConfigError for a material with directions along an element coordinate system that is not read.
    """
    of_tables = {table["material"]: table for table in held["tables"]}
    known = {**held["values"], **{label: held["values"].get(label, {}) for label in of_tables}}
    for label, values in known.items():
        where = held["where"].get(label, draft.where)
        material = _material(f"MATERIAL {label}", values, where)
        draft.materials[material.name] = _of_table(material, of_tables[label]) if label in of_tables else material
    lacking = {}
    for (label, system), elements in held["elements"].items():
        if label not in known:
            lacking.setdefault(label, []).extend(elements)
            continue
        numbers, material = np.array(elements, np.int64), draft.materials[f"MATERIAL {label}"]
        draft.sections.append((numbers, material.name, _axes(draft, numbers, material, system, held["systems"])))
    if lacking:
        draft.notes.append(f"{sum(map(len, lacking.values()))} elements of {listed('material', lacking)}, of which the"
                           " file gives no value")


def _axes(draft, numbers, material, system, systems):
    """Axes of a material in the elements ``numbers`` (k,) of a coordinate ``system``, as of ``Draft.sections``."""
    if not system or material.young is None or material.isotropic:
        return None
    found = _GLOBAL.get(system)
    if system in systems:
        place, angles, kind = systems[system]
        rows = np.eye(3)
        for axis, angle in zip((2, 0, 1), np.deg2rad(angles), strict=True):
            rows = turn(axis, angle) @ rows
        found = Axes(rows, place, kind == 1) if kind in (0, 1) else None
    if found is None:
        raise ConfigError(f"{draft.where}, {material.name}", "constants along x, y, z (ESYS 0), or along a Cartesian or"
                          " cylindrical system that LOCAL gives", f"ESYS {system}", "write LOCAL, or x, y, z")
    return in_elements(found, draft, numbers, material, system)


def _of_table(material, table):
    """The material with the elastic law of a ``table``; with what is Unread where that is another one."""
    kind, values = table["kind"], table["values"]
    if kind[0] == "ELAS" and kind[1] in _ISOTROPIC and {1, 2} <= set(values):
        return material.with_isotropic(values[1], values[2])
    if kind not in _MATRICES or not values:
        return replace(material, young=None, unread=Unread(table["where"], f"TB,{table['name'].upper()}"
                                                           + f",,,,{kind[1]}" * bool(kind[1]), _WRITE))
    matrix = symmetric([values.get(k, 0.0) for k in range(1, len(BY_ROWS) + 1)], BY_ROWS, _STRAINS)
    if _MATRICES[kind]:
        if np.linalg.eigvalsh(matrix)[0] <= 0:
            raise ConfigError(f"{table['where']}, {material.name}", "a compliance of a positive strain energy",
                              f"a lowest eigenvalue of {np.linalg.eigvalsh(matrix)[0]:.3g}", "check its order")
        matrix = np.linalg.inv(matrix)
    return material.with_matrix(matrix, table["where"])


def _material(name, values, where):
    material = Material(name, density=values.get("DENS"))
    young = [values.get(f"E{axis}") for axis in "XYZ"]
    if young[1:] == [None, None] and young[0] is not None:
        poisson = values.get("PRXY", values.get("NUXY"))
        if poisson is not None:
            return material.with_isotropic(young[0], poisson)
    elif None not in young:
        ratio = {plane: young["XYZ".index(plane[0])] / young["XYZ".index(plane[1])] for plane in _PLANES}
        poisson = [values.get(f"PR{plane}", values.get(f"NU{plane}", np.nan) * ratio[plane]) for plane in _PLANES]
        shear = [values.get(f"G{plane}", np.nan) for plane in _PLANES]
        if np.isfinite([*poisson, *shear]).all():
            return material.with_constants(tuple(young), tuple(poisson), tuple(shear))
    given = ", ".join(key for key in values if key != "DENS")
    if given:
        return replace(material, unread=Unread(where, f"{given} of {name} alone", "write EX and PRXY, or the nine"
                                               " constants EX, EY, EZ, PRXY, PRYZ, PRXZ, GXY, GYZ, GXZ"))
    return material


HANDLERS = {"MP": _given, "MPDATA": _given, "TB": _table, "TBDATA": _constants, "TBDAT": _constants,
            "TBTEMP": _temperature, "TBTEM": _temperature, "LOCAL": _local}
