"""Chapter: meshes, preload and modes of the brake at rest."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures import mode_shapes, preload
from pipeline.views.figures.number_format import number, percent, plural, quantity, span
from pipeline.views.figures.plotted.picture import in_space
from pipeline.views.figures.scene import render

COLOURS = "In pictures of modes, orange and purple move in opposite axial directions; white is at rest."
_BODY_COLOURS = {"disc": "grey", "pad_outer": "orange", "pad_inner": "green", "caliper": "blue", "bracket": "pink",
                 "piston": "red"}
NO_PICTURES = "Pictures of meshes and mode shapes need OpenGL (on Linux: libEGL), which this machine does not provide."


def chapter(structure, modes, look):
    """Chapter of the product Structure; ``modes`` are ComplexModes, for the load in steady sliding, or None."""
    loads = preload.loads(structure, modes)
    selected = mode_shapes.distinct(structure.disc.frequency, look.shapes)
    scenes = [mode_shapes.assembly(structure), *(mode_shapes.disc_mode(structure.disc, mode) for mode in selected)]
    pictures = in_space(scenes, render(scenes))
    figures = (_pads(structure, modes, loads, look),)
    if pictures:
        figures = (_assembly(structure, pictures[0]), *figures, *(
            _mode(structure.disc, mode, picture) for mode, picture in zip(selected, pictures[1:], strict=True)))
    return Chapter(
        "structure", "The brake: meshes, preload, modes",
        f"Finite-element bodies {', '.join(map(_words, structure.body_name))}, pressed together"
        f" by the piston at {span(structure.pressure, 'Pa')}; {len(structure.contact_area)} contact patches."
        f" {COLOURS}",
        f"The free disc has {len(structure.free_frequency)} modes up to"
        f" {quantity(structure.free_frequency.max(), 'Hz')}; squeal by mode coupling needs two"
        " closely spaced modes of the assembled brake, so these frequencies decide where it can appear. The pad"
        f" pressure {'in steady sliding ' * (modes is not None)}shows where the pads wear first.",
        figures, (_bodies(structure), _joints(structure), _free_modes(structure)),
        (*_mesh_notes(structure), *(() if pictures else (NO_PICTURES,))))


def _mesh_notes(structure):
    """What the mesh files of bodies hold and was not read, and where their materials come from."""
    return tuple(f"Mesh file, {note}." for note in structure.mesh_note)


def _assembly(structure, picture):
    names = [str(name) for name in structure.body_name]
    nodes = sum(len(structure.body(name).node) for name in names)
    colours = ", ".join(f"{_BODY_COLOURS[name]} {_words(name)}" for name in names if name in _BODY_COLOURS)
    return Figure(picture, f"Meshes of the assembled brake: {nodes} nodes, {3 * nodes} displacements."
                  f" {colours.capitalize()}.")


def _mode(disc, mode, picture):
    return Figure(picture, f"Disc on its mount, {quantity(disc.frequency[mode], 'Hz')}, mostly"
                  f" {plural(int(mode_shapes.diameters(disc, mode)), 'nodal diameter')}.", small=True)


def _pads(structure, modes, loads, look):
    nominal = quantity(structure.pressure[len(structure.pressure) // 2], "Pa", 3)
    text = f"Contact pressure on the pads without friction, nominal {nominal}: {_load_in_words(structure, loads[0])}."
    if modes is not None:
        point = preload.sliding_point(modes, structure.pressure[len(structure.pressure) // 2])
        moved = abs(loads[1].force - loads[0].force).max() / loads[0].force.max()
        text += (f" Right: the same brake in steady sliding at {quantity(modes.operating_speed[point], 'rad/s')}"
                 f" with friction {number(modes.operating_friction[point], 2)} from the map, the state whose stability"
                 f" is computed: {_load_in_words(structure, loads[1])}. Friction tilts the pads; it changes the force"
                 f" on a patch by up to {percent(moved, 2)} of the largest force without friction.")
    return Figure(preload.contact_pressure(structure, loads, look.dpi),
                  f"{text} Seen from the pad, the disc moves to the right; crosses: patches off the disc (open).")


def _load_in_words(structure, load):
    """Range of pressure and resultant of each pad, and how many patches are open."""
    parts = []
    for pad in np.unique(structure.contact_body):
        of_pad = structure.contact_body == pad
        parts.append(f"{_words(structure.body_name[pad])}"
                    f" {span(load.force[of_pad] / structure.contact_area[of_pad], 'Pa')}, resultant"
                    f" {quantity(load.force[of_pad].sum(), 'N', 3)}")
    open_ = np.sum(~load.closed)
    return f"{'; '.join(parts)}; {open_ or 'none'} of {len(load.force)} patches open"


def _bodies(structure):
    bodies = [(_words(name), structure.body(str(name))) for name in structure.body_name]
    rows = tuple((name, str(len(body.node)), str(len(body.element)), str(body.kind.item()),
                  ", ".join(dict.fromkeys(f"{m} ({quantity(d, 'kg/m^3')})" for m, d in zip(
                      body.material_name, body.density, strict=True))),
                  str(len(body.frequency)), quantity(body.frequency.max(initial=0.0), "Hz"),
                  percent(body.damping_ratio)) for name, body in bodies)
    return Table(("body", "nodes", "elements", "element", "materials", "modes", "up to", "damping ratio"), rows,
                 "Bodies", (1, 2, 5, 6, 7))


def _joints(structure):
    """Joints of the same bodies and values in one row, under the words that their names share."""
    rows, groups = structure.joint_rows, {}
    for k, name in enumerate(structure.joint_name):
        bodies = [str(structure.body_name[b]) for b in np.unique(rows.body[rows.row == k])]
        between = " and ".join(_words(b) for b in (bodies if len(bodies) > 1 else [*bodies, "ground"]))
        values = (structure.joint_stiffness[k], structure.joint_damping[k], structure.joint_loss_factor[k])
        groups.setdefault((between, *values), []).append(str(name).split("_"))
    lines = [(" ".join(w for w in names[0] if all(w in other for other in names)), between, str(len(names)),
              quantity(stiffness, "N/m"), quantity(damping, "N s/m"), number(loss, 2))
             for (between, stiffness, damping, loss), names in groups.items()]
    for stiffness, loss in zip(structure.fluid_stiffness, structure.fluid_loss_factor, strict=True):
        lines.append(("fluid column", "piston and cylinder, in vibration", "1", quantity(stiffness, "N/m"),
                      quantity(0.0, "N s/m"), number(loss, 2)))
    return Table(("joint", "between", "springs", "stiffness of each", "damping of each", "loss factor"), tuple(lines),
                 "Joints", (2, 3, 4, 5), folded=True)


def _words(name):
    return str(name).replace("_", " ")


def _free_modes(structure, most=20):
    rows = tuple((quantity(f, "Hz"), str(d), number(out, 2)) for f, d, out in zip(
        structure.free_frequency[:most], structure.free_diameters, structure.free_out_of_plane, strict=False))
    title = f"Free disc, first {len(rows)} of {len(structure.free_frequency)} elastic modes"
    return Table(("frequency", "nodal diameters", "axial fraction of modal mass"), rows, title, (0, 1, 2), folded=True)
