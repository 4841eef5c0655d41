"""Every kind of element of axes gives back the numbers that it was drawn from."""

import csv
from io import StringIO

import numpy as np
import pytest

from pipeline.views.figures.style import colour_bar, drawing, legend, svg

X = np.array([1.0, 2.0, 4.0])


def columns(draw, **look):
    """{name: texts} of the CSV file of axes on which ``draw(axes)`` drew."""
    with drawing(**look) as figure:
        axes = figure.subplots()
        draw(axes)
        axes.set(xlabel="time / s", ylabel="force / N")
        rows = list(csv.reader(StringIO(svg(figure).csv)))
    return {name: [row[k] for row in rows[1:] if row[k]] for k, name in enumerate(rows[0])}


def test_curves_are_named_as_in_the_legend_and_marks_by_their_look():
    def draw(axes):
        axes.plot(X, X**2, label="square")
        axes.plot([], [], "o", color="red", label="peaks")
        for k in (5.0, 6.0):
            axes.plot(k, k, "o", color="red")
        axes.plot(X, -X, label="_hidden")
        axes.plot(X, 3 * X, label="_")
        legend(axes)

    assert columns(draw) == {"time / s": ["1", "2", "4"], "square: force / N": ["1", "4", "16"],
                             "peaks: time / s": ["5", "6"], "peaks: force / N": ["5", "6"],
                             "hidden: force / N": ["-1", "-2", "-4"]}


def test_straight_lines_and_bands_are_there_but_not_the_zero():
    def draw(axes):
        axes.axhline(0.0)
        axes.axvline(2.5)
        axes.axhspan(1.0, 2.0, label="_range")

    assert columns(draw) == {"time / s": ["2.5"], "range: force / N": ["1", "2"]}


def test_bars_and_intervals():
    def draw(axes):
        axes.bar([0, 1], [3.0, 5.0], label="count")
        axes.errorbar([0, 1], [3.0, 5.0], [[1.0, 2.0], [0.5, 0.5]], fmt="none")
        axes.set_xticks([0, 1], ["low", "high, or so"])

    assert columns(draw) == {"time / s": ["low", "high, or so"], "count: force / N": ["3", "5"],
                             "lower end: force / N": ["2", "3"], "upper end: force / N": ["3.5", "5.5"]}


def test_lying_bars_that_begin_elsewhere():
    def draw(axes):
        axes.barh([0, 1], [3.0, 5.0], left=[0.0, 3.0])
        axes.set_yticks([0, 1], ["a", "b"])

    assert columns(draw) == {"force / N": ["a", "b"], "time / s": ["3", "8"], "from: time / s": ["0", "3"]}


@pytest.mark.parametrize("kind", ["imshow", "pcolormesh", "contourf"])
def test_maps_give_the_middle_and_the_value_of_each_cell(kind):
    values = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, np.nan]])

    def draw(axes):
        if kind == "imshow":
            shown = axes.imshow(values, origin="lower", extent=(0.5, 3.5, -0.5, 1.5))
        elif kind == "pcolormesh":
            shown = axes.pcolormesh([0.5, 1.5, 2.5, 3.5], [-0.5, 0.5, 1.5], values)
        else:
            shown = axes.contourf([1, 2, 3], [0, 1], values)
            shown.plotted = [1, 2, 3], [0, 1], values
        colour_bar(axes, shown, "level / dB")

    assert columns(draw, bar=True) == {"time / s": ["1", "2", "3", "1", "2"], "force / N": ["0", "0", "0", "1", "1"],
                                       "level / dB": ["1", "2", "3", "4", "5"]}


def test_an_image_from_the_top_is_read_from_the_top():
    read = columns(lambda axes: axes.imshow([[1.0], [2.0]], extent=(0, 1, 0, 2), origin="upper"))
    assert read["force / N"] == ["1.5", "0.5"] and read["value / 1"] == ["1", "2"]


def test_a_large_map_keeps_every_few_cells():
    read = columns(lambda axes: axes.imshow(np.arange(600.0 * 20).reshape(20, 600), extent=(0, 600, 0, 20)))
    assert len(read["value / 1"]) == 200 * 20 and read["value / 1"][:2] == ["0", "3"]


def test_scattered_points_with_colours_areas_and_texts():
    def draw(axes):
        shown = axes.scatter(X, 2 * X, c=[7.0, 8.0, 9.0])
        axes.fill_between(X, X - 1, X + 1, label="_spread")
        axes.annotate("peak", (4.0, 8.0))
        axes.text(0.1, 0.1, "elsewhere", transform=axes.transAxes)
        colour_bar(axes, shown, "growth / 1/s")

    assert columns(draw, bar=True) == {
        "time / s": ["1", "2", "4"], "force / N": ["2", "4", "8"], "growth / 1/s": ["7", "8", "9"],
        "spread: lower edge: force / N": ["0", "1", "3"], "spread: upper edge: force / N": ["2", "3", "5"],
        "written: time / s": ["4"], "written: force / N": ["8"], "text": ["peak"]}


def test_strokes_histograms_and_frames():
    def draw(axes):
        axes.vlines([1.0, 2.0], 0.0, 3.0)
        axes.hist([0.2, 0.4, 1.5], bins=[0, 1, 2], label="draws")

    read = columns(draw)
    assert read["time / s"] == ["1", "1", "2", "2"] and read["force / N"] == ["0", "3", "0", "3"]
    assert read["draws: force / N"] == ["2", "1"] and read["draws: time / s"] == ["0.5", "1.5"]


def test_panels_take_labels_from_their_row_and_column():
    with drawing() as figure:
        grid = figure.subplots(2, 2, sharex=True, sharey=True)
        for k, axes in enumerate(grid.flat):
            axes.plot(X, k * X + 1)
        grid[0, 0].set_ylabel("upper / N")
        grid[1, 0].set_ylabel("lower / N")
        grid[1, 0].set_xlabel("left / s")
        grid[1, 1].set_xlabel("right / s")
        names = [row.split(",") for row in svg(figure).csv.splitlines()][0]
    assert names == ["panel 1: left / s", "panel 1: upper / N", "panel 2: right / s", "panel 2: upper / N",
                     "panel 3: lower / N", "panel 4: lower / N"]
