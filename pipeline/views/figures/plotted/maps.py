"""Numbers of maps and of collections of matplotlib: images, meshes, contours, scattered points, areas, strokes."""

import numpy as np

from pipeline.views.figures.plotted.columns import Column

#: most cells of a map along either side: about as many as a picture resolves
_CELLS = 256


def of_image(item, panel, bars):
    """(Label, columns) of an image: the middle and the value of each cell that has one."""
    values = np.ma.filled(np.ma.asarray(item.get_array(), float), np.nan)
    if values.ndim != 2:
        return
    left, right, bottom, top = item.get_extent()
    ends = (bottom, top) if item.origin == "lower" else (top, bottom)
    x, y = (_middles(*limits, count) for limits, count in zip(((left, right), ends), values.shape[::-1], strict=True))
    yield "", _cells(*np.meshgrid(x, y), values, item, panel, bars)


def of_collection(item, label, panel, bars):
    """(Label, columns) of a collection: by what it is."""
    from matplotlib.collections import LineCollection, PathCollection, QuadMesh
    from matplotlib.contour import ContourSet

    if hasattr(item, "plotted"):
        yield label, _cells(*np.meshgrid(*item.plotted[:2]), item.plotted[2], item, panel, bars)
    elif isinstance(item, QuadMesh):
        yield label, _mesh(item, panel, bars)
    elif isinstance(item, PathCollection):
        yield label, _points(np.ma.filled(item.get_offsets().astype(float), np.nan), item, panel, bars)
    elif isinstance(item, LineCollection):
        corners = np.concatenate([np.asarray(s) for s in item.get_segments()] or [np.zeros((0, 2))])
        yield label, [panel.x.column(corners[:, 0], "x"), panel.y.column(corners[:, 1], "y")]
    elif isinstance(item, ContourSet):
        for level, path in zip(item.levels, item.get_paths(), strict=False):
            if len(path.vertices):
                yield f"level {level:.4g}", [panel.x.column(path.vertices[:, 0], "x"),
                                             panel.y.column(path.vertices[:, 1], "y")]
    elif item.get_array() is not None:
        yield label, _points(np.array([p.vertices[:4].mean(axis=0) for p in item.get_paths()]), item, panel, bars)
    else:
        yield label, _between(item, panel)


def _points(points, item, panel, bars):
    columns = [panel.x.column(points[:, 0], "x"), panel.y.column(points[:, 1], "y")]
    if item.get_array() is not None:
        columns.append(Column(_quantity(item, bars), np.ma.filled(np.ma.asarray(item.get_array(), float), np.nan)))
    return columns


def _mesh(item, panel, bars):
    corners = item.get_coordinates()
    values = np.ma.filled(np.ma.asarray(item.get_array(), float), np.nan)
    if values.size != corners[..., 0].size:
        corners = (corners[:-1, :-1] + corners[1:, :-1] + corners[:-1, 1:] + corners[1:, 1:]) / 4
    return _cells(corners[..., 0], corners[..., 1], values.reshape(corners.shape[:2]), item, panel, bars)


def _cells(x, y, values, item, panel, bars):
    """Columns of the cells (rows, columns) of a map, of a large one every few."""
    few = tuple(slice(None, None, -(-count // _CELLS)) for count in values.shape)
    known = np.isfinite(values[few])
    return [panel.x.column(x[few][known], "x"), panel.y.column(y[few][known], "y"),
            Column(_quantity(item, bars), np.asarray(values[few][known], np.float32))]


def _between(item, panel):
    """Columns of the area between two curves: abscissa, lower and upper curve."""
    x, y = np.concatenate([path.vertices for path in item.get_paths()]).T
    at, index = np.unique(x, return_inverse=True)
    low, high = np.full(len(at), np.inf), np.full(len(at), -np.inf)
    np.minimum.at(low, index, y)
    np.maximum.at(high, index, y)
    return [panel.x.column(at, "x"), Column(f"lower edge: {panel.y.name}", low),
            Column(f"upper edge: {panel.y.name}", high)]


def _quantity(item, bars):
    return bars.get(id(item)) or bars.get(None) or "value / 1"


def _middles(first, last, count):
    half = (last - first) / (2 * count)
    return np.linspace(first + half, last - half, count)
