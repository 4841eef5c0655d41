"""Picture of the load of the pads: contact pressure on the disc without friction, and beside it in steady sliding."""

from dataclasses import dataclass

import numpy as np

from pipeline.views.figures.number_format import number
from pipeline.views.figures.style import INK, SEQUENTIAL, colour_bar, drawing, png

#: drawn side of a patch, as a fraction of the side of a square of its area
_SIDE = 0.88
#: colour of a patch without pressure, beneath its cross
_EMPTY = "#e3e6ea"


@dataclass(frozen=True)
class Load:
    """Normal force (contact,) in N of every patch in one state, and the title that says which."""

    title: str
    force: np.ndarray

    @property
    def closed(self):
        """True (contact,) where the patch touches the disc."""
        return self.force > 0


def loads(structure, modes=None):
    """Loads at the middle pressure: without friction and, where ComplexModes are given, in steady sliding."""
    middle = len(structure.pressure) // 2
    still = Load("without friction", structure.preload[middle])
    if modes is None:
        return (still,)
    point = sliding_point(modes, structure.pressure[middle])
    return still, Load(f"sliding, friction {number(modes.operating_friction[point], 2)}", modes.operating_force[point])


def sliding_point(modes, pressure):
    """Operating point at ``pressure`` with the middle one of its disc speeds."""
    candidates = np.flatnonzero(np.isclose(modes.operating_pressure, pressure))
    return candidates[len(candidates) // 2]


def contact_pressure(structure, states, dpi):
    """PNG of the contact pressure, one row per pad and one column per Load; crosses where a patch is open.

    Along sliding and radius, as seen from the pad: the disc moves to the right. All share one scale.
    """
    pads = np.unique(structure.contact_body)
    largest = max(1e-6 * np.max(load.force / structure.contact_area) for load in states)
    with drawing(0.6 + (1.25 / len(states) + 0.35) * len(pads), left=0.95, top=0.3, bar=True) as figure:
        grid = figure.subplots(len(pads), len(states), sharex=True, sharey=True, squeeze=False)
        for row, pad in zip(grid, pads, strict=True):
            for axes, load in zip(row, states, strict=True):
                shown = _patches(axes, structure, structure.contact_body == pad, load, largest)
            row[0].set_ylabel(f"{str(structure.body_name[pad]).replace('_', ' ')}\nradius / mm")
        for axes, load in zip(grid[0], states, strict=True):
            axes.set_title(load.title, pad=4, fontsize=9)
        for axes in grid[-1]:
            axes.set_xlabel("along sliding / mm")
        colour_bar(list(grid.flat), shown, "contact pressure / MPa")
        return png(figure, dpi)


def _patches(axes, structure, selected, load, largest):
    """Squares of the size of the patches ``here``, coloured by pressure up to ``largest`` MPa."""
    from matplotlib import colormaps
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle

    along, radius = _unrolled(structure.contact_position[selected])
    side, closed = 1e3 * _SIDE * np.sqrt(structure.contact_area[selected]), load.closed[selected]
    corners = zip(along - side / 2, radius - side / 2, side, strict=True)
    squares = PatchCollection([Rectangle((x, y), size, size) for x, y, size in corners], lw=0,
                              cmap=colormaps[SEQUENTIAL].with_extremes(bad=_EMPTY))
    squares.set(array=np.ma.masked_where(~closed, 1e-6 * load.force[selected] / structure.contact_area[selected]),
                clim=(0.0, largest))
    axes.add_collection(squares)
    axes.scatter(along[~closed], radius[~closed], marker="x", color=INK, s=30, lw=1.2)
    axes.set_aspect("equal")
    axes.margins(0.06)
    return squares


def _unrolled(position):
    """(Arc length from the middle, radius), both (contact,) mm, of positions (contact, 3) m."""
    plane = position[:, 0] + 1j * position[:, 1]
    return 1e3 * abs(plane) * np.angle(plane / plane.sum()), 1e3 * abs(plane)
