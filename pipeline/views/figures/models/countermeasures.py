"""Pictures of countermeasures: growth rates before and after, probability of squeal with and without each."""

import numpy as np

from pipeline.views.figures.style import BLUE, FAINT, GREEN, INK, RED, drawing, svg

TWO_PI = 2.0 * np.pi
#: state -> (colour, mark, line) of what is after
_LOOKS = {"gone": (GREEN, "<", "-"), "weaker": (GREEN, "<", "-"), "stronger": (RED, ">", "-"), "new": (RED, ">", "-"),
          "unchanged": (FAINT, "|", "-"), "ambiguous": (FAINT, "d", ":")}


def dumbbells(product, rows, growth):
    """SVG: one line per row of a mode, from its growth rate before (circle) to that after (mark); variants by blocks.

    ``growth`` [(before, after)] in 1/s, None where not known.
    """
    largest = max(g for pair in growth for g in pair if g is not None)
    lowest = min((g for pair in growth for g in pair if g is not None), default=0.0)
    edge = max(lowest, -max(largest, 1.0))
    place, blocks, y = [], {}, 0.0
    for row in rows:
        variant = int(product.mode_variant[row])
        y += 1.0 if variant in blocks else 1.9
        blocks.setdefault(variant, y)
        place.append(y)
    with drawing(0.75 + 0.21 * y, left=0.95, top=0.1) as figure:
        axes = figure.subplots()
        axes.axvline(0.0, color=INK, lw=0.9)
        for height, row, pair in zip(place, rows, growth, strict=True):
            _dumbbell(axes, height, str(product.state[row]), [None if g is None else max(g, edge) for g in pair])
        for variant, height in blocks.items():
            axes.text(0.0, height - 0.95, str(product.variant[variant]).replace("_", " "), fontsize=9, weight="bold",
                      va="center", transform=axes.get_yaxis_transform())
        axes.set_yticks(place, [_frequency(product, row) for row in rows], fontsize=8.5)
        axes.set(xlabel="growth rate / 1/s", ylim=(y + 0.8, 0.3))
        axes.grid(axis="y", visible=False)
        return svg(figure)


def _dumbbell(axes, height, state, pair):
    before, after = pair
    colour, mark, line = _LOOKS[state]
    if before is not None and after is not None:
        axes.plot([before, after], [height, height], color=colour, ls=line, lw=1.5, zorder=2, label="_")
    if before is not None:
        axes.plot(before, height, "o", color=INK, mfc="white", ms=5, zorder=3, label="_before")
    if after is not None:
        axes.plot(after, height, mark, color=colour, ms=7, mew=2 if mark == "|" else 1, zorder=4, clip_on=False,
                  label=f"_after, {state}")


def _frequency(product, row):
    root = product.before[row] if product.before_known[row] else product.after[row]
    return f"{root.imag / TWO_PI / 1e3:.2f} kHz"


def probabilities(product):
    """SVG: share of squealing draws at any operating point, of the case and of each variant, with intervals."""
    names = ["as it is", *(str(name).replace("_", " ") for name in product.variant)]
    share = 100 * np.append(product.overall, product.variant_overall)
    ends = 100 * np.vstack((product.overall_interval, product.variant_overall_interval))
    place = np.arange(len(names))
    with drawing(0.75 + 0.3 * len(names), left=1.35, top=0.1) as figure:
        axes = figure.subplots()
        axes.barh(place, share, 0.62, color=[FAINT, *[BLUE] * len(product.variant)])
        axes.errorbar(share, place, xerr=np.maximum([share - ends[:, 0], ends[:, 1] - share], 0), fmt="none",
                      ecolor=INK, capsize=3, lw=1.2)
        axes.set_yticks(place, names, fontsize=9)
        axes.set(xlabel="squealing draws / %", xlim=(0, 105), ylim=(len(names) - 0.5, -0.5))
        axes.grid(axis="y", visible=False)
        return svg(figure)
