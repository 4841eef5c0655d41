"""Pictures of the beam on beam: frequencies over friction, two roots in the complex plane, scatter of the motion."""

import numpy as np

from pipeline.views.figures.models.transient import STATUS
from pipeline.views.figures.style import (
    BLUE,
    COLOURS,
    FAINT,
    GREEN,
    INK,
    LINES,
    MARKERS,
    ORANGE,
    RED,
    drawing,
    legend,
    png,
)

TWO_PI = 2.0 * np.pi
#: upper end of the friction sweep in the paper
MOST_FRICTION = 0.5


def frequencies_over_friction(beams, modes, printed, dpi):
    """PNG in the manner of Figure 3: sliding modes over friction; rings where they are unstable (with damping).

    ``printed`` (friction, frequency in Hz) are the coalescences given in the text of the paper.
    """
    with drawing(4.2, top=0.62) as figure:
        axes = figure.subplots()
        inside = (beams.curve_friction >= 0) & (beams.curve_friction <= MOST_FRICTION)
        axes.plot(beams.curve_friction[inside], beams.curve_frequency[inside] / 1e3, ".", color=BLUE, ms=1.5,
                  label="undamped mode")
        if modes is not None:
            root = modes.root[0]
            friction = np.broadcast_to(modes.friction[:, None], root.shape)
            axes.plot(friction.ravel(), root.imag.ravel() / TWO_PI / 1e3, ".", color=FAINT, ms=1.5, zorder=0)
            grows = (root.real > 1e-6 * abs(root)) & (root.imag < TWO_PI * 10e3) & (root.imag > 0)
            axes.plot(friction[grows], root.imag[grows] / TWO_PI / 1e3, "o", mfc="none", mec=RED, ms=4, lw=0,
                      label="unstable")
        shown = beams.onset_friction <= MOST_FRICTION
        axes.plot(beams.onset_friction[shown], beams.onset_frequency[shown] / 1e3, "D", color=INK, ms=5,
                  label="coalescence")
        if len(printed[0]):
            axes.plot(printed[0], np.divide(printed[1], 1e3), "*", color=ORANGE, mec=INK, ms=10, lw=0,
                      label="text of the paper")
        axes.set(xlabel="coefficient of friction", ylabel="frequency / kHz", xlim=(0, MOST_FRICTION), ylim=(0, 10))
        legend(axes, columns=2)
        return png(figure, dpi)


def complex_plane(modes, printed, dpi):
    """PNG in the manner of Figure 4: the two roots that meet between 2 and 3.5 kHz, growth over frequency.

    ``printed`` Hz are the two modes without friction given in the text of the paper.
    """
    root = modes.root[0]
    start = root[0].imag / TWO_PI
    pair = [b for b in np.argsort(start) if 2e3 < start[b] < 3.5e3]
    with drawing(3.4, left=0.86, bar=True) as figure:
        axes = figure.subplots()
        axes.axhline(0.0, color=INK, lw=0.9)
        for line, branch in enumerate(pair):
            shown = axes.scatter(root[:, branch].imag / TWO_PI / 1e3, root[:, branch].real, c=modes.friction, s=12,
                                 marker=MARKERS[line % 6], cmap="viridis", lw=0)
        axes.plot(np.divide(printed, 1e3), np.zeros(len(printed)), "*", color=ORANGE, mec=INK, ms=10, lw=0)
        axes.set(xlabel="frequency / kHz", ylabel="growth rate / 1/s")
        if pair:
            figure.colorbar(shown, ax=axes, label="coefficient of friction", fraction=0.045, pad=0.03, aspect=24)
        return png(figure, dpi)


def scatter(product, printed, dpi):
    """PNG of fundamental, peak force and peak slip of every run: colour and marker denote formulation and step.

    ``printed`` are the three values (kHz, N, mm/s; each a list, empty where unknown) of the paper's text: dotted.
    """
    kinds = list(dict.fromkeys(zip(product.formulation, product.step, strict=True)))
    quantities = ((product.fundamental / 1e3, "line / kHz"), (product.peak_force, "force / N"),
            (1e3 * product.peak_slip, "slip / mm/s"))
    with drawing(4.6, top=0.75) as figure:
        panels = figure.subplots(3, 1, sharex=True)
        for number, (formulation, step) in enumerate(kinds):
            same_kind = (product.formulation == formulation) & (product.step == step)
            for axes, (values, label) in zip(panels, quantities, strict=True):
                axes.plot(product.seed[same_kind], values[same_kind], MARKERS[number % 6], color=COLOURS[number % 6],
                          label=f"{formulation}, {1e6 * step:.3g} µs")
                axes.set(ylabel=label)
        for axes, values in zip(panels, printed, strict=True):
            for value in values:
                axes.axhline(value, color=INK, lw=1.0, ls=":")
        panels[-1].set(xlabel="seed")
        panels[-1].set_xticks(np.unique(product.seed))
        legend(panels[0], columns=2)
        return png(figure, dpi)


def status_shares(product, dpi):
    """PNG of the fractions of time with open, sticking and sliding contact in every run."""
    with drawing(2.8, top=0.4) as figure:
        axes = figure.subplots()
        base = np.zeros(len(product.seed))
        for kind, (name, colour) in enumerate(STATUS):
            axes.bar(np.arange(len(base)), product.status_share[:, kind], bottom=base, color=colour, label=name)
            base = base + product.status_share[:, kind]
        axes.axhline(0.1, color=INK, lw=0.8, ls=LINES[3])
        axes.set(xlabel="run", ylabel="fraction of time", ylim=(0, 1))
        legend(axes)
        return png(figure, dpi)


def spread(geometry, dpi):
    """PNG of the spread of each parameter among the geometries that fit, as a part of the bounds of the search."""
    from pipeline.views.figures.number_format import number

    size = geometry.upper_bound - geometry.lower_bound
    low, high, best = ((values - geometry.lower_bound) / size for values in
                       (*np.quantile(geometry.samples, [0.05, 0.95], axis=0), geometry.best[:len(size)]))
    with drawing(0.9 + 0.3 * len(low), left=1.9) as figure:
        axes = figure.subplots()
        rows = np.arange(len(low))[::-1]
        axes.hlines(rows, low, high, color=GREEN, lw=4)
        axes.plot(best, rows, "D", color=INK, ms=4)
        axes.set_yticks(rows, [f"{name} = {number(value, 3)}" for name, value in
                                zip(geometry.sampled_parameter, geometry.best[:len(size)], strict=True)])
        axes.set(xlabel="position within the search bounds", xlim=(0, 1))
        return png(figure, dpi)
