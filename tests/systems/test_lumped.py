"""Names, rows and matrices of lumped systems."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.systems.lumped import (
    Contact,
    Gyro,
    Mass,
    coordinates,
    gyroscopic_matrix,
    index_of,
    mass_matrix,
    normal_law,
)

MASSES = {"wall": Mass(("x",), grounded=True), "block": Mass(("x", "y"), mass=2.0),
          "disc": Mass(("tilt_x", "tilt_y"), inertia=0.3)}


def contact(**values):
    return Contact({"block.x": 1.0}, {"block.y": 1.0}, {}, **values)


def test_coordinates_are_named_by_mass_and_motion():
    found = coordinates(MASSES)
    assert found.names == ("block.x", "block.y", "disc.tilt_x", "disc.tilt_y") and found.body == (1, 1, 2, 2)
    np.testing.assert_array_equal(np.diag(mass_matrix(MASSES, found)), [2.0, 2.0, 0.3, 0.3])
    np.testing.assert_array_equal(found.row({"block.x": 1.0, "wall.x": -1.0, "ground": 3.0}, "here"), [1, 0, 0, 0])


def test_gyroscopic_moments_do_no_work():
    matrix = gyroscopic_matrix({"disc": Gyro(("disc.tilt_x", "disc.tilt_y"), 0.5)}, coordinates(MASSES))
    np.testing.assert_array_equal(matrix, -matrix.T)
    assert matrix[2, 3] == 0.5 and abs(matrix).sum() == 1.0


@pytest.mark.parametrize(("masses", "said"), [
    ({"a": Mass(("x",))}, "masses.a.mass: expected above 0 kg, because it moves along x, found 0 kg"),
    ({"a": Mass(("x",), mass=-1.0)}, "found -1 kg; give it a mass, or set grounded: true"),
    ({"a": Mass(("rotation",), mass=1.0)}, "masses.a.inertia: expected above 0 kg m^2"),
    ({"a": Mass(("tilt",), inertia=1.0)}, "did you mean 'tilt_"), ({"a": Mass(("x",), grounded=True)}, "can move")])
def test_masses_that_cannot_move_as_they_should_are_refused(masses, said):
    with pytest.raises(ConfigError) as error:
        coordinates(masses)
    assert said in str(error.value)


def test_names_and_connections_are_checked():
    found = coordinates(MASSES)
    with pytest.raises(ConfigError, match=r"here: expected a coordinate, one of block.x, .* did you mean 'block.x'\?"):
        found.row({"blok.x": 1.0}, "here")
    for still in ({"ground": 1.0}, {"wall.x": 1.0}, {}):
        with pytest.raises(ConfigError, match="two different ends, at least one of them free to move"):
            found.connected(still, "here")
    with pytest.raises(ConfigError, match="did you mean 'shaker'"):
        index_of("shakr", ["shaker", "tie"], "here")


@pytest.mark.exact
def test_one_law_gives_each_contact_its_stiffness():
    """Without areas the law has 1 Pa/m; stated areas set it."""
    stiff = {"one": contact(stiffness=3e5), "joint": Contact({}, {}, {}, normal_force=1.0),
             "two": contact(stiffness=1e5)}
    for contacts, slope in ((stiff, 1.0), ({"one": contact(stiffness=3e5, area=1e-4)}, 3e9)):
        closure, pressure, area = normal_law(contacts)
        assert np.diff(pressure) / np.diff(closure) == pytest.approx(slope)
        for own, place in zip(contacts.values(), area, strict=True):
            assert own.stiffness is None or place * slope == pytest.approx(own.stiffness)
    assert normal_law({"hard": contact(area=2.0)})[0].size == 0


@pytest.mark.parametrize(("contacts", "said"), [
    ({"a": contact(stiffness=1e5), "b": contact()}, "contacts.b.stiffness"),
    ({"a": contact(stiffness=1e5, area=1.0), "b": contact(stiffness=1e5, area=2.0)}, "contacts.b.area")])
def test_contacts_that_ask_for_two_laws_are_refused(contacts, said):
    with pytest.raises(ConfigError, match=said):
        normal_law(contacts)
