"""Pictures of a recording: the channels of a run over time, gaps shaded."""

import numpy as np

from pipeline.contract.mapped import Slices, blocks
from pipeline.views.figures.number_format import scale
from pipeline.views.figures.style import COLOURS, FAINT, MARKERS, drawing, legend, outline, png, svg

#: channels that one picture shows
MOST = 8
#: size of letters in points times their number in a label beside one channel
_LETTERS = 115.0


def largest(channel):
    """Largest absolute value of the samples of a Channel."""
    return max((float(np.abs(block).max(initial=0.0)) for block in blocks(channel.samples)), default=0.0)


def channels(run, dpi):
    """PNG of the first channels of a run over time, one below the other; grey where samples are missing."""
    shown = list(run.channels.items())[:MOST]
    with drawing(0.9 + 1.1 * len(shown), left=0.9, top=0.25) as figure:
        grid = figure.subplots(len(shown), sharex=True, squeeze=False)[:, 0]
        for axes, (name, channel), colour in zip(grid, shown, COLOURS, strict=False):
            _channel(axes, name, channel, colour)
        ends = [(float(c.begin), float(c.begin) + max(len(c.samples) - 1, 1) / float(c.rate)) for _, c in shown]
        grid[-1].set(xlabel="time / s", xlim=(min(b for b, _ in ends), max(e for _, e in ends)))
        return png(figure, dpi)


def friction(product):
    """SVG: measured coefficients of friction over the sliding distance, a curve each run; bars: standard error."""
    tables = [(name, table) for name, run in product.runs.items() for table in run.friction.values()]
    with drawing(top=0.2 + 0.17 * -(-len(tables) // 3)) as figure:
        axes = figure.subplots()
        for k, (name, table) in enumerate(tables):
            distance, index = np.unique(table.distance, return_inverse=True)
            count = np.bincount(index)
            mean = np.bincount(index, table.friction) / count
            error = np.sqrt(np.bincount(index, table.friction_std**2)) / count
            axes.errorbar(1e3 * distance, mean, error, color=COLOURS[k % len(COLOURS)],
                          marker=MARKERS[k % len(MARKERS)], ms=3, lw=1, label=name)
        axes.set(xlabel="sliding distance / mm", ylabel="coefficient of friction")
        legend(axes)
        return svg(figure)


def _channel(axes, name, channel, colour):
    rate, begin = float(channel.rate), float(channel.begin)
    index, samples = outline(Slices(channel.samples))
    unit, size = scale(largest(channel), str(channel.unit))
    axes.plot(begin + index / rate, samples / size, color=colour, lw=0.7)
    for first, last in channel.missing:
        axes.axvspan(begin + first / rate, begin + last / rate, color=FAINT, alpha=0.4, lw=0)
    label = name if unit == "1" else f"{name} / {unit}"
    axes.set_ylabel(label)
    axes.yaxis.label.set_size(min(axes.yaxis.label.get_size(), _LETTERS / len(label)))
