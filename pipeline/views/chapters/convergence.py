"""Chapter: do unstable modes stay where they are when contact, meshes and bases are refined?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures import convergence as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

TWO_PI = 2.0 * np.pi
#: refinement -> what it is called
WORDS = {"contact": "contact points", "pad_mesh": "mesh of the pads", "disc_mesh": "mesh of the disc",
         "bases": "bases of the reduced model"}


def chapter(convergence, look):
    """Chapter of the product Convergence."""
    there = f"{quantity(convergence.pressure, 'Pa', 3)} and {quantity(convergence.speed, 'rad/s')}"
    return Chapter(
        "convergence", "Convergence of the unstable modes",
        f"Contact points ({convergence.contacts.item()} in this case), meshes of pads and disc, and the bases of the"
        f" reduced model, refined in turn at {there}. Friction map, interface law and joints stay the same: their"
        " errors are not judged here." + " Nor is the mesh of the disc." * ("disc_mesh" not in convergence.refinement),
        statement(convergence), _figures(convergence), _table(convergence))


def statement(convergence):
    """One sentence: converged and how far, or not and where."""
    allowed = (f"{percent(convergence.frequency_tolerance, 2)} of a frequency, and"
               f" {percent(convergence.growth_tolerance)} or {quantity(convergence.neutral, '1/s')} of a growth rate")
    if not len(convergence.root):
        found = int(convergence.added.max(initial=0))
        return (f"Not converged: refined models have up to {plural(found, 'unstable mode')}, this one none." if found
                else "Converged: no mode is unstable in any of the refined models either.")
    if convergence.converged.item():
        return (f"Converged: every refinement leaves the same unstable modes, their frequencies within"
                f" {percent(convergence.frequency_change, 2)} and growth rates within"
                f" {percent(convergence.growth_share, 2)} ({quantity(convergence.growth_change, '1/s', 2)}).")
    return f"Not converged within {allowed}: {'; '.join(_differences(convergence))}."


def _differences(convergence):
    """What each refinement changes beyond the tolerances."""
    for r, name in enumerate(convergence.refinement):
        lost = [k for k in range(len(convergence.root)) if not convergence.held[r, k]]
        parts = [_difference(convergence, r, k) for k in lost[:3]]
        parts += [f"{plural(len(lost) - 3, 'more mode')} changed"] if len(lost) > 3 else []
        parts += [f"{plural(int(convergence.added[r]), 'further unstable mode')}"] if convergence.added[r] else []
        if parts:
            yield f"{WORDS[str(name)]} ({', '.join(parts)})"


def _difference(convergence, refinement, mode):
    root, refined = convergence.root[mode], convergence.refined_root[refinement, mode]
    where = quantity(root.imag / TWO_PI, "Hz")
    if not convergence.found[refinement, mode]:
        return f"{where} is gone"
    return f"{where}: {number(root.real, 3)} becomes {number(refined.real, 3)} 1/s"


def _figures(convergence):
    if not len(convergence.root):
        return ()
    names = [WORDS[str(name)] for name in convergence.refinement]
    return (Figure(pictures.growth_changes(convergence, names),
                   "Growth rate of each unstable mode in this case (line) and in the refined models (marks); band:"
                   f" {percent(convergence.growth_tolerance)} or {quantity(convergence.neutral, '1/s')}."),)


def _table(convergence):
    if not len(convergence.root):
        return ()
    head = ("frequency", "growth rate", *(WORDS[str(name)] for name in convergence.refinement))
    rows = []
    for k, root in enumerate(convergence.root):
        cells = [_cell(convergence, r, k) for r in range(len(convergence.refinement))]
        rows.append((quantity(root.imag / TWO_PI, "Hz", 5), quantity(root.real, "1/s", 3), *cells))
    added = ("further unstable modes", "", *(str(int(a)) for a in convergence.added))
    points = ("contact points", str(convergence.contacts.item()), *(str(int(c)) for c in convergence.refined_contacts))
    title = "Unstable modes, and how they change with each refinement: frequency in %, growth rate in 1/s"
    return (Table(head, (*rows, added, points), title, tuple(range(1, len(head)))),)


def _cell(convergence, refinement, mode):
    if not convergence.found[refinement, mode]:
        return "gone"
    root, refined = convergence.root[mode], convergence.refined_root[refinement, mode]
    text = f"{100 * (refined.imag / root.imag - 1):+.2f} %, {refined.real - root.real:+.1f}"
    return text.replace("-", "\N{MINUS SIGN}")
