"""Pictures of the result of a trial: rates, confusion, detection, calibration, held-out error, parameters."""

from textwrap import fill

import numpy as np

from pipeline.views.figures.number_format import percent
from pipeline.views.figures.style import (
    BLUE,
    COLOURS,
    FAINT,
    INK,
    LINES,
    MARKERS,
    ORANGE,
    SEQUENTIAL,
    drawing,
    legend,
    svg,
)


def rates(methods, names, labels):
    """Dot and 95 % interval of every rate in ``names`` (shown as ``labels``), a marker per method; bars: goals."""
    rows = (len(methods) + 1) // 2 if len(methods) > 1 else 0
    with drawing(0.75 + 0.22 * rows + 0.42 * len(names), left=2.1, top=0.1 + 0.22 * rows) as figure:
        axes = figure.subplots()
        for k, (method, numbers) in enumerate(methods.items()):
            shift = 0.56 * ((k + 0.5) / len(methods) - 0.5)
            dots = [(y + shift, numbers["rates"][name]) for y, name in enumerate(names) if name in numbers["rates"]]
            _with_intervals(axes, dots, COLOURS[k % 6], MARKERS[k % 6], method.replace("_", " "))
        first = next(iter(methods.values()))["rates"]
        for y, name in enumerate(names):
            if first[name]["goal"]:
                axes.plot([first[name]["goal"][1]] * 2, [y - 0.42, y + 0.42], color=INK, lw=1.6)
        axes.set_yticks(range(len(names)), [fill(label, 27) for label in labels], fontsize=8, linespacing=1.0)
        axes.set(xlim=(-0.02, 1.02), ylim=(len(names) - 0.4, -0.6), xlabel="rate")
        if rows:
            figure.legend(*axes.get_legend_handles_labels(), loc="upper left", ncols=2, borderaxespad=0.2)
        return svg(figure)


def _with_intervals(axes, rows, colour, marker, label):
    """Dots at (rate, y) with their intervals along x."""
    values, bars = _shares([rate for _, rate in rows])
    axes.errorbar(values, [y for y, _ in rows], xerr=bars, fmt=marker, color=colour, lw=1.2, capsize=2, label=label)


def _shares(rates):
    """Shares (n,) of rates, and how far their intervals reach below and above (2, n)."""
    values, low, high = np.array([[f["hits"] / f["count"], f["low"], f["high"]] for f in rates]).reshape(-1, 3).T
    return values, np.maximum([values - low, high - values], 0)


def table(counted, row_label, column_label):
    """Counts {row: {column: count}} as tiles: rows in order, columns by how often; empty ones stay white."""
    columns = sorted({c for row in counted.values() for c in row}, key=lambda c: (-sum(
        row.get(c, 0) for row in counted.values()), c))
    grid = np.array([[row.get(c, 0) for c in columns] for row in counted.values()], float)
    fraction = grid / grid.sum(axis=1, keepdims=True)
    below = 0.5 + 0.06 * max(map(len, columns))
    with drawing(0.1 + below + 0.25 * len(counted), left=2.05, top=0.1) as figure:
        figure.subplots_adjust(bottom=below / figure.get_figheight())
        axes = figure.subplots()
        axes.imshow(np.where(grid > 0, fraction, np.nan), aspect="auto", vmin=0, vmax=1, cmap=SEQUENTIAL)
        axes.set_xticks(range(len(columns)), [c.replace("_", " ") for c in columns], rotation=60, ha="right",
                        rotation_mode="anchor", fontsize=8)
        axes.set_yticks(range(len(counted)), [r.replace("_", " ") for r in counted], fontsize=8)
        axes.set(xlabel=column_label, ylabel=row_label)
        axes.grid(False)
        for (y, x), count in np.ndenumerate(grid):
            if count:
                axes.text(x, y, f"{count:.0f}", ha="center", va="center", fontsize=8,
                          color="white" if fraction[y, x] < 0.6 else INK)
        return svg(figure)


def detection(points):
    """Fraction correctly named and located over the size of the effect, one line per noise level."""
    with drawing(right=0.3) as figure:
        axes = figure.subplots()
        for k, noise in enumerate(sorted({p["noise"] for p in points})):
            _curve(axes, [p for p in points if p["noise"] == noise], 0.02, k, f"noise {percent(noise, 2)}")
        axes.set_xticks([0.02, 0.05, 0.1, 0.2, 0.4, 1], ["2 %", "5 %", "10 %", "20 %", "40 %", "100 %"])
        axes.set(xlabel="change of the sensor signals", ylabel="correctly named and located")
        legend(axes)
        return svg(figure)


def visible(points, thresholds):
    """Fraction correctly named and located over the residual after refitting; lines at ``thresholds``."""
    with drawing() as figure:
        axes = figure.subplots()
        _curve(axes, points, 1.0, 0, None)
        for threshold in thresholds:
            axes.axvline(threshold, color=FAINT, lw=1)
        axes.set_xticks([1, 2, 4, 8, 16, 32, 64], ["0", "2", "4", "8", "16", "32", ""])
        axes.set(xlabel="residual after refitting, standard deviations", ylabel="correctly named and located")
        return svg(figure)


def _curve(axes, points, first, k, label):
    """Rates with 95 % intervals over bins in the logarithm; the lowest bin begins at ``first``."""
    x = np.sqrt([max(p["low"], first) * p["high"] for p in points]) * 1.04**k
    values, bars = _shares([p["right"] for p in points])
    axes.errorbar(x, values, yerr=bars, fmt=MARKERS[k % 6], ls=LINES[k % 6], color=COLOURS[k % 6], lw=1.2, capsize=2,
                  label=label)
    axes.set(xscale="log", ylim=(-0.03, 1.03))
    axes.minorticks_off()


def reliability(bins):
    """Reliability diagram: fraction correct over stated probability; calibrated on the diagonal."""
    with drawing() as figure:
        axes = figure.subplots()
        axes.plot([0, 1], [0, 1], color=FAINT, lw=1)
        values, bars = _shares([b["so"] for b in bins])
        axes.errorbar([b["stated"] for b in bins], values, yerr=bars, fmt="o", color=BLUE, capsize=2)
        axes.set(xlim=(-0.03, 1.03), ylim=(-0.03, 1.03), xlabel="stated probability", ylabel="fraction correct")
        return svg(figure)


def held_out(rows):
    """Held-out error over the noise floor, before and after: ``rows`` (recalibrated, completed, right)."""
    with drawing() as figure:
        axes = figure.subplots()
        top = 1.3 * max(max(r[:2]) for r in rows)
        axes.plot([0.8, top], [0.8, top], color=FAINT, lw=1)
        axes.axhline(1.2, color=INK, lw=0.9, ls="--")
        for right, colour, marker in ((True, BLUE, "o"), (False, ORANGE, "D")):
            selected = np.array([r[:2] for r in rows if r[2] is right]).reshape(-1, 2)
            axes.plot(*selected.T, marker, color=colour, mfc="none", label="correct" if right else "wrong")
        axes.set(xscale="log", yscale="log", xlim=(0.8, top), ylim=(0.8, top), xlabel="recalibrated / noise floor",
                 ylabel="completed / noise floor")
        legend(axes)
        return svg(figure)


def distances(values):
    """Distances of fitted from true values in stated standard deviations, beside the normal curve."""
    with drawing() as figure:
        axes = figure.subplots()
        edges = np.linspace(-8, 8, 33)
        axes.hist(values, bins=edges, density=True, color=BLUE, alpha=0.75)
        x = np.linspace(-8, 8, 161)
        axes.plot(x, np.exp(-x**2 / 2) / np.sqrt(2 * np.pi), color=INK, lw=1.2, label="normal")
        axes.set(xlabel="(fitted \u2212 true) / stated standard deviation", ylabel="density")
        legend(axes)
        return svg(figure)
