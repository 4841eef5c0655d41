"""Pictures of a noise matrix: occurrence over pressure and speed, by 1/3 octave, and over the brakes."""

from dataclasses import dataclass

import numpy as np

from pipeline.views.figures.probability import nominal
from pipeline.views.figures.style import BLUE, INK, RED, SEQUENTIAL, colour_bar, drawing, legend, readable_on, svg

#: from the speed at the begin of a stop to that at its end
ARROW = "\N{RIGHTWARDS ARROW}"


@dataclass(frozen=True)
class Tile:
    """Conditions of one kind, speed and pressure, at any temperature: ``column`` name, ``pressure`` Pa, ``share``
    noisy, ``stops`` recorded, ``noisy`` of them, and their ``difference``: 1 too much, -1 too little."""

    column: str
    pressure: float
    share: float
    stops: int
    noisy: int
    difference: int


def column(product, k):
    """Kind and speed of a condition in km/h."""
    begin, end = 3.6 * product.speed[k], 3.6 * product.end[k]
    way = "R " if begin < 0 else ""
    return f"{way}{abs(begin):.3g}" + ("" if product.kind[k] == "drag" else f"{ARROW}{abs(end):.3g}")


def tiles(product):
    """[Tile] of a product NoiseMatrix, in the order of its conditions."""
    groups, uses = {}, product.applications.sum(axis=0)
    for k in range(len(product.kind)):
        groups.setdefault((column(product, k), float(product.pressure[k])), []).append(k)
    return [Tile(name, pressure, float(np.average(product.probability[rows], weights=uses[rows])),
                 int(product.condition_stops[rows].sum()), int(product.condition_noisy[rows].sum()),
                 _strongest(product, rows)) for (name, pressure), rows in groups.items()]


def _strongest(product, rows):
    """Difference of the condition with the smallest p-value among those that differ; 0 of none."""
    apart = [k for k in rows if product.condition_difference[k]]
    return int(product.condition_difference[min(apart, key=lambda k: product.condition_p_value[k])]) if apart else 0


def matrix(product):
    """SVG: predicted occurrence of every pressure and speed, recorded stops below it, frames where they differ."""
    made = tiles(product)
    columns = list(dict.fromkeys(tile.column for tile in made))
    pressures = sorted({tile.pressure for tile in made})
    grid = np.full((len(pressures), len(columns)), np.nan)
    for tile in made:
        grid[pressures.index(tile.pressure), columns.index(tile.column)] = 100 * tile.share
    with drawing(1.2 + 0.42 * len(pressures), bar=True) as figure:
        axes = figure.subplots()
        shown = axes.imshow(grid, origin="lower", aspect="auto", cmap=SEQUENTIAL, vmin=0, vmax=100)
        for tile in made:
            _written(axes, tile, columns.index(tile.column), pressures.index(tile.pressure), shown)
        axes.set_xticks(range(len(columns)), columns)
        axes.set_yticks(range(len(pressures)), [f"{p / 1e5:.3g}" for p in pressures])
        axes.set(xlabel="speed / km/h (R: reverse)", ylabel="line pressure / bar")
        axes.grid(False)
        colour_bar(axes, shown, "predicted noisy / %")
        figure.subplots_adjust(bottom=0.6 / figure.get_figheight())
        return svg(figure)


def _written(axes, tile, x, y, shown):
    colour = readable_on(shown, 100 * tile.share)
    text = f"{100 * tile.share:.0f}" + (f"\n{tile.noisy}/{tile.stops}" if tile.stops else "")
    axes.text(x, y, text, ha="center", va="center", fontsize=9, linespacing=1.1, color=colour)
    if tile.difference:
        from matplotlib.patches import Rectangle

        axes.add_patch(Rectangle((x - 0.46, y - 0.45), 0.92, 0.9, fill=False, lw=2.6,
                                 ec=RED if tile.difference < 0 else "white", ls="-" if tile.difference < 0 else "--"))


def bands(product):
    """SVG: share of noisy applications in each 1/3 octave; beside recorded stops, of these and predicted for them."""
    total = int(product.condition_stops.sum())
    share = product.band_expected / total if total else product.band_occurrence
    heard = product.band_noisy / total if total else np.zeros(len(share))
    used = np.flatnonzero(share + heard > 0)
    rows = slice(used[0], used[-1] + 1) if len(used) else slice(None)
    place = np.arange(len(share[rows]))
    with drawing(3.2, top=0.5 if total else 0.2) as figure:
        axes = figure.subplots()
        width = 0.4 if total else 0.8
        axes.bar(place - (width / 2 if total else 0), 100 * share[rows], width, color=BLUE, label="predicted")
        if total:
            axes.bar(place + width / 2, 100 * heard[rows], width, color=RED, label="recorded", hatch="///", ec="white")
            for k in np.flatnonzero(product.band_difference[rows]):
                axes.annotate("*", (place[k], 100 * max(share[rows][k], heard[rows][k])), ha="center", fontsize=13)
            legend(axes)
        axes.set_xticks(place, [f"{nominal(f) / 1e3:g}" for f in product.band[rows]],
                        rotation=45 if len(place) > 8 else 0)
        axes.set(xlabel="1/3 octave / kHz", ylabel="noisy stops / %")
        axes.grid(axis="x", visible=False)
        figure.subplots_adjust(bottom=0.25)
        return svg(figure)


def brakes(product):
    """SVG: which share of the brakes has at most so many noisy applications of the schedule."""
    ordered = 100 * np.sort(product.brake_occurrence)
    with drawing(3.0, top=0.2) as figure:
        axes = figure.subplots()
        axes.step([0, *ordered, 100], [0, *(100 * np.arange(1, len(ordered) + 1) / len(ordered)), 100], where="post",
                  color=BLUE)
        axes.axvline(100 * float(product.occurrence), color=INK, lw=1.1, ls="--")
        axes.set(xlabel="noisy applications / %", ylabel="brakes with at most so many / %", xlim=(0, 100),
                 ylim=(0, 103))
        return svg(figure)
