"""Picture of the preload: contact pressure of the pads on the disc."""

import numpy as np

from pipeline.views.style import FAINT, SEQUENTIAL, colour_bar, drawing, png


def contact_pressure(structure, dpi):
    """PNG of the contact pressure under every pad at the middle pressure; crosses where a patch is open.

    Along sliding and radius, as seen from the pad: the disc moves to the right.
    """
    state, pads = len(structure.pressure) // 2, np.unique(structure.contact_body)
    pressure = 1e-6 * structure.preload[state] / structure.contact_area
    with drawing(0.6 + 1.5 * len(pads), top=0.3, bar=True) as figure:
        grid = figure.subplots(len(pads), sharex=True, squeeze=False)[:, 0]
        for axes, pad in zip(grid, pads, strict=True):
            here = structure.contact_body == pad
            shown = _patches(axes, structure, here, pressure, structure.closed[state] == 1)
            axes.set(ylabel="radius / mm", aspect="equal")
            axes.set_title(str(structure.body_name[pad]).replace("_", " "), loc="left", pad=3)
        grid[-1].set_xlabel("along sliding / mm")
        colour_bar(list(grid), shown, "contact pressure / MPa")
        return png(figure, dpi)


def _patches(axes, structure, here, pressure, closed):
    x, y = structure.contact_position[:, :2].T
    middle = np.angle(np.sum((x + 1j * y)[here]))
    radius, angle = np.hypot(x, y), np.angle((x + 1j * y) * np.exp(-1j * middle))
    along, size = 1e3 * angle * radius[here].mean(), 2.1e3 * np.sqrt(structure.contact_area[here].mean())
    shown = axes.scatter(along[here & closed], 1e3 * radius[here & closed], c=pressure[here & closed], s=size**2,
                         cmap=SEQUENTIAL, marker="s", lw=0, vmin=0.0, vmax=pressure.max())
    axes.scatter(along[here & ~closed], 1e3 * radius[here & ~closed], marker="x", color=FAINT, s=size**2 / 4)
    axes.margins(0.12, 0.25)
    return shown
