"""Picture of the convergence: growth rates of the unstable modes in the reduced and in the finer model."""

import numpy as np

from pipeline.views.figures.style import COLOURS, INK, MARKERS, drawing, legend, svg

TWO_PI = 2.0 * np.pi


def growth_changes(convergence):
    """SVG: growth rate of each unstable mode (column) in the case and, by mark, in its reduced and the finer model."""
    growth, place = convergence.root.real, np.arange(len(convergence.root))
    allowed = np.maximum(convergence.growth_tolerance * growth, convergence.neutral)
    models = (("reduced model", convergence.reduced_root.real, np.ones(len(growth), bool)),
              ("finer model", convergence.refined_root.real, convergence.found == 1))
    least = min(0.0, (growth - allowed).min(), *(values.min() for _, values, _ in models))
    with drawing(3.2, top=0.55) as figure:
        axes = figure.subplots()
        axes.axhline(0.0, color=INK, lw=0.9)
        axes.bar(place, 2 * allowed, 0.7, growth - allowed, color="#dfeaf3", lw=0)
        axes.hlines(growth, place - 0.35, place + 0.35, color=INK, lw=1.4)
        for r, (name, values, seen) in enumerate(models):
            axes.plot(place[seen] + 0.2 * r - 0.1, values[seen], MARKERS[r], color=COLOURS[r], ms=5, label=name)
        axes.set_xticks(place, [f"{root.imag / TWO_PI / 1e3:.2f}" for root in convergence.root])
        axes.set(xlabel="frequency / kHz", ylabel="growth rate / 1/s", ylim=(least, None))
        legend(axes, 2)
        return svg(figure)
