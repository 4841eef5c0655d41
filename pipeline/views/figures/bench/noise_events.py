"""Pictures of noise events: spectrogram with the events on it, levels over frequency, occurrence over conditions."""

import numpy as np

from pipeline.views.figures.style import (
    COLOURS,
    FAINT,
    INK,
    MARKERS,
    RED,
    SEQUENTIAL,
    colour_bar,
    drawing,
    legend,
    png,
    readable_on,
    svg,
)

#: colours of the kinds that are drawn, in the order of their importance
KINDS = {"squeal": RED, "harmonic": COLOURS[4], "clipping": FAINT, "sweep": COLOURS[5], "series": COLOURS[5],
         "broadband": FAINT, "moan": COLOURS[2], "groan": COLOURS[2], "judder": COLOURS[2]}
#: dB that a spectrogram shows
_RANGE = 60.0
#: size and zero of the units of the conditions, and their names
_SIZES = {"pressure": (1e5, 0.0, "bar"), "speed": (1.0, 0.0, "rad/s"), "temperature": (1.0, 273.15, "°C")}
#: so many modes are all drawn across
_FEW = 12


def spectrogram(product, record, dpi):
    """PNG of the level over time and frequency of one record; lines: its events, red is squeal."""
    shown = product.spectrogram[f"{product.record_run[record]}.{product.record_channel[record]}"]
    top = shown.level.max()
    with drawing(3.4, bar=True) as figure:
        axes = figure.subplots()
        image = axes.pcolormesh(shown.time, shown.frequency / 1e3, shown.level.T, cmap=SEQUENTIAL, vmin=top - _RANGE,
                                vmax=top, shading="nearest", rasterized=True)
        for k in np.flatnonzero(product.event_record == record):
            if str(product.event_kind[k]) == "broadband":
                continue
            begin, height = product.event_start[k], product.event_frequency[k] / 1e3
            axes.plot([begin, begin + product.event_duration[k]], [height, height], lw=4.5, color="white", alpha=0.55,
                      solid_capstyle="butt", label="_")
            axes.plot([begin, begin + product.event_duration[k]], [height, height], lw=1.4,
                      color=KINDS[str(product.event_kind[k])], solid_capstyle="butt",
                      label=f"_{product.event_kind[k]}")
        axes.set(xlabel="time / s", ylabel="frequency / kHz", ylim=(0, shown.frequency[-1] / 1e3))
        _modes(axes, product, shown)
        axes.grid(False)
        unit = "dB(A)" if product.record_kind[record] == "sound" else "dB re 1 µm/s²"
        colour_bar(axes, image, f"level / {unit}")
        return png(figure, dpi)


def _modes(axes, product, shown):
    """Dashed lines at the natural frequencies of named modes: all if they are few, else the unstable and those near an
    event, the others as ticks; names at the left, of none that would cover another."""
    inside = np.flatnonzero(product.mode_frequency < shown.frequency[-1])
    named = np.isin(inside, product.event_mode) | (product.mode_unstable[inside] == 1) | (len(inside) <= _FEW)
    begin, end = axes.get_xlim()
    last = -np.inf
    for k, whole in zip(inside, named, strict=True):
        height = product.mode_frequency[k] / 1e3
        axes.plot([begin, end if whole else begin + 0.02 * (end - begin)], [height, height], color="white", lw=0.7,
                  zorder=1.5, ls="--" if product.mode_unstable[k] else ":", label="_modes")
        if whole and height - last > 0.04 * shown.frequency[-1] / 1e3:
            last = height
            name = f"{product.mode_name[k]}{', unstable' if product.mode_unstable[k] == 1 else ''}"
            axes.annotate(name, (begin, height), (3, 1), textcoords="offset points", color="white", fontsize=7.5)
    axes.set_xlim(begin, end)


def level_frequency(product):
    """SVG of the level of every event of a microphone over its frequency, by kind; dashed: the threshold."""
    sound = product.record_kind[product.event_record] == "sound"
    with drawing(top=0.5) as figure:
        axes = figure.subplots()
        for marker, (kind, colour) in zip(MARKERS * 2, KINDS.items(), strict=False):
            rows = sound & (product.event_kind == kind)
            if rows.any() and kind != "broadband":
                axes.plot(product.event_frequency[rows] / 1e3, product.event_level[rows], marker, color=colour,
                          label=f"{kind} ({np.count_nonzero(rows)})", ls="none")
        axes.axhline(float(product.threshold), color=INK, lw=1.1, ls="--")
        axes.set(xlabel="frequency / kHz", ylabel="level / dB(A)", xlim=(0, 1.05 * product.band[1] / 1e3))
        legend(axes)
        return svg(figure)


def heard(product):
    """(event,) whether an event is squeal: of microphones, or of accelerometers in runs that have none."""
    sound = product.record_kind == "sound"
    listened = np.isin(product.record_run, product.record_run[sound])
    return (product.event_kind == "squeal") & (sound | ~listened)[product.event_record]


def told(product, *conditions):
    """(event,) whether an event is squeal of which these conditions are known."""
    columns = [list(map(str, product.condition)).index(name) for name in conditions]
    return heard(product) & product.event_condition_known[:, columns].all(axis=1)


def occurrence(one):
    """SVG of the share of the time with squeal over two conditions, with the runs counted."""
    share = 100.0 * np.divide(one.squealing, one.time, out=np.zeros_like(one.time), where=one.time > 0)
    return _bins(one, np.where(one.time > 0, share, np.nan), "share of time / %", vmin=0.0)


def loudest(one):
    """SVG of the largest level of squeal over two conditions, with the runs counted."""
    return _bins(one, np.where(one.squealing > 0, one.level, np.nan), "level / dB")


def _bins(one, values, label, **look):
    edges = [(edge - zero) / size for edge, (size, zero, _) in zip(
        (one.first_edge, one.second_edge), (_SIZES[str(name)] for name in one.condition), strict=True)]
    with drawing(3.4, bar=True) as figure:
        axes = figure.subplots()
        shown = axes.pcolormesh(*edges, values.T, cmap=SEQUENTIAL, **look)
        for i, j in np.argwhere(one.runs > 0):
            colour = readable_on(shown, values[i, j]) if np.isfinite(values[i, j]) else INK
            axes.text(edges[0][i:i + 2].mean(), edges[1][j:j + 2].mean(),
                      f"{one.squealing_runs[i, j]}/{one.runs[i, j]}", ha="center", va="center", color=colour,
                      fontsize=8 if max(values.shape) < 8 else 6)
        axes.set(**{f"{axis}label": f"{name} / {_SIZES[str(name)][2]}" for axis, name in zip(
            "xy", one.condition, strict=True)})
        axes.grid(False)
        colour_bar(axes, shown, label)
        return svg(figure)


def over_conditions(product, first, second):
    """SVG of squeal over two conditions, such as 'pressure' and 'speed': one marker an event, larger if louder."""
    column = {str(name): k for k, name in enumerate(product.condition)}
    squeal = told(product, first, second)
    with drawing() as figure:
        axes = figure.subplots()
        x, y = ((product.event_condition[squeal, column[name]] - _SIZES[name][1]) / _SIZES[name][0]
                for name in (first, second))
        over = product.event_level[squeal] - product.threshold
        axes.scatter(x, y, s=12 + 6 * np.clip(over, 0, 40), color=RED, alpha=0.6, lw=0)
        axes.set(xlabel=f"{first} / {_SIZES[first][2]}", ylabel=f"{second} / {_SIZES[second][2]}")
        return svg(figure)
