"""Pictures of the latent force: what it follows, and what it predicts where that was asked."""

import numpy as np

from pipeline.views.figures.bench.diagnosis import excerpt
from pipeline.views.figures.number_format import scale
from pipeline.views.figures.style import BLUE, FAINT, ORANGE, RED, drawing, svg


def latent_force(product, name):
    """SVG: the missing force of one run over displacement and over velocity at the place, with mean curves."""
    force = product.latent[name]
    unit, size = scale(np.abs(force.force).max(), "N")
    with drawing(2.9, left=0.72) as figure:
        panes = figure.subplots(1, 2, sharey=True)
        figure.subplots_adjust(wspace=0.12)
        for axes, (what, short) in zip(panes, (("displacement", "m"), ("velocity", "m/s")), strict=True):
            values, follows = getattr(force, what), product.follows[what]
            name_of, across = scale(np.abs(values).max(), short)
            axes.plot(values / across, force.force / size, ".", ms=2, color=FAINT, alpha=0.6, rasterized=False)
            axes.plot(follows.centre / across, follows.curve / size, color=RED, marker="o", ms=3.5)
            axes.set(xlabel=f"{what} / {name_of}")
            axes.set_title(f"explains {100 * float(follows.share):.0f} %", loc="left", pad=3)
        panes[0].set_ylabel(f"missing force / {unit}")
        return svg(figure)


def with_latent_force(product, name, channel=0):
    """SVG: an excerpt of one channel of a held-out run about its largest motion, predicted without and with the force;
    below, what either leaves."""
    return excerpt(product, name, channel, (
        ("recalibrated", product.runs[name].recalibrated, ORANGE, "--"),
        ("with the latent force", product.latent_predicted[name].predicted, BLUE, "-")))
