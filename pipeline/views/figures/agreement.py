"""Picture of the comparison: deviation of each value from the published one, in tolerances."""

from textwrap import wrap

import numpy as np

from pipeline.views.figures.number_format import number
from pipeline.views.figures.style import BLUE, FAINT, INK, RED, drawing, svg


def agreement(comparison):
    """SVG, one dot per comparable row: deviation / tolerance; hollow where the model was tuned to it."""
    rows = comparable(comparison)
    deviation = (comparison.ours[rows] - comparison.published[rows]) / comparison.tolerance[rows]
    with drawing(0.8 + 0.29 * len(rows), left=2.15, top=0.1) as figure:
        axes = figure.subplots()
        axes.axvspan(-1, 1, color="#dfeaf3", lw=0, label="_tolerance")
        axes.axvline(0, color=FAINT, lw=0.9)
        for position, (row, value) in enumerate(zip(rows, deviation, strict=True)):
            _dot(axes, position, value, bool(comparison.tuned[row]))
        axes.set_yticks(range(len(rows)), [_wrapped(comparison.row[row]) for row in rows], fontsize=7.5,
                        linespacing=1.0)
        axes.set(xlim=(-3.4, 3.4), ylim=(len(rows) - 0.4, -0.6), xlabel="deviation / tolerance")
        return svg(figure)


def comparable(comparison):
    """Rows with a verdict where both the paper and the chain have a number, and a tolerance is stated."""
    known = (comparison.published_known == 1) & (comparison.ours_known == 1) & (comparison.tolerance > 0)
    return np.array([row for row in judged(comparison) if known[row]], dtype=int)


def judged(comparison, verdict=None):
    """Rows whose verdict is 'within' or 'outside', or only the given ``verdict``."""
    wanted = (verdict,) if verdict else ("within", "outside")
    return [row for row in range(len(comparison.row)) if comparison.verdict[row] in wanted]


def _dot(axes, position, value, tuned):
    colour = BLUE if abs(value) <= 1.0 else RED
    face = "white" if tuned else colour
    beyond = abs(value) > 3.2
    marker = (">" if value > 0 else "<") if beyond else ("o" if abs(value) <= 1.0 else "D")
    axes.plot(np.clip(value, -3.2, 3.2), position, marker=marker, color=colour, mfc=face, ms=5.5, mew=1.4,
              label="_tuned" if tuned else "_predicted")
    if beyond:
        axes.annotate(number(value, 2), (np.clip(value, -3.2, 3.2), position), fontsize=7, color=INK, va="center",
                      xytext=(-7 if value > 0 else 7, 0), textcoords="offset points",
                      ha="right" if value > 0 else "left")


def _wrapped(name, width=36):
    return "\n".join(wrap(str(name), width, max_lines=2, placeholder=" …"))
