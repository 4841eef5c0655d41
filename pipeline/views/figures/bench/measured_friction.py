"""Pictures of measured friction beside the friction map."""

import numpy as np

from pipeline.views.figures.number_format import scale
from pipeline.views.figures.style import BLUE, FAINT, INK, RED, drawing, legend, svg

#: condition -> its unit
_AXES = {"pressure": "Pa", "speed": "m/s", "distance": "m", "temperature": "K"}
#: least range of a condition that is shown, over its largest value; ratio from which the axis of speed is logarithmic
_VARIES, _DECADE = 0.1, 8.0


def varied(product):
    """Names of the conditions that vary from sample to sample, at least one."""
    names = [name for name in _AXES if np.ptp(getattr(product, name)) > _VARIES * abs(getattr(product, name)).max()]
    return names or ["pressure"]


def over_conditions(product):
    """SVG: measured friction, the map and the updated map over every condition that varies."""
    names = varied(product)
    with drawing(2.6 * -(-len(names) // 2), left=0.8) as figure:
        grid = figure.subplots(-(-len(names) // 2), min(len(names), 2), squeeze=False, sharey=True).ravel()
        for axes, name in zip(grid, names, strict=False):
            unit, size = scale(abs(getattr(product, name)).max(), _AXES[name])
            at = getattr(product, name) / size
            axes.errorbar(at, product.friction, product.friction_std, fmt="none", ecolor=INK, elinewidth=0.8)
            axes.plot(at, product.friction, "o", ms=3.5, color=INK, label="measured")
            axes.plot(at, product.mapped, "x", ms=4, color=RED, label="map")
            axes.plot(at, product.unseen, "+", ms=5, color=BLUE, label="updated")
            axes.set(xlabel=f"{name} / {unit}")
            if name == "speed" and at.max() > _DECADE * at.min():
                axes.set_xscale("log")
        for axes in grid[len(names):]:
            axes.set_axis_off()
        grid[0].set_ylabel("coefficient of friction")
        legend(grid[0])
        return svg(figure)


def measured_over_predicted(product):
    """SVG: measured over predicted friction, of the map and of the updated map that did not see the sample."""
    with drawing(3.0) as figure:
        axes = figure.subplots()
        ends = np.array([0.95, 1.05]) * [min(product.friction.min(), product.mapped.min(), product.unseen.min()),
                                         max(product.friction.max(), product.mapped.max(), product.unseen.max())]
        axes.plot(ends, ends, color=FAINT, lw=1)
        axes.plot(product.mapped, product.friction, "x", ms=4, color=RED, label="map")
        axes.plot(product.unseen, product.friction, "+", ms=5, color=BLUE, label="updated")
        axes.set(xlabel="predicted coefficient of friction", ylabel="measured", xlim=ends, ylim=ends)
        legend(axes)
        return svg(figure)
