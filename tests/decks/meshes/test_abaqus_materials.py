"""Materials of Abaqus decks: isotropic and direction-dependent, along turned axes, at several temperatures."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.abaqus import read
from tests.decks.meshes.small_decks import DENSITY, IRON, POISSON, YOUNG, abaqus, cube

pytestmark = pytest.mark.exact
LINING = """*MATERIAL, NAME=Lining
*ELASTIC, TYPE=ENGINEERING CONSTANTS
6000., 5000., 1500., 0.1, 0.2, 0.3, 2500., 1200.,
1100., 20.
*SOLID SECTION, ELSET=ALL, MATERIAL=LINING, ORIENTATION=axes
"""


def deck(path, more):
    path.write_text(abaqus(cube(), more=more))
    return read(path)


def test_isotropic_with_density(tmp_path):
    result = deck(tmp_path / "a.inp", IRON)
    iron = result.materials["IRON"]
    assert iron.isotropic and (iron.young[0], iron.poisson[0], iron.density) == (YOUNG, POISSON, DENSITY)
    (numbers, name, axes), = result.sections
    assert name == "IRON" and axes is None and len(numbers) == 8


def test_engineering_constants_along_turned_axes(tmp_path):
    """The first axis of the material lies along y, the second along -x: E_y is E_1."""
    axes = "*ORIENTATION, NAME=AXES\n0., 1., 0., -1., 0., 0.\n"
    result = deck(tmp_path / "a.inp", LINING + axes)
    material, (_, _, rows) = result.materials["LINING"], result.sections[0]
    assert material.young == (6000, 5000, 1500) and material.poisson == (0.3, 0.2, 0.1)
    assert material.shear == (1100, 1200, 2500) and not material.isotropic
    assert np.allclose(rows, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    compliance = np.linalg.inv(replace(material, axes=rows).elasticity())
    assert 1 / np.diag(compliance) == pytest.approx([5000, 6000, 1500, 1200, 1100, 2500])


@pytest.mark.parametrize("axes, message", [
    ("*ORIENTATION, NAME=AXES, SYSTEM=CYLINDRICAL\n0, 0, 0, 0, 0, 1\n",
     "fixed Cartesian axes, found AXES, whose system"),
    ("*ORIENTATION, NAME=AXES\n1, 0, 0, 0, 1, 0\n3, 30.\n", "turned by a further angle"),
    ("*ORIENTATION, NAME=AXES\n1, 0, 0, 2, 0, 0\n", "points that span a plane"),
    ("*ORIENTATION, NAME=AXES\n1, 0\n", "two points, or three"),
    ("", "an orientation that the deck defines, found 'AXES'"),
])
def test_axes_that_are_refused(tmp_path, axes, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.inp", LINING + axes)


def test_temperatures_and_other_laws_are_said(tmp_path):
    more = IRON + "*MATERIAL, NAME=B\n*ELASTIC\n100., 0.3, 20.\n90., 0.3, 200.\n*ELASTIC, TYPE=ANISOTROPIC\n1., 2.\n"
    notes = deck(tmp_path / "a.inp", more).notes
    assert notes == ("not read: *ELASTIC of type ANISOTROPIC (material B)",
                     "*ELASTIC of B depends on temperature: its first line is taken")


@pytest.mark.parametrize("more, message", [
    ("*ELASTIC\n1., 0.3\n", r"\*MATERIAL before \*ELASTIC"),
    ("*MATERIAL, NAME=A\n*ELASTIC\n1.\n", r"2 numbers of \*ELASTIC, found 1"),
    ("*MATERIAL, NAME=A\n*DENSITY\nheavy\n", "a number, found 'heavy'"),
    ("*MATERIAL, NAME=A\n*MATERIAL, NAME=a\n", "each material once, found A again"),
])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.inp", more)
