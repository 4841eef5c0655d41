"""Settings of bodies whose meshes come from files, one a body or one deck of several."""

from pathlib import Path
from typing import ClassVar, Literal

from pipeline.contract import InputFile, Names, Section, option
from pipeline.systems.mesh_files.bodies import bodies_of_decks

Units = Literal["SI", "mm-t-s", "mm-kg-ms"]
#: axes of a mesh file that become x, y and z
FileAxes = tuple[Literal["x", "y", "z", "-x", "-y", "-z"], ...]
#: bodies of a brake that a deck may hold
BODIES = ("disc", "pad_outer", "pad_inner", "caliper", "bracket", "piston")
#: where a case says of each body that it comes from a deck: section, key of the file, key of its sets
_KEYS = {name: (name, "mesh_file", "mesh_sets") for name in BODIES} | {
    "pad_outer": ("pad", "mesh_file", "mesh_sets"), "pad_inner": ("pad", "inner_mesh_file", "inner_mesh_sets")}


class FromMesh(Section):
    """A body that may come from a mesh file instead."""

    #: values that go before those of the file only where the case states them
    of_material: ClassVar[tuple] = ("young", "poisson", "density")

    mesh_file: InputFile | None = option(None, "mesh of quadratic hexahedra, tetrahedra or wedges to use instead, same"
                                                " axes: deck of Abaqus, CalculiX (.inp), Nastran (.bdf) or Ansys (.cdb)"
                                                " with its materials, or what meshio reads")
    mesh_units: Units = option("SI", "units of the mesh file and of its materials")
    mesh_sets: Names = option((), "sets of elements, or instances, of the file that are this body; none = all of it")

    mesh_axes: FileAxes = option((), "axes of the file that become x (middle of the pads), y and z (axis of the disc),"
                                     " such as [y, z, x]; none = the same axes")

    def decided_by_statement(self):
        """Values that go before those of a mesh file only where the case states them."""
        return tuple(sorted(set(self.of_material) & self.model_fields_set)) if self.mesh_file else ()


def with_deck(values):
    """The written section structure with its deck of several bodies under each of them.

    ``mesh_file``, ``mesh_units``, ``mesh_axes`` and ``mesh_sets`` {body: sets of elements} stand for the same keys of
    the bodies.
    Raises ValueError for sets without a file, and for a body that states a file of its own besides.
    """
    if not isinstance(values, dict) or not (values.get("mesh_file") or values.get("mesh_sets")):
        return values
    file, sets = values.get("mesh_file"), values.get("mesh_sets")
    alike = {key: values[key] for key in ("mesh_units", "mesh_axes") if values.get(key)}
    if not file or not isinstance(sets, dict) or not sets:
        raise ValueError("expected mesh_file with mesh_sets, such as {caliper: CALIPER, pad_outer: [LINING, PLATE]},"
                         f" found {'no mesh_file' if not file else 'no mesh_sets'}")
    filled = dict(values)
    for body, names in sets.items():
        if body not in _KEYS:
            raise ValueError(f"expected bodies {', '.join(BODIES)} in mesh_sets, found {body!r}")
        section, file_key, sets_key = _KEYS[body]
        filled[section] = _extended(filled.get(section), body, {file_key: file, sets_key: names, **alike},
                                    f"{section}.{file_key}")
    return filled


def _extended(section, body, more, where):
    """A written or filled section with ``more``; ValueError where it states another file at ``where``."""
    key = where.split(".")[1]
    filled = isinstance(section, Section)
    stated = getattr(section, key) if filled else (section or {}).get(key)
    if stated and stated != more[key]:
        raise ValueError(f"expected one mesh of the {body}, found {where} besides mesh_file")
    if filled:
        names = {name: (value,) if name.endswith("sets") and isinstance(value, str) else
                 tuple(value) if isinstance(value, list) else value for name, value in more.items()}
        return section.model_copy(update=names | {key: Path(more[key])})
    return {**({"kind": "body"} if body in ("bracket", "piston") else {}), **(section or {}), **more}


def freedoms_of_files(brake):
    """Degrees of freedom of the bodies of the section ``structure``, ``brake``, that come from mesh files."""
    return sum(3 * len(body.mesh.node) for bodies in bodies_of_decks(brake).values() for body in bodies.values())
