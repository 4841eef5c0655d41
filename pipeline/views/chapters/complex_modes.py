"""Chapter: complex modes in steady sliding."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.structure import COLOURS, NO_PICTURES
from pipeline.views.chapters.unstable_modes import blocks, distinct_unstable, signed, summed, words
from pipeline.views.figures import complex_modes as pictures
from pipeline.views.figures import mode_shapes
from pipeline.views.figures.number_format import number, percent, quantity, span
from pipeline.views.figures.plotted.picture import in_space
from pipeline.views.figures.scene import render

TWO_PI = 2.0 * np.pi
MAP_CAPTION = "Largest growth rate at each operating point, and its frequency. Above zero, steady sliding is unstable."
#: heads of columns for terms of the growth rate
_SHORT = {"friction turning with the slip": "turning slip", "friction over slip speed": "slip speed"}
_FRICTION = "friction at "
NEUTRAL = 1e-6     # growth rates below this fraction of the angular frequency are rounding


def chapter(modes, model, published, look):
    """Chapter of the product ComplexModes; ``model`` gives the surface for the shapes, or is None."""
    drawable = model is not None and len(model.visible_face)
    chosen = list(map(int, modes.followed_mode)) if drawable and look.shapes else []
    scenes = [mode_shapes.unstable_mode(model, modes, index) for index in chosen]
    rendered = in_space(scenes, render(scenes))
    pictures = dict(zip(chosen, rendered or (), strict=False))
    return Chapter(
        "complex_modes", "Stability of steady sliding",
        "Complex modes with sliding friction: a mode with a positive growth rate grows until a nonlinearity"
        f" limits it. Friction is swept over {span(modes.friction, '1')} at"
        f" {span(modes.pressure, 'Pa')}; {modes.corrections.item()} static friction corrections complete the modal"
        f" basis.{f' {COLOURS}' if drawable else ''}",
        _conclusion(modes), _maps(modes, published, look), _table(modes),
        (NO_PICTURES,) if rendered is None else (), blocks(modes, model, pictures, look))


def onset(modes):
    """Lowest friction of the sweep with an unstable root, per pressure; None where all are stable."""
    unstable = (modes.root.real > NEUTRAL * np.abs(modes.root)).any(axis=2)
    return [modes.friction[np.argmax(row)] if row.any() else None for row in unstable]


def _conclusion(modes):
    unstable = distinct_unstable(modes, len(modes.unstable_root))
    if not unstable:
        return "All modes are damped at every operating point: no squeal from mode coupling at the computed friction."
    strongest = modes.unstable_root[0]
    starts = [f"{number(mu, 3)} at {quantity(p, 'Pa', 3)}" for mu, p in zip(onset(modes), modes.pressure, strict=True)
              if mu is not None]
    amount = "One frequency is" if len(unstable) == 1 else f"{len(unstable)} different frequencies are"
    return (f"{amount} unstable at the operating points; the most unstable,"
            f" {quantity(strongest.imag / TWO_PI, 'Hz')}, has a growth rate of {quantity(strongest.real, '1/s', 3)}. In"
            f" the sweep the first instability appears at friction {', '.join(starts) or 'beyond its range'}. A growth"
            " rate shows that squeal can start, not how loud it becomes.")


def _maps(modes, published, look):
    note = " Dotted: squeal frequencies measured in the paper." if len(published) else ""
    pressure = quantity(modes.pressure[-1], "Pa", 3)
    return (
        Figure(pictures.growth_over_frequency(modes, published, look.dpi),
               f"All modes of the friction sweep at {pressure}; colour: friction. Above zero: unstable;"
               f" strongly damped modes lie below the axis.{note}"),
        Figure(pictures.operating_growth(modes, look.dpi),
               "Largest growth rate at each operating point, with its friction"
               f" ({span(modes.operating_friction, '1')})."),
        Figure(pictures.growth_over_friction(modes),
               f"Growth rate over friction of the least stable modes at {pressure}: a mode becomes"
               " unstable where its line crosses zero."),
        Figure(pictures.lock_in(modes),
               "Frequencies around the most unstable of them; large red dots: unstable. Two lines that merge and stay"
               " together are modes coupled by friction."))


def _table(modes, most=12):
    chosen = distinct_unstable(modes, most)
    if not chosen:
        return ()
    rows = []
    for index in chosen:
        root, point = modes.unstable_root[index], modes.unstable_operating[index]
        rows.append((quantity(root.imag / TWO_PI, "Hz", 5), quantity(root.real, "1/s", 3),
                     number(-root.real / abs(root) * 100, 2), quantity(modes.operating_pressure[point], "Pa", 3),
                     quantity(modes.operating_speed[point], "rad/s"), number(modes.operating_friction[point], 3),
                     str(modes.operating_open[point])))
    head = "frequency", "growth rate", "damping ratio / %", "pressure", "speed", "friction", "open contacts"
    title = ("Unstable modes, most unstable first, each frequency once; damping ratio: \N{MINUS SIGN}Re s/|s| of the"
             " eigenvalue s, half of what Abaqus and Nastran print")
    return (Table(head, tuple(rows), title, tuple(range(7))), _shapes(modes, chosen), _reasons(modes, chosen),
            *_in_full(modes, chosen))


def _shapes(modes, chosen):
    """What moves in each mode: the disc in and out of its plane, and each body."""
    disc = (modes.unstable_diameters[list(chosen)] >= 0).any()
    rows = []
    for k in chosen:
        planes = (str(modes.unstable_in_plane[k]), str(modes.unstable_out_of_plane[k]),
                  percent(modes.unstable_axial[k], 2)) if disc else ()
        rows.append((quantity(modes.unstable_root[k].imag / TWO_PI, "Hz", 5), *planes,
                     *(number(100 * share, 2) for share in modes.unstable_share[k])))
    head = ("frequency", *("diameters in plane", "diameters out of plane", "disc motion out of plane") * bool(disc),
            *(f"{words(name)} / %" for name in modes.body_name))
    of_disc = ("nodal diameters of the disc in and out of its plane, the share out of plane of its squared motion, and"
               " the " if disc else "")
    return Table(head, tuple(rows), f"What moves in them: {of_disc}share of each body in the kinetic energy",
                 tuple(range(len(head))))


def _reasons(modes, chosen):
    """What feeds or dissipates the energy of each mode."""
    rows = [(quantity(modes.unstable_root[k].imag / TWO_PI, "Hz", 4), *map(signed, summed(modes, k)[1]))
            for k in chosen]
    head = ("frequency", *(_SHORT.get(t, words(t).replace(_FRICTION, "at ")) for t in summed(modes, chosen[0])[0]))
    title = ("What feeds them (+) and what dissipates (\N{MINUS SIGN}): parts of the growth rate in 1/s, first"
             " of friction at each body")
    return Table(head, tuple(rows), title, tuple(range(len(head))))


def _in_full(modes, chosen):
    """Residuals of modes on the full finite-element matrices, and how far the reduced model is; none without these."""
    root, reduced, residual = modes.unstable_root, modes.unstable_reduced, modes.unstable_residual
    solved = residual >= 0
    if not solved[list(chosen)].any():
        return ()
    frequency, growth = reduced.imag / root.imag - 1, reduced.real - root.real
    rows = [(quantity(root[k].imag / TWO_PI, "Hz", 5), quantity(root[k].real, "1/s", 4),
             quantity(reduced[k].real, "1/s", 4), f"{100 * frequency[k]:+.3f}".replace("-", "\N{MINUS SIGN}"),
             f"{residual[k]:.0e}") for k in chosen if solved[k]]
    head = "frequency", "growth rate", "in the reduced model", "its frequency / %", "residual"
    farthest = percent(abs(frequency[solved]).max(), 2), quantity(abs(growth[solved]).max(), "1/s", 2)
    title = ("The same modes solved for on the full finite-element matrices, with their residuals over the stiffness"
             f" forces; at all operating points the reduced model is within {' and '.join(farthest)} of these")
    return (Table(head, tuple(rows), title, tuple(range(5))),)
