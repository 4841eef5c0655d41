"""One look for every figure: phone-sized panels, colour-blind safe colours, deterministic bytes.

A figure is one panel of about 117 mm: on a phone it fills the screen with text of about 11 pixels, on a desktop two
stand side by side. Categories use the palette of Okabe and Ito (2008), magnitudes the perceptually uniform viridis
and cividis, signed quantities purple-orange; every category also differs by line style, marker or label.
"""

from contextlib import contextmanager
from functools import cache
from io import BytesIO
from itertools import pairwise

import numpy as np

from pipeline.views.figures.plotted.artists import numbers
from pipeline.views.figures.plotted.picture import Picture

BLUE, ORANGE, GREEN, RED, PURPLE, SKY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9"
INK, FAINT = "#222222", "#8a8f98"
COLOURS = (BLUE, RED, GREEN, PURPLE, ORANGE, SKY)
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)))
MARKERS = ("o", "s", "^", "D", "v", "P")
SEQUENTIAL, HEIGHTS, SIGNED = "viridis", "cividis", "PuOr_r"

WIDTH, HEIGHT = 4.6, 3.2
RC = {
    "font.family": "DejaVu Sans", "font.size": 10.5, "axes.labelsize": 10.5, "axes.titlesize": 10,
    "xtick.labelsize": 9.5, "ytick.labelsize": 9.5, "legend.fontsize": 9.5, "legend.handlelength": 1.6,
    "legend.columnspacing": 1.2, "legend.frameon": False, "text.color": INK, "axes.edgecolor": FAINT,
    "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#e3e6ea", "grid.linewidth": 0.6,
    "axes.axisbelow": True, "lines.linewidth": 1.6, "lines.markersize": 4.5, "axes.unicode_minus": True,
    "figure.facecolor": "white", "savefig.facecolor": "white", "svg.hashsalt": "brakechain", "svg.fonttype": "path",
    "hatch.linewidth": 0.6, "path.simplify": True,
}


@contextmanager
def drawing(height=HEIGHT, left=0.72, right=0.15, top=None, bar=False):
    """An empty matplotlib Figure in the style of the report; margins in inches, ``bar`` keeps room for a colour bar."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(_look()):
        figure, top = Figure(figsize=(WIDTH, height)), (0.14 if bar else 0.34) if top is None else top
        figure.subplots_adjust(left=left / WIDTH, right=1.0 - (0.78 if bar else right) / WIDTH,
                               bottom=0.52 / height, top=1.0 - top / height, hspace=0.35)
        yield figure


@cache
def _look():
    """All settings of matplotlib in the style of the report, whatever a user has set; made once, as it takes long."""
    from matplotlib import rcParams, style

    with style.context(RC, after_reset=True):
        return {name: value for name, value in rcParams.copy().items() if name != "backend"}


def svg(figure):
    """Picture of a figure as SVG text; no date, no creator, fixed identifiers."""
    stream = BytesIO()
    figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    return Picture(stream.getvalue().decode(), *numbers(figure))


def png(figure, dpi):
    """Picture of a figure as PNG bytes, without metadata."""
    stream = BytesIO()
    figure.savefig(stream, format="png", dpi=dpi, metadata={"Software": None})
    return Picture(stream.getvalue(), *numbers(figure))


def animated(draw, count, duration, most=3_000_000):
    """Picture that moves: animated PNG, in few colours, of the ``count`` Pictures that ``draw(k)`` gives, each for
    ``duration`` ms, beginning with the last, which is printed; others are left out evenly until it holds ``most``
    bytes."""
    from PIL import Image

    step, drawn, last = 1, {}, draw(count - 1)
    while True:
        shown = [count - 1, *range(0, count - 1, step)]
        for k in shown:
            if k not in drawn:
                picture = draw(k) if k < count - 1 else last
                drawn[k] = Image.open(BytesIO(picture.image)).convert("RGB").quantize(64, dither=Image.Dither.NONE)
        first, *others = (drawn[k] for k in shown)
        stream = BytesIO()
        first.save(stream, format="PNG", save_all=True, append_images=others, duration=duration, loop=0)
        if stream.tell() <= most or step >= count:
            return Picture(stream.getvalue(), last.panels, last.series, moving=True)
        step += 1


def image(axes, x, y, values, label, **look):
    """Map ``values`` over the lateral positions ``x``, ``y`` (m), axes in mm, with a colour bar."""
    extent = 1e3 * np.array([x[0], x[-1], y[0], y[-1]])
    shown = axes.imshow(values, origin="lower", extent=extent, interpolation="nearest", **look)
    axes.set(xlabel="along sliding x / mm", ylabel="across sliding y / mm")
    axes.grid(False)
    colour_bar(axes, shown, label)


def colour_bar(axes, shown, label, **look):
    """Colour bar in the margin that ``drawing(bar=True)`` keeps."""
    figure = shown.axes.figure
    return figure.colorbar(shown, ax=axes, label=label, fraction=0.045, pad=0.03, aspect=24, **look)


def operating_grid(pressure, speed, values):
    """Values of operating points on their pressure x speed grid: (pressures, speeds, grid); NaN where none ran."""
    pressures, row = np.unique(pressure, return_inverse=True)
    speeds, column = np.unique(speed, return_inverse=True)
    grid = np.full((len(pressures), len(speeds)), np.nan)
    grid[row, column] = values
    return pressures, speeds, grid


def tiles(axes, pressure, speed, values, texts, label, **look):
    """One tile per operating point: pressure upwards, speed (rad/s) to the right, ``texts`` written on."""
    pressures, speeds, grid = operating_grid(pressure, speed, values)
    name, size = ("MPa", 1e6) if pressures[-1] > 1e4 else ("Pa", 1.0)
    shown = axes.imshow(grid, origin="lower", aspect="auto", **look)
    axes.set_xticks(range(len(speeds)), [f"{v:.4g}" for v in speeds])
    axes.set_yticks(range(len(pressures)), [f"{p / size:.3g}" for p in pressures])
    axes.set(xlabel="speed / rad/s", ylabel=f"pressure / {name}")
    axes.grid(False)
    for p, v, value, text in zip(pressure, speed, values, texts, strict=True):
        axes.text(np.searchsorted(speeds, v), np.searchsorted(pressures, p), text, ha="center", va="center",
                  fontsize=9, linespacing=1.15, color=readable_on(shown, value))
    return colour_bar(axes, shown, label)


#: inches between a legend and the edge of its figure
_EDGE = 0.08


def legend(axes, columns=3):
    """Legend above the axes, where it hides no line: in fewer columns where it is too wide; the figure grows where it
    is too high."""
    figure, made = axes.figure, None
    while made is None or (columns > 0 and made.get_window_extent().x1 > figure.bbox.x1 - _EDGE * figure.dpi):
        made = axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=0.2)
        columns -= 1
    missing = (made.get_window_extent().y1 - figure.bbox.y1) / figure.dpi + 0.02
    if missing > 0:
        _raise_top(figure, missing)


def _raise_top(figure, inches):
    """More room at the top of a figure whose axes keep their size."""
    width, height = figure.get_size_inches()
    ends, ratio = figure.subplotpars, height / (height + inches)
    bottom, top = ends.bottom * ratio, ends.top * ratio
    figure.set_size_inches(width, height + inches)
    figure.subplots_adjust(bottom=bottom, top=top)


def readable_on(shown, value):
    """Colour of a text on the colour that ``shown`` gives to a value."""
    red, green, blue, _ = shown.cmap(shown.norm(value))
    return INK if 0.299 * red + 0.587 * green + 0.114 * blue > 0.5 else "white"


def symmetric(values, least=1e-9):
    """Colour limits of a signed quantity, zero in the middle."""
    largest = max(float(np.max(np.abs(values), initial=0.0)), least)
    return {"vmin": -largest, "vmax": largest, "cmap": SIGNED}


def envelope(time, values, bins=1200):
    """Lowest and highest value in each of ``bins`` time windows, alternating: what a screen can show of a signal."""
    index, shown = outline(values, bins)
    return time[index], shown


def outline(values, bins=1200):
    """(indices, values) of the same, of an array (sample,) or what gives slices of it."""
    if len(values) <= 2 * bins:
        return np.arange(len(values)), values[:]
    edges = np.linspace(0, len(values), bins + 1).astype(int)
    windows = (values[first:last] for first, last in pairwise(edges))
    return np.repeat(edges[:-1], 2), np.array([(window.min(), window.max()) for window in windows]).ravel()
