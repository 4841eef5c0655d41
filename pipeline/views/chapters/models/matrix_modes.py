"""Chapters: a system of matrices, and its complex modes."""

import numpy as np

from pipeline.views.chapters.bench.hypotheses import sentence
from pipeline.views.chapters.chapter import Block, Chapter, Figure, Table
from pipeline.views.figures.models import matrix_modes as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

TWO_PI = 2.0 * np.pi
#: unstable modes that are shown with what moves them
_SHOWN = 4
#: names in the sentence on what matters
_NAMED = 5
#: change that derivatives are told for
_TENTH = 0.1


def system(matrices, look):
    """Chapter of the product Matrices."""
    rows = tuple((name, str(term.kind), str(term.times), f"{len(term.value)}", str(term.source))
                 for name, term in matrices.terms.items())
    labels = f" at {plural(len(np.unique(matrices.node)), 'node')}" if len(matrices.node) else ""
    return Chapter(
        "matrices", "The system, as matrices",
        f"{plural(int(matrices.size), 'degree')} of freedom{labels}, in the units"
        f" of the files; terms hold for {quantity(float(matrices.reference_speed), 'rad/s')}.",
        "Speed and friction below are those over which the terms change, each over that of the matrices.", (),
        (Table(("term", "matrix", "times", "entries", "file"), rows, "Terms", (3,)),),
        tuple(map(sentence, matrices.remark)))


def chapter(modes, look):
    """Chapter of the product MatrixModes."""
    return Chapter(
        "matrix_modes", "Complex modes of the matrices",
        f"All roots up to {quantity(float(modes.highest), 'Hz')}, without reduction, at"
        f" {plural(len(modes.roots.speed), 'speed')} and friction {number(float(modes.friction), 3)} times that of the"
        " matrices.", " ".join((headline(modes)[0] + ".", certainty(modes))),
        (key_figure(modes, look), Figure(pictures.roots(modes), "Roots at the operating points; those far below 0 are"
                                                               " left out.")),
        (_table(modes),), (), _blocks(modes))


def key_figure(modes, look):
    """The figure of the first screen."""
    return Figure(pictures.stability_map(modes, look.dpi), "Largest growth rate over speed and friction; in brackets"
                  " the number of modes that grow.")


def headline(modes):
    """(sentence, tone) of the first screen."""
    found = modes.roots
    if not len(found.unstable_root):
        where = len(found.speed)
        return f"No mode up to {quantity(float(modes.highest), 'Hz')} grows at {plural(where, 'speed')}", "quiet"
    first = int(found.unstable_root.real.argmax())
    grows = len(np.unique(found.unstable_operating))
    return (f"Squeal can start at {grows} of {plural(len(found.speed), 'speed')}, most strongly at"
            f" {quantity(found.unstable_root[first].imag / TWO_PI, 'Hz')}, which grows by"
            f" {quantity(found.unstable_root[first].real, '1/s', 3)}", "squeal")


def note(modes):
    """(question, answer) pairs of the first screen."""
    return ("Where", _where(modes)), ("What matters", _matters(modes)), ("How certain", certainty(modes))


def certainty(modes):
    """What was searched, and what a mode leaves of its equation."""
    left = modes.roots.residual.max(initial=0.0)
    told = f" Unstable modes leave at most {number(left, 2)} of their equation." if len(modes.roots.residual) else ""
    return (f"No root was missed up to {quantity(float(modes.highest), 'Hz')} within"
            f" {quantity(float(modes.roots.searched), 'Hz', 3)} of the imaginary axis.{told} How fine the mesh"
            " behind the matrices is they do not say.")


def _where(modes):
    found = modes.roots
    parts = []
    for k, speed in enumerate(found.speed):
        own = found.unstable_root[found.unstable_operating == k]
        frequencies = ", ".join(quantity(f, "Hz") for f in np.sort(own.imag / TWO_PI))
        parts.append(f"{quantity(speed, 'rad/s', 3)}: {frequencies or 'none'}")
    stable = modes.map_unstable == 0
    lowest = [modes.map_friction[row].max() if row.any() else None for row in stable]
    safe = [f for f in lowest if f is not None]
    if len(safe) < len(lowest) or not all(_below(row) for row in stable):
        return "; ".join(parts) + "."
    stays = (f"up to friction {number(min(safe), 3)} times that of the matrices" if min(safe)
             else "without friction alone")
    return "; ".join(parts) + f". On the map it is stable {stays}, whatever the speed."


def _below(stable):
    """Whether what is stable is one range from the lowest friction on."""
    return bool((np.diff(stable.astype(int)) <= 0).all())


def _matters(modes):
    """What moves the most unstable mode."""
    found = modes.roots
    if not len(found.unstable_root):
        return ""
    first = int(found.unstable_root.real.argmax())
    names, change = _movers(modes, first)
    order = [0, 1, *(2 + np.argsort(-abs(change[2:])))][:_NAMED]
    parts = [f"{names[k]} {_signed(change[k])}" for k in order]
    return (f"Growth of {quantity(found.unstable_root[first].imag / TWO_PI, 'Hz')} by ten percent more of each, in 1/s:"
            f" {', '.join(parts)}.")


def _movers(modes, k):
    """(names, change of the growth rate (1/s) by a tenth more) of friction, speed and every term."""
    found = modes.roots
    raw = np.concatenate(([found.per_friction[k], found.per_speed[k]], found.per_term[k]))
    return ["friction, everywhere", "speed", *(str(name).replace("_", " ") for name in modes.term)], _TENTH * raw.real


def _signed(value):
    return ("+" if value > 0 else "\N{MINUS SIGN}" if value < 0 else "") + number(abs(value), 3)


def _table(modes):
    found = modes.roots
    rows = tuple((quantity(found.speed[p], "rad/s", 3), quantity(s.imag / TWO_PI, "Hz", 6), number(s.real, 4),
                  percent(-s.real / abs(s), 2), number(r, 2)) for p, s, r in
                 zip(found.unstable_operating, found.unstable_root, found.residual, strict=True))
    return Table(("speed", "frequency", "growth rate / 1/s", "damping ratio", "residual"), rows, "Unstable modes",
                 (0, 1, 2, 3, 4))


def _blocks(modes):
    """What moves each unstable mode, strongest first."""
    found, blocks = modes.roots, []
    for k in np.argsort(-found.unstable_root.real, kind="stable")[:_SHOWN]:
        s, names, change = found.unstable_root[k], *_movers(modes, k)
        speed = found.speed[found.unstable_operating[k]]
        title = (f"{quantity(s.imag / TWO_PI, 'Hz')} at {quantity(speed, 'rad/s', 3)}, growth rate"
                 f" {quantity(s.real, '1/s', 3)}")
        blocks.append(Block(title, "First-order change by ten percent more of each.", (Figure(
            pictures.movers(names, change), "Orange makes it grow faster, blue calms it. Terms that cancel, such as a"
            " friction that two of them hold, are to be read together.", small=True),)))
    return tuple(blocks)
