"""Pictures of the two rough surfaces: height maps, profile, height distribution, power spectrum."""

import numpy as np

from pipeline.views.figures.style import COLOURS, HEIGHTS, INK, LINES, drawing, image, legend, png, svg


def height_map(surface, index, dpi):
    """PNG of the heights of body 0 or 1 in µm, over mm."""
    heights = 1e6 * _heights(surface)[index]
    low, high = np.percentile(heights, [0.2, 99.8])
    with drawing(3.55, bar=True) as figure:
        image(figure.subplots(), surface.x, surface.y, heights, "height / µm", cmap=HEIGHTS, vmin=low, vmax=high)
        return png(figure, dpi)


def profile(surface):
    """SVG of the middle section along sliding: second body above the first, both as measured from their mean planes."""
    row = len(surface.y) // 2
    lower, upper = 1e6 * surface.disc_height[0, row], -1e6 * surface.pad_height[0, row]
    upper = upper + np.max(lower - upper) * 1.05
    with drawing(2.6, top=0.12) as figure:
        axes = figure.subplots()
        x = 1e3 * surface.x
        axes.fill_between(x, lower.min() - 4, lower, color=COLOURS[0], alpha=0.35, lw=0, label="_")
        axes.fill_between(x, upper, upper.max() + 4, color=COLOURS[1], alpha=0.35, lw=0, label="_")
        axes.plot(x, lower, color=COLOURS[0], lw=0.9, label=f"_{surface.body[0]}")
        axes.plot(x, upper, color=COLOURS[1], lw=0.9, label=f"_{surface.body[1]}")
        axes.text(0.01, 0.03, surface.body[0], transform=axes.transAxes, color=INK)
        axes.text(0.01, 0.97, surface.body[1], transform=axes.transAxes, va="top", color=INK)
        axes.set(xlabel="along sliding x / mm", ylabel="height / µm")
        axes.margins(x=0, y=0)
        return svg(figure)


def height_distribution(surface):
    """SVG of the probability density of the heights of both bodies."""
    with drawing() as figure:
        axes = figure.subplots()
        for index, body in enumerate(surface.body):
            heights = 1e6 * _heights(surface)[index]
            density, edges = np.histogram(heights, bins=80, density=True)
            axes.plot(0.5 * (edges[1:] + edges[:-1]), density, color=COLOURS[index], ls=LINES[index], label=body)
        axes.set(xlabel="height above mean plane / µm", ylabel="probability density / 1/µm", ylim=(0, None))
        legend(axes)
        return svg(figure)


def power_spectrum(surface):
    """SVG of the isotropic power spectra; dotted: shortest wavelength retained."""
    positive = surface.wavenumber > 0
    with drawing() as figure:
        axes = figure.subplots()
        for index, body in enumerate(surface.body):
            spectrum = np.where(surface.power_spectrum[index] > 0, surface.power_spectrum[index], np.nan)
            axes.loglog(surface.wavenumber[positive], spectrum[positive], color=COLOURS[index], ls=LINES[index],
                        label=body)
        shortest = 2 * np.pi / surface.shortest_wavelength.min()
        axes.axvline(shortest, color=INK, lw=0.9, ls=":")
        axes.annotate("shortest wavelength retained", (shortest, 1), xycoords=("data", "axes fraction"), fontsize=8,
                      xytext=(4, -2), textcoords="offset points", rotation=90, va="top")
        axes.set(xlabel="wavenumber / rad/m", ylabel="power spectral density / m$^4$", ylim=_decades(surface))
        legend(axes)
        return svg(figure)


def _heights(surface):
    """Heights of both bodies of the first pair in the order of their names."""
    return surface.disc_height[0], surface.pad_height[0]


def _decades(surface):
    """Limits of the spectra over the retained wavelengths."""
    resolved = surface.wavenumber[None, :] < 2 * np.pi / surface.shortest_wavelength[:, None]
    shown = surface.power_spectrum[resolved & (surface.power_spectrum > 0)]
    return (shown.min() / 5, 3 * shown.max()) if shown.size else (None, None)
