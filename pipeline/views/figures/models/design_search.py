"""Pictures of a design search: the objective of every brake in its order, and where in their ranges the values lie."""

import numpy as np

from pipeline.views.figures.style import BLUE, FAINT, GREEN, INK, drawing, legend, svg


def course(product):
    """SVG: objective of every brake in the order in which they were computed, and the smallest one so far."""
    order, tried = np.arange(len(product.brake)), product.role != "difference"
    with drawing(2.9) as figure:
        axes = figure.subplots()
        axes.plot(order, np.minimum.accumulate(product.objective), color=BLUE, lw=1.4, drawstyle="steps-post",
                  label="smallest so far")
        axes.plot(order[tried], product.objective[tried], "o", color=INK, mfc="white", ms=5, ls="",
                  label="designs of the search")
        axes.plot(order[~tried], product.objective[~tried], ".", color=FAINT, ls="", label="steps of differences")
        best = int(product.best)
        axes.plot(order[best], product.objective[best], "D", color=GREEN, ms=7, label="best", zorder=4)
        axes.set(xlabel="brake / 1", ylabel="objective / 1/s", xlim=(-0.5, len(order) - 0.5))
        axes.set_ylim(bottom=min(0.0, 1.05 * product.objective.min()))
        legend(axes, 4)
        return svg(figure)


def spread(product, names, shares):
    """SVG: of each value, in ``names``, where in its range the brakes lie, ``shares`` (brake, value); best on top."""
    with drawing(0.75 + 0.42 * len(names), left=1.98, right=0.2, top=0.12) as figure:
        axes = figure.subplots()
        for height, row in enumerate(shares.T):
            axes.plot(row, np.full(len(row), height), "|", color=FAINT, ms=9, label=f"_{names[height]}, tried")
            axes.plot(row[0], height, "o", color=INK, mfc="white", ms=6, label=f"_{names[height]}, case")
            axes.plot(row[int(product.best)], height, "D", color=GREEN, ms=7, label=f"_{names[height]}, best")
        axes.set_yticks(np.arange(len(names)), names, fontsize=9)
        axes.set(xlabel="share of the range / 1", xlim=(-0.04, 1.04), ylim=(len(names) - 0.5, -0.5))
        axes.grid(axis="y", visible=False)
        return svg(figure)
