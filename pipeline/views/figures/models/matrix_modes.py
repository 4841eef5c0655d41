"""Pictures of a system of matrices: its map of stability, its roots, what moves those that grow."""

import numpy as np

from pipeline.views.figures.number_format import number, quantity
from pipeline.views.figures.style import (
    BLUE,
    COLOURS,
    INK,
    MARKERS,
    ORANGE,
    colour_bar,
    drawing,
    legend,
    png,
    readable_on,
    svg,
    symmetric,
)

TWO_PI = 2.0 * np.pi
#: cells of a map that numbers are written into, along either side
_WRITTEN = 8


def stability_map(modes, dpi):
    """PNG of the largest growth rate over speed and friction, with the number of modes that grow."""
    with drawing(3.4, bar=True) as figure:
        axes = figure.subplots()
        grid = modes.map_growth.T
        shown = axes.imshow(grid, origin="lower", aspect="auto", **symmetric(grid))
        axes.set_xticks(range(len(modes.map_speed)), [number(v, 3) for v in modes.map_speed])
        axes.set_yticks(range(len(modes.map_friction)), [number(f, 3) for f in modes.map_friction])
        axes.set(xlabel="speed / rad/s", ylabel="friction / that of the matrices")
        axes.grid(False)
        if max(grid.shape) <= _WRITTEN:
            for (row, column), value in np.ndenumerate(grid):
                count = int(modes.map_unstable[column, row])
                axes.text(column, row, f"{number(value, 3)}\n({count})" if count else "stable", ha="center",
                          va="center", fontsize=8, linespacing=1.1, color=readable_on(shown, value))
        colour_bar(axes, shown, "largest growth rate / 1/s")
        return png(figure, dpi)


def roots(modes):
    """SVG of the roots at the operating points, growth rate over frequency."""
    found = modes.roots
    with drawing(3.2, left=0.86, top=0.55) as figure:
        axes = figure.subplots()
        axes.axhline(0.0, color=INK, lw=0.9)
        for k, speed in enumerate(found.speed):
            own = found.root[found.root_operating == k]
            axes.plot(own.imag / TWO_PI, own.real, MARKERS[k % 6], color=COLOURS[k % 6], mfc="none",
                      label=quantity(speed, "rad/s", 3))
        highest = max(found.root.real.max(initial=0.0), 1.0)
        axes.set(xlabel="frequency / Hz", ylabel="growth rate / 1/s", xlim=(0, float(modes.highest)),
                 ylim=(max(found.root.real.min(initial=0.0), -3 * highest) * 1.05, 1.15 * highest))
        legend(axes)
        return svg(figure)


def movers(names, values):
    """SVG of the change of a growth rate (1/s) by ten percent more of each of ``names``, largest on top."""
    order = np.argsort(abs(values))
    with drawing(0.9 + 0.3 * len(order), left=1.9) as figure:
        axes = figure.subplots()
        axes.axvline(0.0, color=INK, lw=0.9)
        colours = [ORANGE if v > 0 else BLUE for v in values[order]]
        axes.barh(range(len(order)), values[order], color=colours, height=0.65)
        axes.set_yticks(range(len(order)), [names[k] for k in order])
        axes.set(xlabel="change by 10 % more / 1/s")
        axes.grid(axis="y", visible=False)
        return svg(figure)
