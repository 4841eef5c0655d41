"""Pictures of one unstable mode: its path over friction with the mode it meets, and which contacts feed it."""

import numpy as np

from pipeline.views.figures.style import (
    BLUE,
    FAINT,
    INK,
    RED,
    SIGNED,
    colour_bar,
    drawing,
    legend,
    png,
    svg,
)

TWO_PI = 2.0 * np.pi


def path(modes, follow, other):
    """SVG of frequency and growth rate over friction of a followed mode, by number, and of the one called ``other``."""
    members = modes.path_mode == modes.followed_mode[follow]
    friction, roots = modes.path_friction[members], (modes.path_root[members], modes.path_meeting[members])
    critical = modes.followed_critical[follow]
    scale, unit = (1e3, "kHz") if roots[0].imag.max() > TWO_PI * 1e3 else (1.0, "Hz")
    with drawing(4.0, left=0.92) as figure:
        upper, lower = figure.subplots(2, 1, sharex=True, gridspec_kw={"hspace": 0.12})
        for root, colour, line, name in zip(roots, (RED, BLUE), ("-", "--"), ("this mode", other),
                                            strict=True):
            known = root != 0
            if known.any():
                frequency = root[known].imag / TWO_PI / scale
                upper.plot(friction[known], frequency, color=colour, ls=line, label=name)
                lower.plot(friction[known], root[known].real, color=colour, ls=line)
        for axes in (upper, lower):
            axes.axvline(critical, color=FAINT, lw=1.1, ls=":")
        upper.plot(friction[-1], roots[0][-1].imag / TWO_PI / scale, "o", color=RED, label="_operating point")
        lower.plot(friction[-1], roots[0][-1].real, "o", color=RED, label="_operating point")
        lower.axhline(0.0, color=INK, lw=0.9)
        upper.set(ylabel=f"frequency / {unit}")
        upper.ticklabel_format(axis="y", useOffset=False)
        lower.set(xlabel="coefficient of friction", ylabel="growth rate / 1/s",
                  ylim=_shown(*(root.real for root in roots)))
        legend(upper)
        return svg(figure)


def _shown(growth, other):
    """Limits around the growth rates of the mode; an ``other`` that is damped far more strongly leaves the picture."""
    margin = 0.15 * max(np.ptp(growth), 1.0)
    low = max(min(growth.min(), other.min()), growth.min() - np.ptp(growth))
    return low - margin, max(growth.max(), 0.0) + margin


def contact_maps(position, area, body, parts, names, dpi):
    """PNG of the ``parts`` (c,) 1/s of contacts at ``position`` (c, 3) m in a growth rate, per ``area`` (c,) m^2.

    One panel for each body of the contacts ``body`` (c,), with its name in ``names``.
    """
    from matplotlib.collections import PolyCollection

    density = parts / (1e4 * area)
    limit = max(np.percentile(abs(density), 99), 1e-300)
    bodies = np.unique(body)
    with drawing(4.0, left=0.1, bar=True, top=0.34) as figure:
        panels = np.atleast_1d(figure.subplots(1, len(bodies)))
        for axes, number, name in zip(panels, bodies, names, strict=True):
            members = body == number
            shown = PolyCollection(_cells(position[members], area[members]), array=density[members], cmap=SIGNED,
                                   clim=(-limit, limit), lw=0.8, edgecolors="face")
            axes.add_collection(shown)
            axes.autoscale_view()
            axes.set(title=name, aspect="equal", xlabel="x / mm", ylabel="y / mm")
            axes.set_axis_off()
        bar = colour_bar(panels[-1], shown, "growth rate by area / (1/s)/cm²")
        bar.ax.ticklabel_format(useOffset=False)
        return png(figure, dpi)


def _cells(position, area):
    """Squares (c, 4, 2) of the areas, in mm, turned towards the axis of the disc."""
    angle = np.arctan2(position[:, 1], position[:, 0])
    half = np.sqrt(area) / 2
    corner = np.stack([(1 + 1j), (-1 + 1j), (-1 - 1j), (1 - 1j)])[None, :] * (half * np.exp(1j * angle))[:, None]
    middle = (position[:, 0] + 1j * position[:, 1])[:, None]
    corners = 1e3 * (middle + corner)
    return np.stack((corners.real, corners.imag), axis=2)


