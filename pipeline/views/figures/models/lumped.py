"""Diagram of a lumped system: its coordinates as boxes, below each a line; every part as a row that meets its lines."""

import numpy as np

from pipeline.views.figures.style import BLUE, FAINT, GREEN, INK, ORANGE, RED, drawing, svg

#: kind of a row: colour
_COLOUR = {"spring": BLUE, "damper": GREEN, "contact": ORANGE, "input": RED, "sensor": FAINT}
#: x of the ground, from which parts with one coordinate start
_GROUND = -0.8


def diagram(lumped):
    """SVG of the product Lumped; left bar: ground, zigzag: spring, box: damper, thick: contact, arrow: input."""
    names, parts = lumped.coordinate_name, list(_parts(lumped))
    with drawing(1.25 + 0.34 * len(parts), left=0.3, right=1.45, top=0.55) as figure:
        axes = figure.subplots()
        axes.plot([_GROUND] * 2, [0.4, -len(parts)], color=INK, lw=4)
        for column, name in enumerate(names):
            axes.plot([column] * 2, [0, -len(parts)], color=FAINT, lw=0.8, zorder=0)
            axes.text(column, 0.2, name, ha="center", va="bottom", fontsize=9,
                      bbox={"boxstyle": "square,pad=0.3", "fc": "white", "ec": INK})
        for number, (kind, name, row) in enumerate(parts, 1):
            _part(axes, kind, -number + 0.4, row)
            axes.text(len(names) - 0.6, -number + 0.4, name, va="center", fontsize=9, color=INK)
        axes.set(xlim=(_GROUND - 0.1, len(names) - 0.65), ylim=(-len(parts) - 0.2, 1.1))
        axes.axis("off")
        return svg(figure)


def _parts(lumped):
    """(kind, name, row (n,)) of everything that connects coordinates."""
    for name, row, stiffness in zip(lumped.joint_name, lumped.joint_rows, lumped.joint_stiffness, strict=True):
        yield ("spring" if stiffness else "damper"), name, row
    for name, normal, tangent in zip(lumped.contact_name, lumped.contact_normal, lumped.contact_tangent, strict=True):
        yield "contact", name, abs(normal) + abs(tangent)
    for kind in ("input", "sensor"):
        for name, row in zip(getattr(lumped, f"{kind}_name"), getattr(lumped, f"{kind}_rows"), strict=True):
            yield kind, name, row


def _part(axes, kind, height, row):
    """One row: from coordinate to coordinate, or from the ground to the only one."""
    met, colour = np.flatnonzero(row), _COLOUR[kind]
    grounded = len(met) == 1 and kind in ("spring", "damper", "contact")
    begin, end = (_GROUND if grounded else met.min(), met.max()) if len(met) else (0, 0)
    along = np.array([begin, end], float)
    if kind == "spring" and end > begin:
        along = np.r_[begin, np.linspace(begin + 0.2, end - 0.2, 13), end]
    wave = np.zeros(len(along))
    wave[2:-2] = 0.16 * np.where(np.arange(len(along) - 4) % 2, 1.0, -1.0) if len(along) > 4 else 0.0
    axes.plot(along, height + wave, color=colour, lw=4 if kind == "contact" else 1.4, solid_capstyle="butt")
    if kind == "damper":
        axes.plot([(begin + end) / 2], [height], "s", color=colour, ms=8, mfc="white")
    for column in met:
        marker = {"input": ">" if row[column] > 0 else "<"}.get(kind, "o")
        axes.plot([column], [height], marker, color=colour, ms=8 if kind == "input" else 5)
