"""Pictures of the micro contact: contact spots new and worn, wear maps."""

import numpy as np

from pipeline.views.figures.style import SEQUENTIAL, drawing, image, png


def contact_spots(micro, state, dpi):
    """PNG of the contact pressure in MPa, ``state`` 'new' or 'worn'; grey where the surfaces are apart."""
    fields = {"new": micro.contact_pressure_new, "worn": micro.contact_pressure_worn}
    loaded = micro.contact_pressure_new[micro.contact_pressure_new > 0]
    highest = 1e-6 * np.percentile(loaded, 95) if loaded.size else 1.0
    return _spots(micro, 1e-6 * fields[state], "contact pressure / MPa", highest, dpi)


def wear_map(micro, body, dpi):
    """PNG of the wear of the surface nodes of 'pad' or 'disc' in µm after the last cycle; grey where none."""
    wear = 1e6 * {"pad": micro.pad_wear, "disc": micro.disc_wear}[body]
    highest = np.percentile(wear[wear > 0], 99) if (wear > 0).any() else 1.0
    return _spots(micro, wear, f"wear of the {body} / µm", highest, dpi)


def _spots(micro, values, label, highest, dpi):
    from matplotlib import colormaps

    colours = colormaps[SEQUENTIAL].with_extremes(bad="#e9ebee")
    with drawing(3.55, bar=True) as figure:
        shown = np.ma.masked_less_equal(values, 0.0)
        image(figure.subplots(), micro.x, micro.y, shown, label, cmap=colours, vmin=0.0, vmax=highest)
        return png(figure, dpi)
