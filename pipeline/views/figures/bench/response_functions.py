"""Picture of the frequency responses of a test, and of their coherence."""

import numpy as np

from pipeline.views.figures.style import COLOURS, FAINT, drawing, png

#: most responses and lines that are drawn
_DRAWN, _LINES = 24, 4000


def responses(test, dpi):
    """PNG: sizes of the responses over frequency, grey, and their root mean square; below, where it is known, the
    coherence: median of the responses and the lowest."""
    known = len(test.coherence) > 0
    with drawing(4.0 if known else 3.0, top=0.14) as figure:
        above, *below = np.atleast_1d(figure.subplots(1 + known, sharex=True, height_ratios=(2, 1)[:1 + known]))
        shown = np.flatnonzero(test.line > 0)[::max(len(test.line) // _LINES, 1)]
        kilohertz, size = test.line[shown] / 1e3, abs(test.response[:, shown])
        for row in size[::max(len(size) // _DRAWN, 1)]:
            above.semilogy(kilohertz, row, color=FAINT, lw=0.7)
        above.semilogy(kilohertz, np.sqrt(np.mean(size**2, axis=0)), color=COLOURS[0], lw=1.0)
        units = sorted(set(map(str, test.unit)))
        above.set(ylabel=f"response / {units[0].replace('^2', '²')}" if len(units) == 1 else "responses",
                  xlim=(0, kilohertz[-1]))
        for axes in below:
            axes.plot(kilohertz, np.median(test.coherence[:, shown], axis=0), color=COLOURS[0], lw=0.8)
            axes.plot(kilohertz, test.coherence[:, shown].min(axis=0), color=FAINT, lw=0.7, zorder=0)
            axes.set(ylabel="coherence", ylim=(0, 1.05))
        figure.axes[-1].set_xlabel("frequency / kHz")
        return png(figure, dpi)
