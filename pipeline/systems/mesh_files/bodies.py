"""Bodies of the brake from mesh files: meshes with their groups, materials and ties, as Solids."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.mesh import Mesh, boundary_faces, face_normals
from pipeline.physics.fem.reference_cells import by_kind, mirrored_vertices, padded
from pipeline.physics.fem.ties import refuse_loose, tie
from pipeline.systems.mesh_files.materials import from_file, lining, materials, read
from pipeline.systems.mesh_files.places import PLACES
from pipeline.systems.solids import Solid

#: groups of a pad: faces on the disc, nodes of the lining
CONTACT, LINED = "(contact face)", "(lining)"
#: faces of a lining that lie this share of its thickness behind its front are no contact: grooves and steps
_RECESS = 0.05
#: least cosine of the angle between a contact face and the plane of the disc
_FACING = 0.99
#: section of the brake -> material that a file does not name
NAMES = {"disc": "cast iron", "caliper": "ductile iron", "bracket": "nodular iron", "piston": "steel"}
#: rows of the strains that change their sign in a mirror image in z
_MIRROR = np.array([1, 1, 1, -1, -1, 1.0])


def from_files(parameters):
    """[(body, section)] of the brake ``parameters`` that come from mesh files; pads as pad_outer and pad_inner."""
    sections = [(name, getattr(parameters, name, None)) for name in ("disc", "pad", "caliper", "bracket", "piston")]
    return [(body, section) for name, section in sections if getattr(section, "mesh_file", None)
            for body in (("pad_outer", "pad_inner") if name == "pad" else (name,))]


def solid(section, name, supported=()):
    """Solid of the mesh file of a section with one material where the file names none; ``name``: one of NAMES.

    ``supported``: nodes held, or a function of mesh, materials and the MeshedBody.
    """
    body = read(section)
    table, row, _ = materials(body, section, NAMES[name], f"structure.{name}")
    held = supported(body, table) if callable(supported) else np.array(supported, int)
    return _solid(body, row, table, [m.name for m in table], section.damping_ratio, held,
                  np.full(len(table), float(section.loss_factor)), f"structure.{name}")


def pad_solid(pad, side):
    """Solid of the outer (``side`` 1) or inner pad (-1) of its section, whose mesh has the group CONTACT."""
    body, mirror = _pad_body(pad, side)
    row, table, lined, _ = _pad_materials(body, pad, side)
    names = ["lining" if of_lining else material.name for material, of_lining in zip(table, lined, strict=True)]
    loss = np.where(lined, pad.lining_loss_factor, pad.backplate_loss_factor)
    made = _solid(body, row, table, names, pad.damping_ratio, np.empty(0, int), loss, "structure.pad")
    made = _mirrored(made) if mirror else made
    chosen = np.array(lined)[made.element_material]
    return replace(made, mesh=replace(made.mesh, groups=made.mesh.groups | {
        CONTACT: _contact(made.mesh, chosen, side), LINED: np.unique(made.mesh.element[chosen])[:, None]}))


def notes(parameters):
    """Sentences on the mesh files: what they hold and was not read, where materials come from, how ties meet."""
    said, of_files = [], {}
    for body, section in from_files(parameters):
        if body.startswith("pad"):
            held, _ = _pad_body(section, 1 if body == "pad_outer" else -1)
            found = _pad_materials(held, section, 1 if body == "pad_outer" else -1)[3]
        else:
            held = read(section)
            found = materials(held, section, NAMES[body], f"structure.{body}")[2]
        for note in held.notes:
            of_files.setdefault(note, []).append(body)
        said += [f"{body}: {note}" for note in found]
        said += [f"{body}: turned: {', '.join(section.mesh_axes)} of its file are x, y, z"] * bool(section.mesh_axes)
        said += [f"{body}: tie {name} holds unlike meshes together" for name, *_ in held.ties]
        places = [name for name, rows in (held.node_sets | held.surfaces).items() if len(rows) and name in PLACES]
        said += [f"{body}: joints act at its groups {', '.join(sorted(places))}"] * bool(places)
    return (*(f"{', '.join(bodies)}: {note}" for note, bodies in of_files.items()), *said)


def bodies_of_decks(parameters):
    """{file: {body: MeshedBody}} of the bodies that come from mesh files; a mirror image has no place in its deck."""
    decks = {}
    for body, section in from_files(parameters):
        held, mirror = _pad_body(section, -1 if body == "pad_inner" else 1) if body.startswith("pad") else (
            read(section), False)
        inner = body == "pad_inner" and section.inner_mesh_file
        if not mirror:
            decks.setdefault(section.inner_mesh_file if inner else section.mesh_file, {})[body] = held
    return decks


def given(parameters):
    """Values of bodies that files give and the case does not state, as in disc.young or pad.lining_density."""
    names = [f"{body}.{key}" for body, section in from_files(parameters) if not body.startswith("pad")
             for key in from_file(section)]
    pads = [section for body, section in from_files(parameters) if body == "pad_outer"]
    return (*names, *(f"pad.{key}" for section in pads for key in _given_of_pad(section)))


def _given_of_pad(pad):
    """Values of the pads that the file of the outer one gives and the case does not state."""
    body, stated = read(pad), set(pad.decided_by_statement())
    known = {}
    for part, rows in (("lining", _lining(body, pad)), ("backplate", ~_lining(body, pad))):
        members = [body.materials[k] for k in np.unique(body.element_material[rows]) if k >= 0]
        known[part, "density"] = any(material.density is not None for material in members)
        known[part, "elastic"] = any(material.young is not None for material in members)
    lined = any(key.startswith("lining_") and key != "lining_density" for key in stated)
    for key in pad.of_material:
        part = key.partition("_")[0]
        what = "density" if key.endswith("density") else "elastic"
        if known[part, what] and key not in stated and not (part == "lining" and what == "elastic" and lined):
            yield key


def measured(pad, mesh, ring):
    """Section of the pads with the dimensions of a mesh from a file; ``ring``: thickness of the disc in m."""
    radius, angle = np.hypot(*mesh.node[:, :2].T), np.arctan2(mesh.node[:, 1], mesh.node[:, 0])
    back, front = np.abs(mesh.node[:, 2]).max(), np.abs(mesh.node[mesh.groups[LINED].ravel(), 2]).max()
    return pad.model_copy(update={
        "inner_radius": radius.min(), "outer_radius": radius.max(), "angle": 2 * np.abs(angle).max(),
        "lining_thickness": front - ring / 2, "backplate_thickness": back - front})


def _solid(body, row, table, names, damping, held, loss, where):
    mesh = replace(body.mesh, groups={name: nodes[:, None] for name, nodes in body.node_sets.items()} | body.surfaces)
    elasticity = np.array([material.elasticity() for material in table])
    stiffest = elasticity[:, :3, :3].max() if len(table) else 0.0
    ties = tuple(tie(mesh.node, first, second, stiffest, f"{where}: tie {name}") for name, first, second in body.ties)
    refuse_loose(mesh, ties, where)
    return Solid(mesh, row, tuple(names), np.array([material.density for material in table]), elasticity, damping, held,
                 loss, ties)


def _pad_body(pad, side):
    """(MeshedBody of a pad, whether it is that of the other side)."""
    if side > 0 or not (pad.inner_mesh_file or pad.inner_mesh_sets):
        return read(pad), side < 0
    return read_body(pad.inner_mesh_file or pad.mesh_file, pad.mesh_units, pad.inner_mesh_sets, pad.mesh_axes), False


def _pad_materials(body, pad, side):
    """((e,) rows, [Material], [whether of the lining], sentences) of a pad."""
    where, of_lining = "structure.pad", _lining(body, pad)
    plate = SimpleNamespace(young=pad.backplate_young, poisson=pad.backplate_poisson, density=pad.backplate_density,
                            prefix="backplate_", decided_by_statement=lambda: tuple(
                                key.removeprefix("backplate_") for key in pad.decided_by_statement()))
    row, table, lined, said = np.empty(len(of_lining), int), [], [], []
    for chosen, section, name, complete in ((of_lining, pad, "lining", lining), (~of_lining, plate, "steel", None)):
        if chosen.any():
            used, local = np.unique(body.element_material[chosen], return_inverse=True)
            part = replace(body, materials=tuple(body.materials[k] for k in used if k >= 0),
                           element_material=local.ravel() - int(used[0] < 0))
            members, rows, sentences = materials(part, section, name, where, complete)
            row[chosen] = len(table) + rows
            table, said = table + members, said + list(sentences)
            lined += [complete is lining] * len(members)
    return row, table, lined, tuple(said)


def _lining(body, pad):
    """(e,) whether an element belongs to the lining; ConfigError where no set and no material is that of the lining."""
    name, chosen = pad.lining_set.upper(), np.zeros(len(body.element_material), bool)
    chosen[body.element_sets.get(name, np.empty(0, int))] = True
    if not chosen.any():
        chosen = np.isin(body.element_material, [k for k, m in enumerate(body.materials) if m.name.upper() == name])
    if not chosen.any():
        known = [*(each for each, rows in body.element_sets.items() if len(rows)), *(m.name for m in body.materials)]
        raise ConfigError("structure.pad.lining_set", f"a set of elements, or a material, of the pad in the mesh file:"
                          f" {', '.join(known) or 'it has none'}", repr(pad.lining_set), "name what the lining is")
    return chosen


def _contact(mesh, lined, side):
    """(f, v) faces of the lining at its front, towards the disc."""
    faces = boundary_faces(Mesh(mesh.node, mesh.element[lined], mesh.kind, mesh.cell[lined]))
    normal, middle = face_normals(mesh.node, faces)
    faces, height = faces[normal[:, 2] * side < -_FACING], side * middle[normal[:, 2] * side < -_FACING, 2]
    if not len(faces):
        raise ConfigError("structure.pad.mesh_file", f"faces of the lining towards {'-' if side > 0 else '+'}z, where"
                          " the disc lies", "none", "place the pads beside the ring: axis z, pads centred on x; or name"
                          " the axes of the file that are x, y, z in structure.pad.mesh_axes")
    thickness = np.ptp(mesh.node[mesh.element[lined], 2])
    return faces[height < height.min() + _RECESS * thickness]


def _mirrored(made):
    """The Solid mirrored in the plane z = 0."""
    mesh, element = made.mesh, made.mesh.element.copy()
    for kind, rows, cells in by_kind(mesh.kind, mesh.element):
        element[rows] = padded(cells[:, mirrored_vertices(kind)], element.shape[1])
    return replace(made, mesh=replace(mesh, node=mesh.node * (1, 1, -1), element=element),
                   elasticity=made.elasticity * _MIRROR[:, None] * _MIRROR)
