"""Chapter: meshes, preload and modes of the brake at rest."""

import numpy as np

from pipeline.views import preload, shapes
from pipeline.views.chapter import Chapter, Figure, Table
from pipeline.views.readable import number, percent, quantity, span
from pipeline.views.scene import render

COLOURS = "In the pictures of modes orange and purple move in opposite directions along the axis; white is at rest."
NO_PICTURES = "Pictures of meshes and mode shapes need OpenGL (on Linux: libEGL), which this machine does not offer."


def chapter(structure, look):
    """Chapter of the product Structure."""
    chosen = shapes.distinct(structure.disc.frequency, look.shapes)
    pictures = render([shapes.assembly(structure), *(shapes.disc_mode(structure.disc, mode) for mode in chosen)])
    figures = (_pads(structure, look),)
    if pictures:
        figures = (_assembly(structure, pictures[0]), *figures, *(
            _mode(structure.disc, mode, picture) for mode, picture in zip(chosen, pictures[1:], strict=True)))
    open_share = 1.0 - structure.closed[len(structure.pressure) // 2].mean()
    return Chapter(
        "structure", "The brake: meshes, preload, modes",
        f"Finite-element bodies {', '.join(str(n).replace('_', ' ') for n in structure.body_name)}, pressed together"
        f" by the piston at {span(structure.pressure, 'Pa')}; {len(structure.contact_area)} contact patches,"
        f" {percent(open_share)} of them open at the middle pressure. {COLOURS}",
        f"The free disc has {len(structure.free_frequency)} modes up to"
        f" {quantity(structure.free_frequency.max(), 'Hz')}; squeal needs two modes of the assembled brake"
        " close together, so the frequencies below decide where it can appear. The pressure distribution of the pads"
        " shows where they would wear first.",
        figures, (_bodies(structure), _free_modes(structure)), () if pictures else (NO_PICTURES,))


def _assembly(structure, picture):
    nodes = sum(len(getattr(structure, str(name)).node) for name in structure.body_name)
    return Figure(picture, f"Meshes of the assembled brake: {nodes} nodes, {3 * nodes} displacements. Grey disc, orange"
                  " outer pad, green inner pad, blue caliper.")


def _mode(disc, mode, picture):
    return Figure(picture, f"Disc on its mount, {quantity(disc.frequency[mode], 'Hz')}, mostly"
                  f" {shapes.diameters(disc, mode)} nodal diameters.", small=True)


def _pads(structure, look):
    middle = len(structure.pressure) // 2
    told = []
    for pad in np.unique(structure.contact_body):
        here = structure.contact_body == pad
        pressure = structure.preload[middle, here] / structure.contact_area[here]
        told.append(f"{str(structure.body_name[pad]).replace('_', ' ')} {span(pressure, 'Pa')}, resultant"
                    f" {quantity(structure.preload[middle, here].sum(), 'N', 3)}")
    return Figure(preload.contact_pressure(structure, look.dpi),
                  f"Contact pressure of the pads at rest, nominal {quantity(structure.pressure[middle], 'Pa', 3)}:"
                  f" {'; '.join(told)}. Seen from the pad, the disc moves to the right; crosses: open.")


def _bodies(structure):
    bodies = [(str(name).replace("_", " "), getattr(structure, str(name))) for name in structure.body_name]
    rows = tuple((name, str(len(body.node)), str(len(body.element)), str(body.kind.item()),
                  ", ".join(f"{m} ({quantity(d, 'kg/m^3')})" for m, d in zip(
                      body.material_name, body.density, strict=True)),
                  str(len(body.frequency)), quantity(body.frequency.max(initial=0.0), "Hz"),
                  percent(body.damping_ratio)) for name, body in bodies)
    return Table(("body", "nodes", "elements", "element", "materials", "modes", "up to", "damping ratio"), rows,
                 "Bodies", (1, 2, 5, 6, 7))


def _free_modes(structure, most=20):
    rows = tuple((quantity(f, "Hz"), str(d), number(out, 2)) for f, d, out in zip(
        structure.free_frequency[:most], structure.free_diameters, structure.free_out_of_plane, strict=False))
    title = f"Free disc, first {len(rows)} of {len(structure.free_frequency)} elastic modes"
    return Table(("frequency", "nodal diameters", "axial share of modal mass"), rows, title, (0, 1, 2), folded=True)
