"""Scans that state no unit or no size: points and matrices of heights; the case states the rest."""

import re
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.plain_text import cells, decoded, lines_of, marks, number
from pipeline.contract.units import in_si
from pipeline.physics.rough.topography import Scan

#: texts of missing heights in files of scans; lines that show how the numbers are written; unit in a head
_MISSING = frozenset({"bad", "***", "*", "x", "nd", "no data", "nodata"})
_SHOWN, _UNIT = 40, re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]")
#: share of the largest step beyond which two coordinates are of neighbouring rows; how far a point may lie off its row
_STEP, _OFF = 0.2, 0.1
#: how far pixels may differ that are called square
_SQUARE = 1e-3


def scaled(path, heights, stated, where, cause):
    """Scan of a file without unit or size, by what a section ``stated``: ``height_unit``, ``pixel_size``,
    ``pixel_size_y``, ``lateral_unit`` in m, None where it does not.

    ``heights`` (row, column) as a reader has them, None: those of a text file. Raises ConfigError at ``where`` that
    says what was understood and which setting is missing, and ``cause`` for a file that is no text.
    """
    if heights is not None:
        return _matrix(heights, f"an array of {_shape(heights)}", stated, where)
    numbers, units, shown = _numbers(path, cause)
    if numbers.shape[1] == 3 or (numbers.shape[1] == 4 and len(numbers) > 4 * numbers.shape[1]):
        return _points(numbers[:, :3], units, shown, stated, where)
    return _matrix(numbers, f"a matrix of {_shape(numbers)}, {shown}", stated, where)


def _shape(heights):
    finite = heights[np.isfinite(heights)]
    limits = f" from {finite.min():.4g} to {finite.max():.4g}" if finite.size else ""
    return f"{heights.shape[0]} rows (y) of {heights.shape[1]} heights (x){limits}"


def _numbers(path, cause):
    """(numbers (row, column), units of the head, how they are understood) of a text file."""
    try:
        text, encoding = decoded(Path(path))
    except ConfigError:
        raise cause from None
    filled = [(k + 1, line) for k, line in enumerate(lines_of(text)) if line.strip()] or [(0, "")]
    numbered, lines = zip(*filled, strict=True)
    later = lines[len(lines) // 2:][:_SHOWN]
    delimiter, decimal = marks([], later)
    known = {len(_values(line, delimiter, decimal)) for line in later if _values(line, delimiter, decimal)}
    first = next((k for k, line in enumerate(lines) if len(_values(line, delimiter, decimal)) in known), len(lines))
    if len(known) != 1 or len(lines) - first < 2:
        raise cause
    mark = {"\t": "tabs", " ": "blanks"}.get(delimiter, repr(delimiter))
    shown = f"numbers by {mark}, decimal {decimal!r}, from line {numbered[first]}: {lines[first].strip()[:40]!r}"
    units = _UNIT.findall(lines[first - 1]) if first else []
    return _array(lines[first:], delimiter, decimal, known.pop(), f"{path}:{{}}", numbered[first:]), units, shown


def _values(line, delimiter, decimal):
    """Numbers of a line, NaN of missing ones; none where a text is no number."""
    texts = cells(line, delimiter)
    texts = texts[:-1] if len(texts) > 1 and not texts[-1] and line.rstrip().endswith(delimiter) else texts
    values = [np.nan if text.lower() in _MISSING else number(text, decimal) for text in texts]
    return [] if None in values or not np.isfinite(values).any() else values


def _array(lines, delimiter, decimal, width, where, numbered):
    """Numbers (row, column) of lines of ``width`` columns; ``where`` takes the number of a line."""
    plain = [line.replace(",", ".") for line in lines] if decimal == "," else lines
    try:
        array = np.loadtxt(plain, delimiter=None if delimiter == " " else delimiter, comments=None, ndmin=2)
        if array.shape[1] == width:
            return array
    except ValueError:
        pass
    rows = []
    for k, line in enumerate(lines):
        texts = cells(line, delimiter)[:width]
        values = [np.nan if text.lower() in _MISSING else number(text, decimal) for text in texts]
        if len(values) != width or None in values:
            raise ConfigError(where.format(numbered[k]), f"{width} numbers", repr(line.strip()[:60]),
                              "save missing heights as NaN")
        rows.append(values)
    return np.array(rows, float)


def _matrix(heights, shown, stated, where):
    """Scan of a matrix of heights."""
    lacks = [f"{name}: {such}" for name, such in (("pixel_size", "2 um"), ("height_unit", "1 um"))
             if stated[name] is None]
    if lacks:
        raise ConfigError(where, "the distance of neighbouring heights and what 1 of them is, which the file does not"
                          " state", shown,
                          f"state {' and '.join(lacks)}, say; transposed: true if x runs along columns")
    if stated["lateral_unit"] is not None:
        raise ConfigError(f"{where}: lateral_unit", "pixel_size alone, as the file has no coordinates", shown)
    spacing = (stated["pixel_size_y"] or stated["pixel_size"], stated["pixel_size"])
    return _checked(heights * stated["height_unit"], spacing, f"rows along y, pixels of {_size(spacing)}, heights times"
                    f" {stated['height_unit']:g} m", where)


def _points(points, units, shown, stated, where):
    """Scan of points x, y, z on a regular grid, in any order; places without a point are missing."""
    shown = f"{len(points)} points x y z, {shown}"
    lateral, height = _scales(units, stated)
    if height is None:
        raise ConfigError(where, "the unit of points x y z, which the file does not state", shown,
                          "state height_unit: 1 um, say, and lateral_unit, where x and y have another")
    if stated["pixel_size"] is not None or stated["pixel_size_y"] is not None:
        raise ConfigError(f"{where}: pixel_size", "none, as the points have their coordinates", shown,
                          "state lateral_unit, what 1 of x and y is")
    points = points[np.isfinite(points[:, :2]).all(axis=1)]
    (column, dx), (row, dy) = (_grid(points[:, k], "xy"[k], shown, where) for k in (0, 1))
    heights = np.full((row.max() + 1, column.max() + 1), np.nan)
    count = np.zeros(heights.shape, int)
    np.add.at(count, (row, column), 1)
    if (count > 1).any():
        raise ConfigError(where, "one point at each place of a grid", f"{(count > 1).sum()} places with several",
                          "save a grid, not a cloud: interpolate it")
    heights[row, column] = points[:, 2]
    spacing = (dy * lateral, dx * lateral)
    told = (f"{len(points)} points on a grid of {heights.shape[0]} by {heights.shape[1]}, {_size(spacing)} apart, x and"
            f" y times {lateral:g} m, heights times {height:g} m")
    return _checked(heights * height, spacing, told, where)


def _scales(units, stated):
    """(metres of 1 in x and y, of 1 in z) of points; as the section states them, else by the units of the head."""
    found = []
    for unit in units:
        try:
            value, name = in_si(1.0, unit, "unit")
        except ConfigError:
            value, name = None, ""
        found.append(value if name == "m" else None)
    lateral, height = (found[0], found[2]) if len(found) == 3 and found[0] == found[1] else (None, None)
    height = stated["height_unit"] or height
    return stated["lateral_unit"] or lateral or height, height


def _grid(values, axis, shown, where):
    """(places (point,) on a regular grid, its step) of coordinates; ConfigError where they lie on none."""
    levels = np.unique(values)
    steps = np.diff(levels)
    steps = steps[steps > _STEP * steps.max()] if steps.size else steps
    step = float(np.median(steps)) if steps.size else 0.0
    place = np.rint((values - levels[0]) / step).astype(int) if step else np.zeros(len(values), int)
    if step and place.max():
        step = (levels[-1] - levels[0]) / place.max()
        place = np.rint((values - levels[0]) / step).astype(int)
    off = np.abs((values - levels[0]) / step - place).max() if step else np.inf
    if off > _OFF or place.max() < 1 or place.max() + 1 > len(values) // 2:
        raise ConfigError(where, f"points on a regular grid along x and y, more than one along {axis}",
                          f"{len(levels)} values of {axis}, which lie on none; {shown}",
                          "interpolate the cloud onto a grid, and save it as a matrix of heights")
    return place, step


def _size(spacing):
    dy, dx = spacing
    return f"{dx:.4g} m" if abs(dy - dx) < _SQUARE * dx else f"{dx:.4g} m along x and {dy:.4g} m along y"


def _checked(heights, spacing, told, where):
    if not np.isfinite(heights).any():
        raise ConfigError(where, "measured heights", "no value that is a number", "choose another scan")
    if not np.ptp(heights[np.isfinite(heights)]) > 0:
        raise ConfigError(where, "heights that vary", "a constant surface", "choose another scan")
    return Scan(heights, tuple(map(float, spacing)), told)
