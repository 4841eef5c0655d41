"""Pictures of the complex modes: growth rate over frequency, over friction, over operating points."""

import numpy as np

from pipeline.views.readable import number
from pipeline.views.style import (
    COLOURS,
    FAINT,
    INK,
    LINES,
    SEQUENTIAL,
    colour_bar,
    drawing,
    legend,
    png,
    svg,
    symmetric,
    tiles,
)

TWO_PI = 2.0 * np.pi


def growth_over_frequency(modes, published, dpi):
    """PNG of all roots of the friction sweep, highest pressure; dotted lines at the ``published`` frequencies (Hz)."""
    roots = modes.root[-1]
    friction = np.broadcast_to(modes.friction[:, None], roots.shape)
    with drawing(bar=True) as figure:
        axes = figure.subplots()
        _frequency_lines(axes, published)
        axes.axhline(0.0, color=INK, lw=0.9)
        shown = axes.scatter(roots.imag / TWO_PI / 1e3, roots.real, c=friction, s=7, cmap=SEQUENTIAL, lw=0)
        axes.set(xlabel="frequency / kHz", ylabel="growth rate / 1/s", ylim=_limits(roots.real))
        colour_bar(axes, shown, "coefficient of friction")
        return png(figure, dpi)


def growth_over_friction(modes, count=6):
    """SVG of the growth rate of the ``count`` most unstable modes over friction, highest pressure."""
    return _sweep(modes, modes.root[-1].real, "growth rate / 1/s", count, zero=True)


def frequency_over_friction(modes, count=6):
    """SVG of the frequency shift of the same modes against their frequency at the lowest friction."""
    frequency = modes.root[-1].imag / TWO_PI
    return _sweep(modes, frequency - frequency[0], "frequency shift / Hz", count, zero=False)


def strongest(modes, count):
    """Roots that reach the largest growth rate within the sweep at the highest pressure, strongest first."""
    largest = modes.root[-1].real.max(axis=0)
    order = np.argsort(-largest, kind="stable")[:count]
    unstable = order[largest[order] > 0.0]
    return unstable if len(unstable) else order[:2]


def operating_growth(modes, dpi):
    """PNG of the largest growth rate at each operating point, with its frequency."""
    leading = np.argmax(modes.operating_root.real, axis=1)
    root = modes.operating_root[np.arange(len(leading)), leading]
    texts = [f"{number(r.real, 3)} 1/s\n{number(r.imag / TWO_PI / 1e3)} kHz" for r in root]
    with drawing(3.0, bar=True) as figure:
        tiles(figure.subplots(), modes.operating_pressure, modes.operating_speed, root.real, texts,
              "largest growth rate / 1/s", **symmetric(root.real))
        return png(figure, dpi)


def _sweep(modes, values, label, count, zero):
    with drawing(3.4, top=0.55) as figure:
        axes = figure.subplots()
        if zero:
            axes.axhline(0.0, color=INK, lw=0.9)
        for line, root in enumerate(strongest(modes, count)):
            frequency = modes.root[-1, -1, root].imag / TWO_PI / 1e3
            axes.plot(modes.friction, values[:, root], color=COLOURS[line % 6], ls=LINES[line % 6],
                      label=f"{frequency:.2f} kHz")
        axes.set(xlabel="coefficient of friction", ylabel=label)
        legend(axes)
        return svg(figure)


def _frequency_lines(axes, published):
    for frequency in published:
        axes.axvline(frequency / 1e3, color=FAINT, lw=1.1, ls=":")


def _limits(growth):
    low, high = np.percentile(growth, 5), growth.max()
    span = max(high - low, 1.0)
    return low - 0.05 * span, high + 0.08 * span
