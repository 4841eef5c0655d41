"""Pictures of the complex modes: growth rate over frequency, over friction, over operating points."""

import numpy as np

from pipeline.views.figures.number_format import number
from pipeline.views.figures.style import (
    COLOURS,
    FAINT,
    INK,
    LINES,
    RED,
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
    name, size = _unit(roots)
    with drawing(left=0.86, bar=True) as figure:
        axes = figure.subplots()
        _frequency_lines(axes, published, size)
        axes.axhline(0.0, color=INK, lw=0.9)
        shown = axes.scatter(roots.imag / TWO_PI / size, roots.real, c=friction, s=7, cmap=SEQUENTIAL, lw=0)
        low, high = _limits(roots.real)
        last = 1.03 * roots.imag[roots.real >= low].max() / TWO_PI / size
        axes.set(xlabel=f"frequency / {name}", ylabel="growth rate / 1/s", ylim=(low, high), xlim=(0, last or 1))
        colour_bar(axes, shown, "coefficient of friction")
        return png(figure, dpi)


def growth_over_friction(modes, count=6):
    """SVG of the growth rate of the ``count`` most unstable modes over friction, highest pressure."""
    name, size = _unit(modes.root[-1])
    with drawing(3.4, top=0.55) as figure:
        axes = figure.subplots()
        axes.axhline(0.0, color=INK, lw=0.9)
        for line, branch in enumerate(strongest(modes, count)):
            frequency = modes.root[-1, -1, branch].imag / TWO_PI / size
            axes.plot(modes.friction, modes.root[-1, :, branch].real, color=COLOURS[line % 6], ls=LINES[line % 6],
                      label=f"{frequency:.2f} {name}")
        axes.set(xlabel="coefficient of friction", ylabel="growth rate / 1/s")
        legend(axes)
        return svg(figure)


def lock_in(modes, width=0.05):
    """SVG of all frequencies within ``width`` of the strongest unstable mode over friction; red where unstable."""
    roots = modes.root[-1]
    name, size = _unit(roots)
    middle = roots[np.argmax(roots[:, strongest(modes, 1)[0]].real), strongest(modes, 1)[0]].imag / TWO_PI / size
    frequency, reach = roots.imag / TWO_PI / size, max(width * middle, np.finfo(float).tiny)
    near = (np.abs(frequency - middle) < reach).any(axis=0)
    with drawing(3.4) as figure:
        axes = figure.subplots()
        axes.plot(modes.friction, frequency[:, near], ".", color=FAINT, ms=3.5, label="_mode")
        axes.plot(modes.friction, np.where(roots.real > 0.0, frequency, np.nan)[:, near], "o", color=RED, ms=5.5,
                  label="_unstable")
        axes.set(xlabel="coefficient of friction", ylabel=f"frequency / {name}",
                 ylim=(middle * (1 - width), middle * (1 + width)) if middle else None)
        return svg(figure)


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
    name, size = _unit(root)
    texts = [f"{number(r.real, 3)} 1/s\n{number(r.imag / TWO_PI / size)} {name}" for r in root]
    with drawing(3.0, bar=True) as figure:
        tiles(figure.subplots(), modes.operating_pressure, modes.operating_speed, root.real, texts,
              "largest growth rate / 1/s", **symmetric(root.real))
        return png(figure, dpi)


def _unit(roots):
    """(name, size in Hz) of the unit in which the frequencies of ``roots`` read best."""
    return ("kHz", 1e3) if roots.imag.max() > TWO_PI * 1e3 else ("Hz", 1.0)


def _frequency_lines(axes, published, size):
    for frequency in published:
        axes.axvline(frequency / size, color=FAINT, lw=1.1, ls=":")


def _limits(growth):
    """The unstable roots and as much again of the damped ones, three times over."""
    highest = max(growth.max(), 0.05 * np.abs(np.median(growth)), 1.0)
    return max(growth.min(), -3.0 * highest), 1.1 * highest
