"""Where the axes of a drawn matplotlib figure lie on its picture, and what their coordinates mean."""

from dataclasses import dataclass

import numpy as np

from pipeline.views.figures.plotted.columns import Column, named


@dataclass(frozen=True)
class Axis:
    """``name`` with unit; limits; ``ticks`` ((coordinate, text), ...) where the coordinates stand for texts."""

    name: str
    limits: tuple
    logarithmic: bool
    ticks: tuple = ()

    def column(self, coordinates, axis):
        """Column of ``coordinates`` (n,): the texts that they stand for, or themselves."""
        values = np.asarray(coordinates, float)
        if self.ticks and len(values):
            at = np.array([position for position, _ in self.ticks])
            reach = 0.5 * np.diff(np.sort(at)).min() if len(at) > 1 else 0.5
            nearest = abs(values[:, None] - at).argmin(axis=1)
            if (abs(values - at[nearest]) <= reach).all():
                texts = np.array([self.ticks[k][1] for k in nearest])
                return Column(self.name.removesuffix(" / 1"), texts, axis)
        return Column(self.name, values, axis)

    def place(self):
        """As JSON: limits, whether logarithmic, coordinates of the texts."""
        made = {"limits": list(self.limits), "log": self.logarithmic}
        return {**made, "texts": {text: position for position, text in self.ticks}} if self.ticks else made


@dataclass(frozen=True)
class Panel:
    """Axes: ``box`` (left, top, right, bottom) in fractions of the picture from its upper left corner."""

    title: str
    box: tuple
    x: Axis
    y: Axis

    def place(self):
        """As JSON."""
        return {"box": list(self.box), "x": self.x.place(), "y": self.y.place()}


def panels(figure):
    """[(axes, Panel)] of a figure that was drawn, its colour bars left out."""
    shown = [axes for axes in figure.axes if not hasattr(axes, "_colorbar") and axes.get_visible()]
    return [(axes, _panel(axes, shown)) for axes in shown]


def _panel(axes, others):
    corner = axes.get_position()
    box = tuple(round(float(v), 5) for v in (corner.x0, 1 - corner.y1, corner.x1, 1 - corner.y0))
    title = next((t for t in (axes.get_title(loc=side) for side in ("center", "left", "right")) if t), "")
    return Panel(" ".join(title.split()), box, _axis(axes, others, "x"), _axis(axes, others, "y"))


def _axis(axes, others, which):
    axis = getattr(axes, f"{which}axis")
    limits = tuple(float(f"{v:.7g}") for v in getattr(axes, f"get_{which}lim")())
    scale = axis.get_scale()
    return Axis(_name(axes, others, which), limits, scale == "log", () if scale != "linear" else _texts(axis))


def _name(axes, others, which):
    """Label of an axis; without one, that of axes in its row or column or that share it, or the only one of all."""
    shared = getattr(axes, f"get_shared_{which}_axes")().get_siblings(axes)
    ends = [_ends(other, which) for other in others]
    aligned = [other for other, reach in zip(others, ends, strict=True) if reach == _ends(axes, which)]
    for among in ((axes,), aligned, [other for other in others if other in shared], others):
        labels = dict.fromkeys(getattr(other, f"get_{which}label")() for other in among)
        labels.pop("", None)
        if len(labels) == 1:
            return named(next(iter(labels)))
    return named(which if not _texts(getattr(axes, f"{which}axis")) else "entry")


def _ends(axes, which):
    """Where axes begin and end across the direction of the axis ``which``: the same in a row for y, a column for x."""
    corner = axes.get_position()
    return tuple(round(float(v), 4) for v in ((corner.x0, corner.x1) if which == "x" else (corner.y0, corner.y1)))


def _texts(axis):
    """((coordinate, text), ...) of ticks whose texts are not their coordinates."""
    from matplotlib.ticker import FixedLocator

    if not isinstance(axis.get_major_locator(), FixedLocator):
        return ()
    ticks = [(float(at), " ".join(label.get_text().split()))
             for at, label in zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=False)]
    ticks = [(at, text) for at, text in ticks if text]
    return () if all(_is(text, at) for at, text in ticks) else tuple(ticks)


def _is(text, coordinate):
    try:
        return bool(np.isclose(float(text.replace("\N{MINUS SIGN}", "-")), coordinate, rtol=0.01, atol=1e-12))
    except ValueError:
        return False
