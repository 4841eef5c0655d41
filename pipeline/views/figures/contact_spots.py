"""Pictures of the micro contact: contact spots new and worn, wear maps, both in motion, stress under the surface."""

import numpy as np

from pipeline.views.figures.style import SEQUENTIAL, animated, colour_bar, drawing, image, png

#: ms that a frame of an animation is shown
_SHOWN = 700


def contact_spots(micro, record, dpi, title=""):
    """PNG of the contact pressure in MPa at a ``record`` of the distances; grey where the surfaces are apart."""
    loaded = micro.contact_pressure[0][micro.contact_pressure[0] > 0]
    highest = 1e-6 * np.percentile(loaded, 95) if loaded.size else 1.0
    return _spots(micro, 1e-6 * micro.contact_pressure[record], "contact pressure / MPa", highest, dpi, title)


def wear_map(micro, body, dpi, record=-1, title=""):
    """PNG of the wear of the surface nodes of 'pad' or 'disc' in µm at a ``record``; grey where none."""
    wear = {"pad": micro.pad_wear, "disc": micro.disc_wear}[body]
    last = 1e6 * wear[-1]
    highest = np.percentile(last[last > 0], 99) if (last > 0).any() else 1.0
    return _spots(micro, 1e6 * wear[record], f"wear of the {body} / µm", highest, dpi, title)


def over_cycles(micro, what, dpi):
    """Animated PNG of 'spots' or of the wear of 'pad' or 'disc' over the recorded distances."""
    def draw(k):
        title = f"{1e3 * micro.distance[k]:.3g} mm"
        return contact_spots(micro, k, dpi, title) if what == "spots" else wear_map(micro, what, dpi, k, title)

    return animated(draw, len(micro.distance), _SHOWN)


def stress(micro, dpi):
    """PNG of the von Mises stress in MPa under the surface, section along sliding through the largest, and about it."""
    depth, hardest = micro.stress_depth, micro.stress.max(axis=0).argmax()
    half = 2.5 * depth[-1]
    middle = np.clip(micro.x[hardest], micro.x[0] + half, max(micro.x[-1] - half, micro.x[0] + half))
    near = abs(micro.x - middle) <= half
    with drawing(2.6, bar=True) as figure:
        axes = figure.subplots()
        shown = axes.pcolormesh(1e3 * micro.x[near], 1e6 * depth, 1e-6 * micro.stress[:, near], cmap=SEQUENTIAL,
                                shading="gouraud", rasterized=True)
        axes.set(xlabel="along sliding x / mm", ylabel="depth / µm", ylim=(1e6 * depth[-1], 0))
        axes.grid(False)
        colour_bar(axes, shown, "von Mises stress / MPa")
        return png(figure, dpi)


def _spots(micro, values, label, highest, dpi, title):
    from matplotlib import colormaps

    colours = colormaps[SEQUENTIAL].with_extremes(bad="#e9ebee")
    with drawing(3.55 + (0.2 if title else 0.0), top=0.34 if title else 0.14, bar=True) as figure:
        axes, shown = figure.subplots(), np.ma.masked_less_equal(values, 0.0)
        image(axes, micro.x, micro.y, shown, label, cmap=colours, vmin=0.0, vmax=highest)
        axes.set_title(title)
        return png(figure, dpi)
