"""Axes of materials: cylindrical ones at places, further turns, and names of the axes of a file."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.axes import Axes, file_axes, middles, names_of, through, turn
from pipeline.decks.meshes.deck import Draft

pytestmark = pytest.mark.exact


def test_cylindrical_axes_at_places():
    axes = Axes(np.eye(3), np.array([1.0, 0, 0]), True)
    rows = axes.at([(2, 0, 5), (1, 3, 0), (1, 0, 9)])
    assert np.allclose(rows[0], np.eye(3))
    assert np.allclose(rows[1], [(0, 1, 0), (-1, 0, 0), (0, 0, 1)])
    assert np.allclose(rows[2], np.eye(3)), "on the axis itself"
    assert np.allclose(np.linalg.det(rows), 1)


def test_a_further_turn_about_each_vector():
    for number, (moved, onto) in enumerate([(1, 2), (2, 0), (0, 1)]):
        turned = turn(number, np.pi / 2) @ np.eye(3)
        assert np.allclose(turned[number], np.eye(3)[number]) and np.allclose(turned[moved], np.eye(3)[onto])
    assert np.allclose(Axes(np.eye(3), further=((2, np.pi / 6),)).at((0, 0, 0))[0, 0], (np.sqrt(0.75), 0.5, 0))


def test_through_points():
    assert np.allclose(through((0, 0, 2), (1, 0, 1), "a"), np.eye(3))
    with pytest.raises(ConfigError, match="a: expected points that span a plane"):
        through((0, 0, 2), (0, 0, 1), "a")


def test_middles_of_elements():
    draft = Draft("a", label=[5, 6, 9], position=[(0, 0, 0), (2, 0, 0), (0, 4, 0)], elements={"any": [(3, [5, 6, 9])]})
    assert middles(draft, [3, 7]) == pytest.approx(np.array([(2 / 3, 4 / 3, 0), (0, 0, 0)]))


@pytest.mark.parametrize("names", [("x", "y", "z"), ("y", "z", "x"), ("y", "-z", "-x"), ("-y", "x", "z")])
def test_names_of_axes_and_back(names):
    rows = file_axes(names)
    assert names_of(rows) == names and np.linalg.det(rows) == pytest.approx(1)
    assert rows[0] @ (1, 2, 3) == pytest.approx({"x": 1, "y": 2, "-y": -2}[names[0]])


@pytest.mark.parametrize("names", [("y", "x", "z"), ("x", "x", "z"), ("x", "y")])
def test_axes_that_are_no_right_handed_system(names):
    with pytest.raises(ConfigError, match="mesh_axes: expected three axes .* right-handed"):
        file_axes(names)
