"""Materials of an Ansys archive: MP and MPDATA, isotropic or along the axes x, y, z."""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.deck import listed, whole
from pipeline.decks.meshes.keywords import number
from pipeline.decks.meshes.material import Material

_PLANES = ("YZ", "XZ", "XY")
_READ = {"DENS", "EX", "EY", "EZ", *(f"{kind}{plane}" for kind in ("PR", "NU", "G") for plane in _PLANES)}


def given(command, draft, held):
    """Take the values of MP,LAB,MAT,C0,... or MPDATA,R5.0,1,LAB,MAT,1,C1,... into ``held['values']``."""
    texts = command.values
    if command.name == "MPDATA":
        texts = texts[2:] if texts and texts[0].upper().startswith("R") else texts
        texts = [*texts[:2], *texts[3:]]
    label, *rest = (*texts, "", "", "")
    name, material = label.upper(), whole(rest[0], command.where)
    if name not in _READ:
        draft.unread[f"MP {name} of material {material}"] += 1
        return
    numbers = [number(text, command.where) for text in rest[1:] if text]
    if not numbers:
        raise ConfigError(command.where, f"a value of {name}", "none")
    held["values"].setdefault(material, {})[name] = numbers[0]
    if any(numbers[1:]):
        draft.notes.append(f"{name} of material {material} depends on temperature: its first value is taken")


def leave(draft, held):
    """Give the draft its materials, and sections of the elements of each.

    Raises ConfigError for a material along axes of an element coordinate system.
    """
    for label, values in held["values"].items():
        draft.materials[f"MATERIAL {label}"] = _material(f"MATERIAL {label}", values, draft)
    lacking = {label: elements for label, elements in held["material"].items() if label not in held["values"]}
    if lacking:
        draft.notes.append(f"{sum(map(len, lacking.values()))} elements of {listed('material', lacking)}, of which the"
                           " file gives no value")
    for label, elements in held["material"].items():
        name = f"MATERIAL {label}"
        if label in lacking:
            continue
        if held["systems"][label] and draft.materials[name].young and not draft.materials[name].isotropic:
            raise ConfigError(f"{draft.where}, {name}", "constants along the axes of the file (ESYS 0)",
                              f"ESYS {held['systems'][label]}", "write them along x, y, z")
        draft.sections.append((np.array(elements, np.int64), name, None))


def _material(name, values, draft):
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
            return replace(material, young=tuple(young), poisson=tuple(poisson), shear=tuple(shear))
    if any(key != "DENS" for key in values):
        draft.notes.append(f"{name} lacks elastic constants, which are not taken: the file gives"
                           f" {', '.join(key for key in values if key != 'DENS')}")
    return material
