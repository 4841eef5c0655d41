"""Legends take the room that they need."""

import pytest

from pipeline.views.figures.style import drawing, legend, svg


def fitted(labels, **look):
    """(Margins of the legend in inches: left, right, top; height of the axes in inches; its columns)."""
    with drawing(**look) as figure:
        axes = figure.subplots()
        for k, label in enumerate(labels):
            axes.plot([0, 1], [k, k + 1], label=label)
        axes.set(xlabel="time / s", ylabel="force / N")
        legend(axes)
        box, (width, height) = axes.get_legend().get_window_extent(), figure.get_size_inches()
        svg(figure)
        margins = box.x0 / figure.dpi, width - box.x1 / figure.dpi, height - box.y1 / figure.dpi
        return margins, axes.get_position().height * height, axes.get_legend()._ncols


def test_one_row_of_short_labels_leaves_the_figure_as_it_is():
    margins, high, columns = fitted(["a", "b", "c"])
    assert min(margins) >= 0 and high == pytest.approx(3.2 - 0.52 - 0.34) and columns == 3


def test_five_curves_are_not_clipped_and_the_axes_keep_their_height():
    margins, high, columns = fitted([f"{k}.25 kHz" for k in range(5)])
    assert min(margins) >= 0 and high == pytest.approx(3.2 - 0.52 - 0.34) and columns == 3


def test_long_labels_stand_in_fewer_columns():
    margins, _, columns = fitted([f"{k} MPa, 10.25 rad/s" for k in range(5)])
    assert min(margins) >= 0 and columns == 2
