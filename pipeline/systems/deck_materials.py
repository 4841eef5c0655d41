"""Materials of a body whose mesh comes from a file: those of the file, over which declared values go."""

from dataclasses import replace

import numpy as np

from pipeline.decks.meshes.body import MeshedBody, read_body
from pipeline.decks.meshes.material import Material

#: of the disc: the name of a material that no file gives, and its section
DISC = "cast iron", "structure.disc"

#: declared and given values that differ by less than this share are the same
_SAME = 1e-3
#: values that a section may state: what they are called, and how they are printed
_VALUES = {"young": ("Young's modulus", "{:.4g} Pa"), "poisson": ("Poisson's ratio", "{:.4g}"),
           "density": ("density", "{:.5g} kg/m^3")}


def meshed(parameters, mesh):
    """MeshedBody of the file that ``parameters`` name, else of ``mesh(parameters)``."""
    if parameters.mesh_file:
        return read_body(parameters.mesh_file, parameters.mesh_units)
    made = mesh(parameters)
    return MeshedBody(made, (), np.full(len(made.element), -1), ())


def notes(parameters, name, where):
    """Sentences on the mesh file that ``parameters`` name: what it holds and was not read, whence the materials are."""
    if not parameters.mesh_file:
        return ()
    body = read_body(parameters.mesh_file, parameters.mesh_units)
    return (*body.notes, *materials(body, parameters, name, where)[2])


def from_file(parameters):
    """Names among young, poisson and density whose value is that of the mesh file: the case states none."""
    members = read_body(parameters.mesh_file, parameters.mesh_units).materials if parameters.mesh_file else ()
    return tuple(key for key in _VALUES if key not in parameters.decided_by_statement() and any(
        (material.density if key == "density" else material.young) is not None for material in members))


def materials(body, parameters, name, where):
    """(materials [Material] in SI units, (e,) row of each element, sentences on where each value comes from).

    ``body``: MeshedBody; ``parameters``: section with young, poisson and density, of which those that the case states
    go before those of the file, and those that neither states are the defaults of the section; ``name``: of a material
    that the file does not give; ``where``: the section, for the sentences.
    """
    stated = set(parameters.decided_by_statement())
    rest = (body.element_material < 0).any()
    members = [*body.materials, *[Material(name)] * bool(rest)]
    row = np.where(body.element_material < 0, len(body.materials), body.element_material)
    completed = [_completed(material, parameters, stated, where) for material in members]
    said = [note for _, each in completed for note in each] if body.materials else []
    if rest and body.materials:
        said.append(f"{(body.element_material < 0).sum()} elements have no material in the file: {name} of {where}")
    return [material for material, _ in completed], row, tuple(said)


def _completed(material, parameters, stated, where):
    """(the material with all values, sentences)."""
    elastic = stated & {"young", "poisson"}
    given = {"density": material.density}
    if material.young is None or material.isotropic:
        given |= {key: None if material.young is None else getattr(material, key)[0] for key in ("young", "poisson")}
    chosen = {key: getattr(parameters, key) if key in stated or given.get(key) is None else given[key]
              for key in _VALUES}
    said = [_note(material.name, key, given[key], chosen[key], key in stated, where) for key in _VALUES if key in given]
    completed = replace(material, density=chosen["density"])
    if "young" in given:
        completed = completed.with_isotropic(chosen["young"], chosen["poisson"])
    elif elastic:
        completed = completed.with_isotropic(parameters.young, parameters.poisson)
        said.append(f"{material.name}: direction-dependent constants of the file; {where} states"
                     f" {', '.join(sorted(elastic))}, which makes it isotropic")
    else:
        said.append(f"{material.name}: direction-dependent constants of the file")
    return completed, tuple(said)


def _note(name, key, given, chosen, stated, where):
    """One sentence on the value ``key`` of a material."""
    label, form = _VALUES[key]
    used = f"{name}: {label} {form.format(chosen)}"
    if given is None:
        return f"{used}, {'as stated' if stated else 'the default'} in {where}.{key}; the file gives none"
    if stated and abs(given - chosen) > _SAME * abs(chosen):
        return f"{used}, as stated in {where}.{key}; the file gives {form.format(given)}"
    return f"{used}, {'as stated and ' * stated}from the file"
