"""Columns side by side: names once, equal columns once, CSV text that reads back."""

import csv
from io import StringIO

import numpy as np
import pytest

from pipeline.views.figures.plotted.columns import Column, Series, Table, named

X = np.array([0.0, 1.0, 2.0])


def curve(label, y, x=X, panel=0, **where):
    return Series(panel, label, (Column("time / s", x, "x"), Column("force / N", np.asarray(y, float), "y")), **where)


@pytest.mark.exact
def test_a_common_abscissa_appears_once_and_names_tell_curves_apart():
    table = Table.of((curve("a", [1, 2, 3]), curve("b", [4, 5, np.nan])))
    assert [column.name for column in table.columns] == ["time / s", "a: force / N", "b: force / N"]
    assert table.text() == "time / s,a: force / N,b: force / N\n0,1,4\n1,2,5\n2,3,\n"
    assert table.places() == [{"panel": 0, "x": 0, "y": 1}, {"panel": 0, "x": 0, "y": 2}]


def test_names_are_unique_whatever_the_labels():
    series = (curve("", [1, 2, 3]), curve("", [2, 2, 2]), curve("", [3, 3], X[:2]),
              curve("", [4, 4, 4], panel=1, title="T"))
    names = [column.name for column in Table.of(series).columns]
    assert len(set(names)) == len(names)
    assert names == ["time / s", "force / N", "(2) force / N", "(2) time / s", "(3) force / N", "T: force / N"]


def test_texts_with_commas_and_shorter_columns_read_back():
    entries, shares = np.array(["a, b", 'c "d"']), np.array([1.5, 2])
    bars = Series(0, "", (Column("entry", entries, "y"), Column("share / %", shares, "x")))
    rows = list(csv.reader(StringIO(Table.of((curve("", [1, 2, 3]), bars)).text())))
    assert rows[0] == ["time / s", "force / N", "entry", "share / %"]
    assert [row[2] for row in rows[1:]] == ["a, b", 'c "d"', ""]


@pytest.mark.exact
def test_numbers_keep_their_digits():
    assert Column("a / m", np.array([1 / 3, 1e-12, np.nan])).texts() == ["0.3333333", "1e-12", ""]
    assert Column("a / m", np.array([1 / 3], np.float32)).texts() == ["0.33333"]


@pytest.mark.exact
def test_a_label_is_a_name_with_a_unit():
    assert named("density / m$^4$") == "density / m^4"
    assert named("residual / N Hz$^{-1/2}$") == "residual / N Hz^-1/2"
    assert named("coefficient\nof friction") == "coefficient of friction / 1"
