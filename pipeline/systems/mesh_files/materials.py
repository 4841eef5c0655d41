"""Materials of a body whose mesh comes from a file: those of the file, over which declared values go."""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.decks.meshes.material import Material

#: declared and given values that differ by less than this share are the same
_SAME = 1e-3
#: values that a section may state: what they are called, and how they are printed
_VALUES = {"young": ("Young's modulus", "{:.4g} Pa"), "poisson": ("Poisson's ratio", "{:.4g}"),
           "density": ("density", "{:.5g} kg/m^3")}


def from_file(parameters):
    """Names among young, poisson and density whose value is that of the mesh file: the case states none."""
    if not parameters.mesh_file:
        return ()
    members, stated = read(parameters).materials, parameters.decided_by_statement()
    return tuple(key for key in _VALUES if key not in stated and any(
        (material.density if key == "density" else material.young) is not None for material in members))


def read(parameters):
    """MeshedBody of the file, and the sets of it, that a section names."""
    return read_body(parameters.mesh_file, parameters.mesh_units, parameters.mesh_sets, parameters.mesh_axes)


def materials(body, parameters, name, where, complete=None):
    """(materials [Material] in SI units, (e,) row of each element, sentences on where each value comes from).

    ``body``: MeshedBody; ``parameters``: section with young, poisson and density, of which those that the case states
    go before those of the file, and those that neither states are the defaults of the section; ``name``: of a material
    that the file does not give; ``where``: the section, for the sentences; ``complete``: what gives a material all its
    values, that of one with young, poisson and density by default, or ``lining``. Raises ConfigError for a deck with
    materials of which the body has none, and the case states none.
    """
    complete = complete or _completed
    stated = set(parameters.decided_by_statement())
    if body.known and not body.materials and not _stated_at_all(stated, name):
        raise ConfigError(where, f"a material of the {name}", f"none of {', '.join(body.known)} on its elements",
                          "write a section of them in the deck, such as *SOLID SECTION, or state its modulus, Poisson's"
                          " ratio and density in the case")
    rest = (body.element_material < 0).any()
    members = [*body.materials, *[Material(name)] * bool(rest)]
    row = np.where(body.element_material < 0, len(body.materials), body.element_material)
    completed = [complete(material, parameters, stated, where) for material in members]
    said = [note for _, each in completed for note in each] if body.materials else []
    if rest and body.materials:
        said.append(f"{(body.element_material < 0).sum()} elements have no material in the file: {name} of {where}")
    return [material for material, _ in completed], row, tuple(dict.fromkeys(said))


def _completed(material, parameters, stated, where):
    """(the material with all values, sentences)."""
    elastic = stated & {"young", "poisson"}
    prefix = getattr(parameters, "prefix", "")
    _refuse_unread(material, elastic == {"young", "poisson"}, where, f"{prefix}young and {prefix}poisson")
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


def _stated_at_all(stated, name):
    """Whether the case states a value of a material, of pads with the names of its layer."""
    return any(key.startswith("lining_") == (name == "lining") for key in stated)


def lining(material, pad, stated, where):
    """(the lining with all values, sentences): along radius, sliding and thickness as the case states, else the file.

    ``material``: Material of the file in SI units; ``pad``: section with ``lining_...``, of which it states ``stated``.
    """
    stated = {key for key in stated if key.startswith("lining_")}
    dense = "lining_density" in stated or material.density is None
    density = pad.lining_density if dense else material.density
    said = [f"{material.name}: density {density:.5g} kg/m^3, {_source(dense, 'lining_density' in stated, where)}"]
    elastic = stated - {"lining_density"}
    _refuse_unread(material, bool(elastic), where, "lining_young_normal and the other elastic constants")
    if not elastic and material.young is not None:
        return replace(material, density=density), (f"{material.name}: elastic constants of the file", *said)
    young = tuple(getattr(pad, f"lining_young_{axis}") for axis in ("radial", "tangential", "normal"))
    shear = (pad.lining_shear_normal, pad.lining_shear_normal, pad.lining_shear_in_plane)
    said.insert(0, f"{material.name}: elastic constants {_source(True, bool(elastic), where)}, along x, y, z")
    made = replace(material, axes=None, density=density)
    return made.with_constants(young, (pad.lining_poisson,) * 3, shear), tuple(said)


def _refuse_unread(material, stated, where, keys):
    """ConfigError for a material whose law in the deck is not read, unless the case has ``stated`` what takes its
    place."""
    unread = material.unread
    if unread is not None and not stated:
        raise ConfigError(f"{unread.where}, material {material.name}", "elastic constants of a solid that are read",
                          unread.found, f"{unread.remedy}, or state {where}: {keys} in the case, which go before the"
                          " deck")


def _source(of_case, stated, where):
    return f"{'as stated' if stated else 'the default'} in {where}" if of_case else "from the file"


def _note(name, key, given, chosen, stated, where):
    """One sentence on the value ``key`` of a material."""
    label, form = _VALUES[key]
    used = f"{name}: {label} {form.format(chosen)}"
    if given is None:
        return f"{used}, {'as stated' if stated else 'the default'} in {where}.{key}; the file gives none"
    if stated and abs(given - chosen) > _SAME * abs(chosen):
        return f"{used}, as stated in {where}.{key}; the file gives {form.format(given)}"
    return f"{used}, {'as stated and ' * stated}from the file"
