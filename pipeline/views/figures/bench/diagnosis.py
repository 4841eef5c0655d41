"""Pictures of a diagnosis: location of the mismatch, its explanation, probabilities and residuals."""

import numpy as np

from pipeline.views.figures.number_format import scale
from pipeline.views.figures.style import (
    BLUE,
    COLOURS,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    SEQUENTIAL,
    colour_bar,
    drawing,
    envelope,
    legend,
    svg,
)

#: models in the order of their arrays, with the look of each
MODELS = (("nominal", FAINT, ":"), ("recalibrated", ORANGE, "--"), ("completed", BLUE, "-"))
#: bands of the mismatch map, octaves below half the sampling rate
OCTAVES = 8
#: runs with at most this many samples hold features
FEATURES = 64
#: channels of a mismatch map that have room for names and numbers; its widest left margin, and width of a letter [inch]
NAMED, WIDEST, LETTER = 12, 1.7, 0.083
#: bars of the picture of hypotheses, and panels of that of parameters
BARS, PANELS = 8, 6


def sampled(run):
    """Whether a run holds samples over time; features (growth rates, frequencies) are few, and in no order."""
    return run.measured.shape[1] > FEATURES


def mismatch(product, model):
    """(band edges (b + 1,) Hz, (run, b) residual over noise) of one model; NaN where a run has no such frequency.

    Root mean square per octave of all channels, each over its noise: 1 is noise alone.
    """
    top = max(0.5 * _rate(run) for run in product.runs.values())
    edges = np.concatenate(([0.0], top * 2.0 ** np.arange(-OCTAVES, 1)))
    table = np.full((len(product.runs), len(edges) - 1), np.nan)
    for row, run in enumerate(product.runs.values()):
        white = np.where(run.valid > 0, run.measured - getattr(run, model), 0.0) / run.noise[:, None]
        power = np.mean(np.abs(np.fft.rfft(white, axis=1)) ** 2, axis=0) / white.shape[1]
        frequency = np.fft.rfftfreq(white.shape[1], 1 / _rate(run))
        band = np.clip(np.searchsorted(edges, frequency, side="right") - 1, 0, len(edges) - 2)
        count = np.bincount(band, minlength=len(edges) - 1)
        sums = np.bincount(band, power, len(edges) - 1)
        table[row] = np.sqrt(np.where(count > 0, sums / np.maximum(count, 1), np.nan))
    return edges, table


def by_channel(product, model):
    """(names (c,) of channels, (run, c) residual over noise) of one model; NaN where a run lacks a channel."""
    most = max(len(run.measured) for run in product.runs.values())
    names = [str(product.channel[k]) if k < len(product.channel) else str(k) for k in range(most)]
    table = np.full((len(product.runs), most), np.nan)
    for row, run in enumerate(product.runs.values()):
        left = np.where(run.valid > 0, run.measured - getattr(run, model), 0.0) / run.noise[:, None]
        table[row, :len(left)] = np.sqrt(np.sum(left**2, axis=1) / np.maximum(run.valid.sum(axis=1), 1))
    return names, table


def mismatch_map(product):
    """SVG: residual over noise of every run in every octave, before (recalibrated) and after (completed)."""
    table_of = mismatch if all(map(sampled, product.runs.values())) else by_channel
    edges, recalibrated = table_of(product, "recalibrated")
    tables = (("recalibrated nominal model", recalibrated), ("completed model", table_of(product, "completed")[1]))
    top = max(2.0, float(np.nanmax(recalibrated)))
    runs = [_run_label(n, r) for n, r in product.runs.items()]
    left = np.clip(0.3 + LETTER * max(len(line) for label in runs for line in label.split("\n")), 1.1, WIDEST)
    with drawing(1.35 + 0.56 * len(product.runs), left=left, top=0.3, bar=True) as figure:
        from matplotlib.colors import LogNorm

        for axes, (title, table) in zip(figure.subplots(2, sharex=True), tables, strict=True):
            shown = axes.imshow(np.maximum(table, 1.0), aspect="auto", cmap=SEQUENTIAL, norm=LogNorm(1.0, top))
            if table.shape[1] <= NAMED:
                _tiles(axes, shown, table)
            axes.set_title(title, loc="left", pad=3)
            axes.set_yticks(range(len(runs)), runs)
            axes.grid(False)
            colour_bar(axes, shown, "over noise")
        if table_of is mismatch:
            axes.set_xticks(np.arange(0, len(edges), 2) - 0.5, [f"{e:.3g}" for e in edges[::2]])
            axes.set_xlabel("frequency / Hz")
        elif len(edges) <= NAMED:
            axes.set_xticks(range(len(edges)), edges, rotation=0 if len(edges) < 4 else 40)
        else:
            axes.set_xticks(range(0, len(edges), 5), range(1, len(edges) + 1, 5))
            axes.set_xlabel("gains, delays, then poles")
        return svg(figure)


def points(product, most=6):
    """SVG: first channel of every run of few points, measured beside the models."""
    runs = list(product.runs.items())[:most]
    with drawing(0.9 + 1.25 * ((len(runs) + 1) // 2), left=0.6, top=0.5) as figure:
        grid = figure.subplots((len(runs) + 1) // 2, 2, sharey=True, squeeze=False).ravel()
        for axes, (name, run) in zip(grid, runs, strict=False):
            valid = run.valid[0] > 0
            at = np.arange(1, valid.sum() + 1)
            axes.errorbar(at, run.measured[0, valid], run.noise[0], fmt="o", ms=2.5, color=INK, lw=0.8,
                          label="measured")
            for model, colour, line in MODELS[1:]:
                axes.plot(at, getattr(run, model)[0, valid], line, color=colour, lw=1.2, label=model)
            axes.set_title(_run_label(name, run).replace("\n", " "), loc="left", fontsize=8.5, pad=2)
        for axes in grid[len(runs):]:
            axes.set_visible(False)
        grid[0].set_ylabel(str(product.channel[0]))
        grid[len(runs) - 1].set_xlabel("point")
        figure.legend(*grid[0].get_legend_handles_labels(), loc="upper center", ncols=3)
        return svg(figure)


def stage_place(product):
    """SVG: probability of each stage of the chain at each location, summed over hypotheses."""
    rows = [k for k in range(len(product.hypothesis)) if product.stage[k]]
    stages = list(dict.fromkeys(str(product.stage[k]) for k in rows))
    places = list(dict.fromkeys(str(product.place[k]) for k in rows))
    table = np.zeros((len(stages), len(places)))
    tried = np.zeros(table.shape, bool)
    for k in rows:
        at = stages.index(str(product.stage[k])), places.index(str(product.place[k]))
        table[at] += product.posterior[k]
        tried[at] = True
    with drawing(1.0 + 0.36 * len(stages), left=1.15, bar=True) as figure:
        axes = figure.subplots()
        shown = axes.imshow(np.where(tried, table, np.nan), aspect="auto", cmap=SEQUENTIAL, vmin=0.0, vmax=1.0)
        for i, j in zip(*np.nonzero(tried), strict=True):
            axes.text(j, i, f"{100 * table[i, j]:.0f} %", ha="center", va="center", fontsize=9,
                      color="white" if table[i, j] < 0.6 else INK)
        axes.set_xticks(range(len(places)), places, rotation=0 if len(places) < 5 else 40)
        axes.set_yticks(range(len(stages)), stages)
        axes.grid(False)
        colour_bar(axes, shown, "probability")
        return svg(figure)


def hypotheses(product):
    """SVG: probabilities of the leading hypotheses, those named in full colour."""
    order = np.argsort(-product.posterior, kind="stable")[:BARS][::-1]
    named = {*product.named.tolist(), *product.known.tolist()}
    with drawing(0.9 + 0.34 * len(order), left=1.95, top=0.15, right=0.5) as figure:
        axes = figure.subplots()
        axes.barh(range(len(order)), product.posterior[order],
                  color=[BLUE if k in named else FAINT for k in order], height=0.66)
        for row, k in enumerate(order):
            axes.text(product.posterior[k] + 0.01, row, _share(product.posterior[k]), va="center", fontsize=9)
        axes.set_yticks(range(len(order)), [_words(product.hypothesis[k]) for k in order])
        axes.set(xlim=(0, 1.08), xlabel="probability")
        axes.grid(visible=False, axis="y")
        return svg(figure)


def parameters(product):
    """SVG: density of each fitted value, and the given value."""
    shown = range(min(len(product.parameter), PANELS))
    rows = (len(shown) + 1) // 2
    with drawing(0.45 + 1.25 * rows, left=0.3, top=0.3) as figure:
        grid = figure.subplots(rows, 2, squeeze=False).ravel()
        figure.subplots_adjust(hspace=1.1, wspace=0.12)
        for axes in grid:
            axes.set_axis_off()
        for k, axes in zip(shown, grid, strict=False):
            axes.set_axis_on()
            _density(axes, product, k)
        return svg(figure)


def spectra(product, name, channel):
    """SVG: residual spectrum of each model in one channel of a run, and the noise."""
    run = product.runs[name]
    unit, size = scale(np.abs(run.measured[channel]).max(), str(product.channel_unit[channel]))
    with drawing(3.5, top=0.58) as figure:
        axes = figure.subplots()
        for key, colour, line in MODELS:
            left = np.where(run.valid[channel] > 0, run.measured[channel] - getattr(run, key)[channel], 0.0) / size
            axes.loglog(*_smooth(*_density_of(left, _rate(run))), color=colour, ls=line, label=key)
        noise = (run.noise[channel] / size) ** 2 * 2 / _rate(run)
        axes.axhline(np.sqrt(noise), color=GREEN, lw=1.2, ls="-.", label="noise")
        axes.set(xlabel="frequency / Hz", ylabel=f"residual {product.channel[channel]} / {unit} Hz$^{{-1/2}}$")
        legend(axes, 2)
        return svg(figure)


def trace(product, name, channel):
    """SVG: an excerpt of one channel about its largest motion: measured and predicted, and below the residuals."""
    run = product.runs[name]
    return excerpt(product, name, channel, [(key, getattr(run, key), colour, line) for key, colour, line in MODELS])


def excerpt(product, name, channel, curves, count=400):
    """The same of ``curves`` [(label, predicted (c, n), colour, line)]."""
    run = product.runs[name]
    middle = int(np.argmax(np.abs(run.measured[channel] - run.measured[channel].mean())))
    begin = int(np.clip(middle - count // 2, 0, max(run.measured.shape[1] - count, 0)))
    part = slice(begin, begin + count)
    unit, size = scale(np.abs(run.measured[channel, part]).max(), str(product.channel_unit[channel]))
    time, measured = run.time[part], np.where(run.valid[channel, part] > 0, run.measured[channel, part], np.nan) / size
    with drawing(4.2, top=0.58) as figure:
        above, below = figure.subplots(2, sharex=True, height_ratios=(3, 2))
        above.plot(time, measured, color=INK, lw=2.6, alpha=0.35, label="measured")
        for label, predicted, colour, line in curves:
            values = predicted[channel, part] / size
            above.plot(time, values, color=colour, ls=line, lw=1.2, label=label)
            below.plot(time, measured - values, color=colour, ls=line, lw=1.0)
        above.set_ylabel(f"{product.channel[channel]} / {unit}")
        below.set(xlabel="time / s", ylabel=f"residual / {unit}")
        legend(above, 2)
        return svg(figure)


def regimes(product, names):
    """SVG: how much larger the missing force is in each bin of amplitude, velocity and time; marked: 95 % set."""
    with drawing(0.75 + 1.25 * len(names), left=0.8, top=0.2) as figure:
        grid = figure.subplots(len(names), squeeze=False)[:, 0]
        figure.subplots_adjust(hspace=0.75)
        for axes, name in zip(grid, names, strict=True):
            axis = product.location[name]
            unit, size = scale(max(np.abs(axis.high).max(), np.abs(axis.low).max()), axis.unit.item())
            colours = [BLUE if p <= 0.05 else FAINT for p in axis.p_value]
            axes.bar(axis.low / size, axis.score, (axis.high - axis.low) / size, align="edge", color=colours,
                     edgecolor="white", lw=0.6)
            axes.axhline(0.0, color=INK, lw=0.6)
            axes.set(xlabel=f"{name} / {unit}", ylabel="score")
        return svg(figure)


def measured_and_predicted(run, channels, units, count=4):
    """SVG: channels of a bench run, measured and predicted."""
    shown = range(min(len(run.measured), count))
    with drawing(0.9 + 1.3 * len(shown), left=0.95, top=0.3) as figure:
        grid = figure.subplots(len(shown), sharex=True, squeeze=False)[:, 0]
        for k, axes in zip(shown, grid, strict=True):
            unit, size = scale(np.abs(run.measured[k]).max(initial=0.0), str(units[k]))
            measured = np.where(run.valid[k] > 0, run.measured[k], np.nan) / size
            axes.plot(*envelope(run.time, measured), color=INK, lw=2.2, alpha=0.35, label="measured")
            axes.plot(*envelope(run.time, run.predicted[k] / size), color=COLOURS[0], lw=0.9, label="predicted")
            axes.set_ylabel(f"{channels[k]} / {unit}")
        legend(grid[0], 2)
        grid[-1].set_xlabel("time / s")
        return svg(figure)


def _rate(run):
    return 1 / float(run.time[1] - run.time[0])


def _run_label(name, run):
    return f"{name}\n(held out)" if run.held_out else name


def _tiles(axes, shown, table):
    for (i, j), value in np.ndenumerate(table):
        if np.isfinite(value):
            dark = np.mean(shown.cmap(shown.norm(max(value, 1.0)))[:3]) < 0.5
            axes.text(j, i, "1" if value < 1.25 else f"{value:.2g}" if value < 100 else f"{value:.0f}", ha="center",
                      va="center", fontsize=7.5, color="white" if dark else INK)


def _share(value):
    return "<0.1 %" if value < 1e-3 else f"{100 * value:.3g} %"


def _words(name):
    """'coulomb at guide' as two lines where it is long."""
    text = str(name).replace("_", " ")
    return text if len(text) < 26 else text.replace(" at ", "\nat ").replace(" + ", "\n+ ")


def _density(axes, product, k):
    value, std, given = (float(getattr(product, f"parameter_{key}")[k]) for key in ("value", "std", "nominal"))
    unit, size = scale(max(abs(value), abs(given)), str(product.parameter_unit[k]))
    reach = max(4 * std, 1.15 * abs(value - given), 1e-3 * abs(value), 1e-300)
    x = np.linspace(value - reach, value + reach, 401)
    density = np.exp(-0.5 * ((x - value) / max(std, 1e-6 * reach)) ** 2)
    colour = BLUE if product.parameter_owner[k] else ORANGE
    axes.fill_between(x / size, density, color=colour, alpha=0.5, lw=0)
    axes.plot(value / size, 1.05, "v", color=colour, ms=5)
    axes.axvline(given / size, color=INK, ls="--", lw=1.0)
    axes.set_title(str(product.parameter[k]).replace("@", " at ").replace("_", " "), loc="left", fontsize=8.5, pad=3)
    axes.set_xlabel(f"value / {unit}" if unit != "1" else "", fontsize=8.5, labelpad=1)
    axes.set_ylabel("density", visible=False)
    axes.set_yticks([])
    axes.tick_params(labelsize=8)
    axes.locator_params(axis="x", nbins=4)
    axes.set_ylim(0, 1.2)


def _density_of(signal, rate):
    """Amplitude density (unit / sqrt(Hz)) of a signal, from a Hann window."""
    window = np.hanning(len(signal))
    spectrum = np.abs(np.fft.rfft(signal * window)) * np.sqrt(2 / (rate * np.sum(window**2)))
    return np.fft.rfftfreq(len(signal), 1 / rate)[1:], spectrum[1:]


def _smooth(frequency, amplitude, bins=140):
    """Root mean squares in bins of equal width on the logarithmic axis."""
    edges = np.geomspace(frequency[0], frequency[-1] * 1.0001, bins + 1)
    index = np.searchsorted(edges, frequency, side="right") - 1
    count = np.bincount(index, minlength=bins)
    filled = count > 0
    mean = np.bincount(index, amplitude**2, bins)[filled] / count[filled]
    return np.bincount(index, frequency, bins)[filled] / count[filled], np.sqrt(mean)
