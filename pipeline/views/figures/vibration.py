"""Pictures of the vibration: spectra with squeal lines, occurrence, levels over frequency."""

import numpy as np

from pipeline.views.figures.number_format import plural
from pipeline.views.figures.style import (
    COLOURS,
    FAINT,
    INK,
    LINES,
    MARKERS,
    RED,
    SEQUENTIAL,
    drawing,
    legend,
    png,
    svg,
    tiles,
)


def spectra(response, operatings, sensor, published, dpi):
    """PNG of the velocity spectra at one sensor for some operating points; dotted lines at ``published`` squeal."""
    shown = response.frequency < highest_frequency(response)
    kilohertz, spectrum = response.frequency[shown] / 1e3, response.velocity_spectrum[:, sensor, shown]
    with drawing(3.4) as figure:
        axes = figure.subplots()
        for frequency in published:
            axes.axvline(frequency / 1e3, color=FAINT, lw=1.1, ls=":")
        for line, operating in enumerate(operatings):
            axes.semilogy(kilohertz, np.maximum(spectrum[operating], 1e-30), color=COLOURS[line % 6],
                          ls=LINES[line % 6], lw=0.9, label=_operating(response, operating))
        axes.set(xlabel="frequency / kHz", ylabel="velocity spectral density / m²/s²/Hz",
                 xlim=(0, kilohertz[-1]), ylim=_decades(spectrum[operatings]))
        legend(axes)
        return png(figure, dpi)


def highest_frequency(response):
    """End of the frequency axis in Hz: a little above the highest mode that can respond."""
    return min(1.1 * response.mode_frequency.max(), response.frequency[-1])


def occurrence(squeal, dpi):
    """PNG of the highest level in the squeal band at each operating point, with its frequency; frame = squeal.

    Harmonics of a lower fundamental count as events; their number is shown too.
    """
    sensor = np.argmax(squeal.peak_level, axis=1)
    row = np.arange(len(sensor))
    level, frequency = squeal.peak_level[row, sensor], squeal.peak_frequency[row, sensor]
    events = np.bincount(squeal.event_operating, minlength=len(level))
    harmonics = np.bincount(squeal.event_operating[squeal.event_order > 1], minlength=len(level))
    texts = [f"{lv:.0f} dB\n{f / 1e3:.2f} kHz\n{plural(n, 'event')}"
             + (f"\n({h} harm.)" if h else "")
             for lv, f, n, h in zip(level, frequency, events, harmonics, strict=True)]
    low, high = min(level.min(), squeal.threshold - 3.0), max(level.max(), squeal.threshold + 3.0)
    with drawing(3.3, bar=True) as figure:
        axes = figure.subplots()
        bar = tiles(axes, squeal.pressure, squeal.speed, level, texts, "highest level / dB", cmap=SEQUENTIAL, vmin=low,
                    vmax=high)
        _frame(axes, squeal, events > 0)
        bar.ax.axhline(float(squeal.threshold), color="white", lw=2.5)
        bar.ax.axhline(float(squeal.threshold), color=INK, lw=1.2, ls="--")
        return png(figure, dpi)


def level_frequency(squeal, published):
    """SVG of level over frequency: every event, one marker per pressure; highest peaks as grey dots; the threshold.

    Markers are hollow for harmonics of a lower fundamental.
    """
    pressures = np.unique(squeal.pressure)
    with drawing() as figure:
        axes = figure.subplots()
        for frequency in published:
            axes.axvline(frequency / 1e3, color=FAINT, lw=1.1, ls=":")
        axes.axhline(float(squeal.threshold), color=INK, lw=0.9, ls="--")
        axes.plot(squeal.peak_frequency.ravel() / 1e3, squeal.peak_level.ravel(), ".", color=FAINT, ms=3)
        for index, pressure in enumerate(pressures):
            at_pressure = squeal.pressure[squeal.event_operating] == pressure
            look = {"ls": "none", "marker": MARKERS[index % 6], "color": COLOURS[index % 6]}
            for shown, edge in ((at_pressure & (squeal.event_order == 1), {"mec": "white", "mew": 0.4}),
                                (at_pressure & (squeal.event_order > 1), {"mfc": "none", "mew": 1.1})):
                axes.plot(squeal.event_frequency[shown] / 1e3, squeal.event_level[shown], **look, **edge)
            axes.plot([], [], **look, label=f"{pressure / 1e6:.3g} MPa")
        axes.set(xlabel="frequency / kHz", ylabel="velocity level / dB", xlim=(0, None))
        legend(axes)
        return svg(figure)


def band_levels(squeal, operatings, sensor):
    """SVG of the third-octave levels at one sensor for some operating points."""
    with drawing() as figure:
        axes = figure.subplots()
        for line, operating in enumerate(operatings):
            axes.step(squeal.band / 1e3, squeal.band_level[operating, sensor], where="mid", color=COLOURS[line % 6],
                      ls=LINES[line % 6], label=_operating(squeal, operating))
        axes.set_xscale("log")
        labelled = squeal.band[:: max(1, len(squeal.band) // 6)] / 1e3
        axes.set_xticks(labelled, [f"{f:.3g}" for f in labelled])
        axes.set_xticks([], minor=True)
        axes.set(xlabel="third-octave band / kHz", ylabel="velocity level / dB")
        legend(axes)
        return svg(figure)


def _operating(product, operating):
    return f"{product.pressure[operating] / 1e6:.3g} MPa, {product.speed[operating]:.4g} rad/s"


def _frame(axes, product, marked):
    """Thick frames around the tiles of the ``marked`` operating points."""
    from matplotlib.patches import Rectangle

    column, row = (np.unique(v, return_inverse=True)[1] for v in (product.speed, product.pressure))
    for x, y in zip(column[marked], row[marked], strict=True):
        axes.add_patch(Rectangle((x - 0.46, y - 0.46), 0.92, 0.92, fill=False, ec=RED, lw=2.5,
                                 label="_squeal"))


def _decades(density):
    """Limits from a little below the quietest spectrum to above the highest peak."""
    highest = max(float(density.max()), 1e-30)
    return max(1e-14 * highest, 0.03 * float(np.median(density, axis=-1).min())), 5.0 * highest
