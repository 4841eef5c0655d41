"""Numbers of the elements of matplotlib axes: curves, markers, bars, intervals, areas, maps, texts."""

import numpy as np

from pipeline.views.figures.plotted.columns import Column, Series, named
from pipeline.views.figures.plotted.maps import of_collection, of_image
from pipeline.views.figures.plotted.panels import panels

#: unlabelled lines of so many points belong together: marks and strokes
_STROKE = 2


def numbers(figure):
    """(Panels, Series), tuples, of a matplotlib Figure that was drawn.

    A label of an element that begins with '_' names its data, but is left out of legends; '_' alone: no data.
    """
    made, series = panels(figure), []
    repeated = len({panel.y.name for _, panel in made}) < len(made)
    looks = {_look(line): _label(line) for axes in figure.axes for line in axes.lines if _label(line)}
    bars = _colour_bars(figure)
    for index, (axes, panel) in enumerate(made):
        title = (panel.title or f"panel {index + 1}") if len(made) > 1 else ""
        for label, columns in _elements(axes, panel, bars, looks):
            if len(columns[0].values):
                series.append(Series(index, label, tuple(columns), title, repeated))
    return tuple(panel for _, panel in made), tuple(series)


def _elements(axes, panel, bars, looks):
    """(Label, columns) of everything drawn in some axes: first maps, then the other elements."""
    drawn = {id(part) for container in axes.containers for part in _parts(container)}
    others = {kind: [item for item in getattr(axes, kind) if id(item) not in drawn and item.get_label() != "_"]
              for kind in ("lines", "collections", "patches")}
    maps = [item for item in others["collections"] if item.get_array() is not None]
    for item in axes.images:
        yield from of_image(item, panel, bars)
    for item in [*maps, *(item for item in others["collections"] if item not in maps)]:
        yield from of_collection(item, _label(item), panel, bars)
    for container in axes.containers:
        yield from _container(container, panel)
    yield from _lines([line for line in others["lines"] if _in_data(line, axes)], panel, looks)
    yield from _straight(axes, others, panel)
    yield from _outlines([patch for patch in others["patches"] if _in_data(patch, axes)], panel)
    yield from _texts(axes, panel)


def _parts(container):
    for part in container:
        yield from part if isinstance(part, (tuple, list)) else (part,)


def _container(container, panel):
    """(Label, columns) of bars, or of points with intervals."""
    label = _label(container)
    if hasattr(container, "patches"):
        return [(label or _label(container.patches[0]), _bars(container, panel))] if len(container.patches) else []
    line, _, collections = container.lines
    made = []
    columns = [] if line is None else [panel.x.column(line.get_xdata(), "x"), panel.y.column(line.get_ydata(), "y")]
    for collection in collections:
        ends = np.array([segment for segment in collection.get_segments() if len(segment) == 2]).reshape(-1, 2, 2)
        across = int(np.ptp(ends[:, :, 1], axis=1).max(initial=0.0) > np.ptp(ends[:, :, 0], axis=1).max(initial=0.0))
        axis = (panel.x, panel.y)[across]
        low_high = [Column(f"{side} end: {axis.name}", ends[:, k, across]) for k, side in enumerate(("lower", "upper"))]
        if columns and len(ends) == len(columns[0].values):
            columns += low_high
        else:
            other = (panel.y, panel.x)[across].column(ends[:, 0, 1 - across], "yx"[across])
            made.append((label, [other, *low_high]))
    return [(label, columns), *made] if columns else made


def _bars(container, panel):
    """Columns of bars: where they are, and how far they reach; where they begin, if not at zero."""
    boxes = np.array([[*patch.get_xy(), patch.get_width(), patch.get_height()] for patch in container.patches])
    x, y, width, height = boxes.T
    if container.orientation == "vertical":
        place, value, base = panel.x.column(x + width / 2, "x"), Column(panel.y.name, y + height, "y"), y
    else:
        place, value, base = panel.y.column(y + height / 2, "y"), Column(panel.x.name, x + width, "x"), x
    return [place, value, *([Column(f"from: {value.name}", base)] if base.any() else [])]


def _lines(lines, panel, looks):
    """(Label, columns) of curves and marks; those of one look are named as the legend names it, and few points of one
    look are one series."""
    grouped = {}
    for line in lines:
        x, y = (np.ma.filled(np.ma.asarray(values, float), np.nan) for values in line.get_data())
        if len(x):
            label = _label(line) or looks.get(_look(line), "")
            key = (label, None if label else _look(line), len(x)) if len(x) <= _STROKE else id(line)
            grouped.setdefault(key, (label, []))[1].append((x, y))
    for label, members in grouped.values():
        x, y = (np.concatenate(values) for values in zip(*members, strict=True))
        yield label, [panel.x.column(x, "x"), panel.y.column(y, "y")]


def _look(line):
    from matplotlib.colors import to_hex

    return to_hex(line.get_color()), line.get_marker(), line.get_linestyle()


def _straight(axes, others, panel):
    """Lines and bands across the whole axes, other than the line at zero."""
    for axis, which in ((panel.x, "x"), (panel.y, "y")):
        across = getattr(axes, f"get_{which}axis_transform")()
        values = [line.get_data()["xy".index(which)][0] for line in others["lines"] if line.get_transform() == across]
        values = [float(value) for value in values if value != 0.0]
        if values:
            yield f"lines at {which}", [Column(axis.name, np.array(values), which)]
        for patch in others["patches"]:
            if patch.get_data_transform() == across:
                ends = patch.get_extents().transformed(axes.transData.inverted())
                yield _label(patch) or "band", [Column(axis.name, np.array(getattr(ends, f"interval{which}")), which)]


def _outlines(patches, panel):
    """Middles of rectangles; outlines of other areas, such as the steps of a histogram."""
    middles = {}
    for patch in patches:
        corners = patch.get_patch_transform().transform(patch.get_path().vertices)
        if hasattr(patch, "get_width"):
            middles.setdefault(_label(patch), []).append(corners[:4].mean(axis=0))
        else:
            yield _label(patch), [panel.x.column(corners[:, 0], "x"), panel.y.column(corners[:, 1], "y")]
    for label, points in middles.items():
        x, y = np.transpose(points)
        yield label, [panel.x.column(x, "x"), panel.y.column(y, "y")]


def _texts(axes, panel):
    """Texts at points of the data."""
    rows = []
    for item in axes.texts:
        if hasattr(item, "xycoords"):
            where = item.xy if item.xycoords == "data" else None
        else:
            where = item.get_position() if item.get_transform() == axes.transData else None
        if where is not None and item.get_text():
            rows.append((*where, " ".join(item.get_text().split())))
    if rows:
        x, y, texts = zip(*rows, strict=True)
        yield "written", [panel.x.column(x, "x"), panel.y.column(y, "y"), Column("text", np.array(texts))]


def _in_data(artist, axes):
    """Whether the coordinates of a line or patch are those of the axes."""
    transform = artist.get_data_transform() if hasattr(artist, "get_data_transform") else artist.get_transform()
    return transform == axes.transData


def _label(artist):
    label = " ".join(str(artist.get_label() or "").split())
    return "" if label.startswith(("_child", "_container", "_nolegend_")) else label.removeprefix("_")


def _colour_bars(figure):
    """Names of the quantities of the colour bars: {id of what is coloured: name}, and under None the only one."""
    made = {}
    for axes in [*figure.axes, *(child for parent in figure.axes for child in parent.child_axes)]:
        bar = getattr(axes, "_colorbar", None)
        if bar is not None:
            label = axes.get_ylabel() or axes.get_xlabel()
            made[id(bar.mappable)] = made[None] = named(label or "value")
    return made
