"""Pictures of a modal test: stabilisation diagram over the responses, likeness of the shapes."""

import numpy as np

from pipeline.views.figures.style import COLOURS, FAINT, INK, RED, SEQUENTIAL, colour_bar, drawing, png


def stabilisation(modes, dpi):
    """PNG: poles of every order over frequency, grey, blue where they came back, red where they became a mode; above
    them the responses, measured and fitted."""
    with drawing(4.6, top=0.14) as figure:
        above, below = figure.subplots(2, sharex=True, height_ratios=(1, 1.4))
        kilohertz = modes.line / 1e3
        above.semilogy(kilohertz, modes.measured, color=FAINT, lw=1.6, label="_measured")
        above.semilogy(kilohertz, modes.fitted, color=COLOURS[0], lw=0.8, label="_fitted")
        low, high = above.get_ylim()
        above.set(ylabel="responses, rms", ylim=(low / 2, 8 * high) if high < 10 * low else (low, high))
        above.yaxis.set_minor_formatter("")
        for rows, colour, size in ((modes.stable == 0, FAINT, 1.5), ((modes.stable == 1) & (modes.chosen < 0),
                                                                      COLOURS[0], 3.0), (modes.chosen >= 0, RED, 3.0)):
            below.plot(modes.pole_frequency[rows] / 1e3, modes.order[rows], "o", color=colour, ms=size, mew=0)
        for axes in (above, below):
            for frequency in modes.frequency / 1e3:
                axes.axvline(frequency, color=INK, lw=0.4, alpha=0.6, zorder=0)
        below.set(xlabel="frequency / kHz", ylabel="order", xlim=(kilohertz[0], kilohertz[-1]))
        return png(figure, dpi)


def likeness(modes, dpi):
    """PNG of the modal assurance criterion of the shapes among themselves."""
    with drawing(3.6, bar=True) as figure:
        axes = figure.subplots()
        count = np.arange(1, len(modes.frequency) + 1)
        shown = axes.imshow(modes.likeness, origin="lower", vmin=0, vmax=1, cmap=SEQUENTIAL, aspect="auto",
                            extent=(0.5, len(count) + 0.5, 0.5, len(count) + 0.5))
        axes.set(xlabel="mode", ylabel="mode")
        axes.grid(False)
        colour_bar(axes, shown, "MAC")
        return png(figure, dpi)
