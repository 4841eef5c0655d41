"""Pictures of hypotheses weighed by heard lines: Bayes factors, predicted tones, calibration."""

import numpy as np

from pipeline.views.figures.style import BLUE, FAINT, GREEN, INK, RED, drawing, svg

COLOURS = {"flexible": BLUE, "rigid": RED, "none": FAINT}


def factors(product, names):
    """SVG: Bayes factor of each hypothesis against the reference, with its error; best on top."""
    order = np.argsort(product.factor, kind="stable")
    decades, error = product.factor[order] / np.log(10), product.factor_error[order] / np.log(10)
    with drawing(0.9 + 0.3 * len(order), left=2.05, top=0.2) as figure:
        axes = figure.subplots()
        axes.axvspan(-1, 1, color=FAINT, alpha=0.2, lw=0)
        axes.barh(np.arange(len(order)), decades, 0.65, color=[COLOURS[str(product.disc[k])] for k in order],
                  xerr=error, error_kw={"ecolor": INK, "capsize": 2, "lw": 1.0})
        axes.set_yticks(np.arange(len(order)), [names[k] for k in order], fontsize=8.5)
        axes.set(xlabel="log10 of the Bayes factor")
        axes.grid(axis="y", visible=False)
        return svg(figure)


def tones(product, names, bins=60):
    """SVG: expected number of tones per kHz over frequency of the best hypothesis of either disc, and the lines."""
    edges = np.linspace(*product.band, bins + 1)
    with drawing() as figure:
        axes = figure.subplots()
        for disc, style in (("rigid", "--"), ("flexible", "-")):
            row = best(product, disc)
            count = np.histogram(product.tone[product.tone_hypothesis == row], edges)[0] / product.value.shape[1]
            axes.step(edges[:-1] / 1e3, count / np.diff(edges) * 1e3, where="post", color=COLOURS[disc], ls=style,
                      label=names[row])
        for line in product.line:
            axes.axvline(line / 1e3, color=GREEN, lw=1.2)
        axes.set(xlabel="frequency / kHz (green: heard)", ylabel="predicted tones per kHz", ylim=(0, None))
        figure.legend(loc="upper center", ncols=2, fontsize=8.5)
        return svg(figure)


def simulated(product):
    """SVG: Bayes factors, flexible against rigid disc, of simulated lists, beside that of the heard lines."""
    with drawing() as figure:
        axes = figure.subplots()
        ends = np.percentile(product.simulated, (1, 99))
        bins = np.linspace(*np.clip(ends / np.log(10), -20, 20) + (-0.5, 0.5), 40)
        for disc in ("rigid", "flexible"):
            lists = product.simulated[product.disc == disc].ravel() / np.log(10)
            axes.hist(np.clip(lists, bins[0], bins[-1]), bins, density=True, color=COLOURS[disc], alpha=0.55,
                      label=f"{disc} disc")
        axes.axvline(product.flexible / np.log(10), color=GREEN, label="heard lines")
        axes.set(xlabel="log10 of the Bayes factor, flexible against rigid", ylabel="density of simulated lists")
        figure.legend(loc="upper center", ncols=3, fontsize=8.5)
        return svg(figure)


def best(product, disc):
    """Row of the hypothesis with the largest evidence among those with this ``disc``."""
    return int(np.argmax(np.where(product.disc == disc, product.evidence, -np.inf)))
