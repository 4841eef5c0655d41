"""Pictures of orders: Campbell diagram with lines of orders, and amplitudes of orders over speed."""

import numpy as np

from pipeline.views.figures.number_format import number
from pipeline.views.figures.style import COLOURS, LINES, SEQUENTIAL, colour_bar, drawing, legend, png, svg

#: dB that a diagram shows
_RANGE = 60.0
#: orders whose lines are drawn where none stands out
_WHOLE = (1.0, 2.0, 4.0, 8.0)


def rpm(speed):
    """Revolutions per minute of a speed in rad/s."""
    return 30.0 * np.asarray(speed) / np.pi


def campbell(one, dpi):
    """PNG of the amplitude over speed and frequency of one channel; lines: orders that stand out. White: no frame."""
    shown = np.where(one.frames[:, None] > 0, one.campbell, np.nan)
    with np.errstate(divide="ignore"):
        levels = 20.0 * np.log10(shown / np.nanmax(shown))
    with drawing(3.4, bar=True, top=0.3) as figure:
        axes = figure.subplots()
        image = axes.pcolormesh(rpm(one.edge), _edges(one.frequency), levels.T, cmap=SEQUENTIAL, vmin=-_RANGE, vmax=0.0,
                                rasterized=True)
        drawn = one.outstanding if len(one.outstanding) else _WHOLE
        right = rpm(one.edge[-1])
        top = min(one.frequency[-1], 1.5 * max(*drawn, 4.0) * right / 60.0)
        for order in drawn:
            end = min(right, 60.0 * top / order)
            axes.plot([0.0, end], [0.0, order * end / 60.0], color="white", lw=0.8, ls="--",
                      label=f"_order {number(order, 3)}")
            axes.annotate(number(order, 3), (end, order * end / 60.0), (-4, 2), textcoords="offset points",
                          fontsize=8.5, color="white", ha="right")
        axes.set(xlabel="speed / rpm", ylabel="frequency / Hz", xlim=(rpm(one.edge[0]), right), ylim=(0, top))
        axes.grid(False)
        colour_bar(axes, image, "level / dB below the largest")
        return png(figure, dpi)


def _edges(frequency):
    """Ends of the cells about evenly spaced frequencies."""
    half = (frequency[1] - frequency[0]) / 2
    return np.append(frequency - half, frequency[-1] + half)


def levels(one):
    """SVG of the amplitudes of the orders that stand out over the speed."""
    middle = rpm((one.edge[1:] + one.edge[:-1]) / 2)
    used = one.blocks > 0
    with drawing(top=0.5) as figure:
        axes = figure.subplots()
        for k, (order, level) in enumerate(zip(one.outstanding, one.level, strict=True)):
            axes.plot(middle[used], level[used], color=COLOURS[k % len(COLOURS)], ls=LINES[k % len(LINES)],
                      marker="o", ms=3, label=f"order {number(order, 3)}")
        axes.set(xlabel="speed / rpm", ylabel=f"amplitude / {str(one.unit).replace('^2', '²')}", ylim=(0, None))
        legend(axes)
        return svg(figure)
