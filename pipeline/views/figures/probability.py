"""Pictures of how likely unstable modes are: per operating point, per 1/3 octave, and what decides."""

import numpy as np

from pipeline.views.figures.style import BLUE, INK, RED, drawing, svg


def per_point(product):
    """SVG: probability of an unstable mode at every operating point, with its interval."""
    names = [f"{p / 1e6:.3g}" for p in product.pressure]
    place, low_high = np.arange(len(names)), _errors(product.probability, product.interval)
    with drawing(3.2, top=0.2) as figure:
        axes = figure.subplots()
        axes.bar(place, 100 * product.probability, 0.7, color=BLUE)
        axes.errorbar(place, 100 * product.probability, 100 * low_high, fmt="none", ecolor=INK, capsize=3, lw=1.2)
        axes.set_xticks(place, [f"{name}\n{speed:.3g}" for name, speed in zip(names, product.speed, strict=True)])
        axes.set(xlabel="pressure / MPa, speed / rad/s", ylabel="unstable draws / %", ylim=(0, 105))
        axes.grid(axis="x", visible=False)
        figure.subplots_adjust(bottom=0.25)
        return svg(figure)


def per_band(product):
    """SVG: probability of an unstable mode in each 1/3 octave at any operating point, with its interval."""
    used = np.flatnonzero(product.band_any > 0)
    shown = slice(used[0], used[-1] + 1) if len(used) else slice(None)
    middle, share, interval = product.band[shown], product.band_any[shown], product.band_interval[shown]
    place = np.arange(len(middle))
    with drawing(3.2, top=0.2) as figure:
        axes = figure.subplots()
        axes.bar(place, 100 * share, 0.8, color=BLUE)
        axes.errorbar(place, 100 * share, 100 * _errors(share, interval), fmt="none", ecolor=INK, capsize=3, lw=1.2)
        axes.set_xticks(place, [f"{nominal(f) / 1e3:g}" for f in middle], rotation=45 if len(middle) > 8 else 0)
        axes.set(xlabel="1/3 octave / kHz", ylabel="unstable draws / %", ylim=(0, 105))
        axes.grid(axis="x", visible=False)
        figure.subplots_adjust(bottom=0.25)
        return svg(figure)


def sensitivities(product, names):
    """SVG: first-order indices of the sources, largest on top; red where more of it means less stable."""
    order = np.argsort(product.sensitivity)
    colours = [RED if product.trend[k] > 0 else BLUE for k in order]
    with drawing(0.9 + 0.26 * len(order), left=2.35, top=0.2) as figure:
        axes = figure.subplots()
        axes.barh(np.arange(len(order)), 100 * product.sensitivity[order], 0.7, color=colours,
                  xerr=100 * product.sensitivity_error[order], error_kw={"ecolor": INK, "capsize": 2, "lw": 1.0})
        axes.set_yticks(np.arange(len(order)), [names[k] for k in order], fontsize=8.5)
        axes.set(xlabel="share of the variance / %", xlim=(0, None))
        axes.grid(axis="y", visible=False)
        return svg(figure)


#: nominal middles of one decade of 1/3 octaves (IEC 61260), in 1/10 of its first
_NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def nominal(middle):
    """Nominal frequency, Hz, of a 1/3 octave with an exact ``middle``."""
    decade, step = divmod(int(np.round(10 * np.log10(middle))), 10)
    return _NOMINAL[step] * 10.0**decade


def _errors(share, interval):
    """(2, n) distances of the ends of the intervals."""
    return np.maximum([share - interval[:, 0], interval[:, 1] - share], 0.0)
