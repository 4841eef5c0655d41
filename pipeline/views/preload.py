"""Pictures of the preload: contact pressure of the pads on the disc."""

import numpy as np

from pipeline.views.style import SEQUENTIAL, colour_bar, drawing, png


def contact_pressure(structure, pad, dpi):
    """PNG of the contact pressure under the pad of body number ``pad``, middle pressure; crosses where it is open."""
    state = len(structure.pressure) // 2
    here = structure.contact_pad == pad
    x, y = 1e3 * structure.contact_position[here, :2].T
    area = structure.contact_area[here]
    pressure = 1e-6 * structure.preload[state, here] / area
    is_open = structure.closed[state, here] == 0
    with drawing(3.0, bar=True) as figure:
        axes = figure.subplots()
        shown = axes.scatter(x[~is_open], y[~is_open], c=pressure[~is_open], s=_marker(x, y), cmap=SEQUENTIAL,
                             marker="s", vmin=0.0)
        axes.scatter(x[is_open], y[is_open], marker="x", color="#8a8f98", s=14)
        axes.set(xlabel="x / mm", ylabel="y / mm", aspect="equal")
        axes.margins(0.08)
        colour_bar(axes, shown, "contact pressure / MPa")
        return png(figure, dpi)


def _marker(x, y):
    """Marker area in points^2 so that the patches nearly touch."""
    width = max(np.ptp(x), np.ptp(y), 1e-9)
    return float(np.clip((220.0 / width) ** 2 * np.ptp(x) * np.ptp(y) / max(len(x), 1) * 0.6, 6.0, 400.0))
