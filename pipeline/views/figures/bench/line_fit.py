"""Pictures of heard lines beside the tones that a rigid and a flexible disc predict, and of a cycle of pressure."""

import numpy as np

from pipeline.views.figures.bench.line_evidence import COLOURS, best
from pipeline.views.figures.style import GREEN, INK, SEQUENTIAL, colour_bar, drawing, svg


def before_after(product, names):
    """SVG: tones of the draws of the one-way reference and of the best flexible hypothesis, a row each, those of
    larger evidence higher up and darker; heard lines as vertical lines."""
    low, high = product.band / 1e3
    with drawing(3.6, left=0.5) as figure:
        panels = figure.subplots(2, 1, sharex=True)
        for axes, (row, disc) in zip(panels, pair(product), strict=True):
            for line in product.line:
                axes.axvline(line / 1e3, color=GREEN, lw=1.1, zorder=1)
            members = product.tone_hypothesis == row
            weight = product.weight[row]
            rank = np.argsort(np.argsort(weight, kind="stable"), kind="stable")
            draw = product.tone_draw[members].astype(int)
            share = weight[draw] / weight.max()
            axes.scatter(product.tone[members] / 1e3, rank[draw] / max(len(weight) - 1, 1), s=5 + 14 * share,
                         color=COLOURS[disc], alpha=0.15 + 0.85 * share if len(share) else None, lw=0, zorder=2)
            axes.set(xlim=(low, high), ylim=(-0.05, 1.08), yticks=[])
            axes.set_title(f"{names[row]} ({disc} disc)", fontsize=9, loc="left", pad=3)
            axes.grid(axis="y", visible=False)
        panels[0].set_ylabel("draws")
        panels[1].set(xlabel="frequency / kHz (green: heard)", ylabel="draws")
        return svg(figure)


def pair(product):
    """[(row, disc)]: the one-way reference, and the flexible hypothesis of the largest evidence."""
    row = int(product.reference)
    return [(row, str(product.disc[row])), (best(product, "flexible"), "flexible")]


def cycle(product, titles):
    """SVG: growing modes over the time of a cycle of pressure, a panel for each of its ``titles``, coloured by growth
    rate; heard lines as horizontal lines, and the pressure above."""
    growth, frequency = product.cycle_root.real, abs(product.cycle_root.imag) / (2 * np.pi * 1e3)
    top = max(float(growth.max(initial=0.0)), 1.0)
    with drawing(1.2 + 1.15 * len(titles), left=0.62, bar=True) as figure:
        panels = figure.subplots(1 + len(titles), 1, sharex=True, height_ratios=[0.5] + [1.0] * len(titles))
        panels[0].set_xlim(0, product.cycle_time[0] + product.cycle_time[-1])
        panels[0].plot(product.cycle_time, product.cycle_pressure / 1e6, color=INK, marker="o", ms=2.5)
        panels[0].set_ylabel("p / MPa")
        for k, (axes, title) in enumerate(zip(panels[1:], titles, strict=True)):
            for line in product.line:
                axes.axhline(line / 1e3, color=GREEN, lw=1.0)
            members = product.cycle_root_cycle == k
            shown = axes.scatter(product.cycle_time[product.cycle_root_phase[members].astype(int)], frequency[members],
                                 c=growth[members], cmap=SEQUENTIAL, norm="symlog" if top > 100 else None, s=24,
                                 vmin=0.0, vmax=top, edgecolor=INK, lw=0.4, zorder=3)
            axes.set(ylim=(0, product.band[1] / 1e3), ylabel="f / kHz")
            axes.set_title(title, fontsize=9, loc="left", pad=3)
        panels[-1].set_xlabel("time in the cycle / s (green: heard)")
        colour_bar(list(panels), shown, "growth rate / 1/s")
        return svg(figure)
