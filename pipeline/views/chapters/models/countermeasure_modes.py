"""Modes before and after a countermeasure, for the chapter: each frequency once, in words and as a table."""

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number, quantity

TWO_PI = 2.0 * np.pi
HIGHER = ("stronger", "new")
#: modes of a variant in the figure, and in the table
MODES, _ROWS = 5, 10
#: frequencies that differ by less are one mode at several operating points
_SAME = 5e-3


def name_of(product, variant):
    """Name of a variant in plain words, with a capital."""
    name = str(product.variant[variant]).replace("_", " ")
    return f"{name[:1].upper()}{name[1:]}"


def _root(product, row):
    return product.before[row] if product.before_known[row] else product.after[row]


def before_after(product, row):
    """(growth rate before, after) of a row in 1/s, None where it is not known."""
    return tuple(float(getattr(product, when)[row].real) if getattr(product, f"{when}_known")[row] else None
                 for when in ("before", "after"))


def distinct(product, variant):
    """Rows of the modes of a variant, each frequency once where it grows most before or after, strongest first; what
    is worse at some operating point is shown there."""
    rows = np.flatnonzero(product.mode_variant == variant)
    size = [max(g for g in before_after(product, row) if g is not None) for row in rows]
    worse = [product.state[row] in HIGHER for row in rows]
    order = sorted(range(len(rows)), key=lambda k: (not worse[k], -size[k]))
    chosen = []
    for k in order:
        frequency = _root(product, rows[k]).imag
        if all(abs(_root(product, row).imag / frequency - 1) > _SAME for row in chosen):
            chosen.append(int(rows[k]))
    return sorted(chosen, key=lambda row: -max(g for g in before_after(product, row) if g is not None))


def in_words(product, row):
    """'11.2 kHz, 10 to 45 1/s at 3 MPa and 12 rad/s' of a mode that became worse."""
    before, after = before_after(product, row)
    frequency = quantity(product.after[row].imag / TWO_PI, "Hz", 4)
    point = product.mode_operating[row]
    at = f"at {quantity(product.pressure[point], 'Pa', 3)} and {quantity(product.speed[point], 'rad/s')}"
    was = "from a growth rate not known" if before is None else f"growth rate {number(before, 3)}"
    new = "a new unstable mode, " if product.state[row] == "new" else ""
    return f"{new}{frequency}, {was} to {quantity(after, '1/s', 3)} {at}"


def modes_table(product):
    """The table of modes before and after; none where no mode is unstable."""
    rows = [_cells(product, k, row) for k in range(len(product.variant)) for row in distinct(product, k)[:_ROWS]]
    if not rows:
        return ()
    head = ("countermeasure", "state", "before", "growth / 1/s", "damping ratio / %", "after", "growth / 1/s",
            "damping ratio / %", "MAC", "at all operating points", "shown at")
    title = (f"Unstable modes before and after, each frequency once where it grows most, up to {_ROWS} of each"
             " countermeasure; all are in countermeasures.csv")
    return (Table(head, tuple(rows), title, tuple(range(2, 9))),)


def _cells(product, variant, row):
    """Cells of one mode."""
    point, mac = product.mode_operating[row], number(product.mac[row], 2)
    if not product.clear[row]:
        mac = f"{mac} (also {number(product.rival_mac[row], 2)})" if product.rival_mac[row] > 0 else f"{mac}, unclear"
    return (str(product.variant[variant]), str(product.state[row]), *_of_root(product, "before", row),
            *_of_root(product, "after", row), mac, _everywhere(product, variant, row),
            f"{quantity(product.pressure[point], 'Pa', 3)}, {quantity(product.speed[point], 'rad/s')}")


def _of_root(product, when, row):
    if not getattr(product, f"{when}_known")[row]:
        return "not known", "", ""
    root = getattr(product, when)[row]
    return quantity(root.imag / TWO_PI, "Hz", 4), number(root.real, 3), number(-100 * root.real / abs(root), 2)


def _everywhere(product, variant, row):
    """'3 gone, 1 weaker': what becomes of the modes of this frequency at all operating points."""
    rows = np.flatnonzero(product.mode_variant == variant)
    near = [k for k in rows if abs(_root(product, k).imag / _root(product, row).imag - 1) <= _SAME]
    states = product.state[near]
    return ", ".join(f"{np.sum(states == s)} {s}" for s in dict.fromkeys(states))
