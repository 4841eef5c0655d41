"""Picture of the convergence: growth rates of the unstable modes in refined models."""

import numpy as np

from pipeline.views.figures.style import COLOURS, INK, MARKERS, drawing, legend, svg

TWO_PI = 2.0 * np.pi


def growth_changes(convergence, names):
    """SVG: growth rate of each unstable mode (column) in the case and, by mark, in each refined model; ``names``."""
    growth, refined = convergence.root.real, convergence.refined_root.real
    allowed = np.maximum(convergence.growth_tolerance * growth, convergence.neutral)
    place = np.arange(len(growth))
    with drawing(3.2, top=0.55) as figure:
        axes = figure.subplots()
        axes.axhline(0.0, color=INK, lw=0.9)
        axes.bar(place, 2 * allowed, 0.7, growth - allowed, color="#dfeaf3", lw=0)
        axes.hlines(growth, place - 0.35, place + 0.35, color=INK, lw=1.4)
        offset = np.linspace(-0.2, 0.2, len(names)) if len(names) > 1 else np.zeros(1)
        for r, name in enumerate(names):
            seen = convergence.found[r] == 1
            axes.plot(place[seen] + offset[r], refined[r, seen], MARKERS[r], color=COLOURS[r], ms=5, label=name)
        axes.set_xticks(place, [f"{root.imag / TWO_PI / 1e3:.2f}" for root in convergence.root])
        axes.set(xlabel="frequency / kHz", ylabel="growth rate / 1/s", ylim=(min(0.0, (growth - allowed).min()), None))
        legend(axes, 2)
        return svg(figure)
