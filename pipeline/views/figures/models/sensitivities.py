"""Pictures of sensitivities: what each value changes in the growth rate of a mode."""

import numpy as np

from pipeline.views.figures.style import BLUE, FAINT, INK, RED, drawing, svg


def tornado(product, mode, shown, names, widths):
    """SVG: change of the growth rate of a ``mode`` by one standard deviation of the values ``shown``, largest on top.

    ``names`` and ``widths``: of each value its name and its standard deviation in words.
    """
    change, place = product.change[mode, shown], np.arange(len(shown))[::-1]
    error = product.error[mode, shown] * product.scatter[mode, shown]
    growth = product.root[mode].real
    with drawing(0.75 + 0.29 * len(shown), left=1.98, right=0.12, top=0.12) as figure:
        axes = figure.subplots()
        bars = axes.barh(place, change, 0.7, color=[RED if c > 0 else BLUE for c in change], xerr=error,
                         error_kw={"ecolor": INK, "capsize": 2, "lw": 1.0})
        for bar, p in zip(bars, shown, strict=True):
            if not product.declared[p]:
                bar.set(hatch="////", edgecolor="white", linewidth=0)
        axes.axvline(0.0, color=INK, lw=0.8)
        reach = 1.05 * abs(change).max(initial=0.0) or 1.0
        if growth < 1.6 * reach:
            axes.axvline(-growth, color=INK, lw=1.2, ls="--")
            reach = max(reach, 1.1 * growth)
        for y, c, width in zip(place, change, widths, strict=True):
            axes.text(-np.sign(c) * 0.03 * reach, y, width, ha="right" if c > 0 else "left", va="center", fontsize=8.5,
                      color=FAINT)
        axes.set_yticks(place, names, fontsize=9)
        axes.set(xlabel="change of growth rate / 1/s", xlim=(-reach, reach), ylim=(-0.6, len(shown) - 0.4))
        axes.grid(axis="y", visible=False)
        return svg(figure)
