"""Materials of Abaqus decks: isotropic and direction-dependent, along turned axes, at several temperatures."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.abaqus import read
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.elasticity import orthotropic
from tests.decks.meshes.small_decks import DENSITY, IRON, POISSON, YOUNG, abaqus, cube, ring

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
    ("*ORIENTATION, NAME=AXES, SYSTEM=SPHERICAL\n0, 0, 0, 0, 0, 1\n",
     "axes of the material LINING that are read, found AXES, whose system is SPHERICAL"),
    ("*ORIENTATION, NAME=AXES, DEFINITION=NODES\n1, 2, 3\n", "whose system is RECTANGULAR by NODES"),
    ("*ORIENTATION, NAME=AXES\nOri-1-DiscOrient\n3, 0.\n", "a distribution .Ori-1-DiscOrient"),
    ("*ORIENTATION, NAME=AXES\n1, 0, 0, 0, 1, 0\n4, 30.\n", "axis 1, 2 or 3 that a further turn is about, found 4"),
    ("*ORIENTATION, NAME=AXES, SYSTEM=CYLINDRICAL\n0, 0, 0, 0, 0, 0\n", "points that span a plane"),
    ("*ORIENTATION, NAME=AXES\n1, 0, 0, 2, 0, 0\n", "points that span a plane"),
    ("*ORIENTATION, NAME=AXES\n1, 0\n", "two points, or three"),
    ("", "an orientation that the deck defines, found 'AXES'"),
])
def test_axes_that_are_refused(tmp_path, axes, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.inp", LINING + axes)


#: the same lining by its elastic matrix, 11 22 33 12 13 23 as Abaqus has them
MATRIX = orthotropic((6000.0, 5000.0, 1500.0), (0.3, 0.2, 0.1), (1100.0, 1200.0, 2500.0))[
    np.ix_((0, 1, 2, 5, 4, 3), (0, 1, 2, 5, 4, 3))]


def lines(values, temperature=None):
    values = [f"{v:.10g}" for v in values] + [temperature] * (temperature is not None)
    return "".join(", ".join(values[k:k + 8]) + "\n" for k in range(0, len(values), 8))


@pytest.mark.parametrize("text", [
    "*ELASTIC, TYPE=ORTHOTROPIC\n" + lines([*(MATRIX[i, j] for j in range(3) for i in range(j + 1)),
                                            *np.diag(MATRIX)[3:]]),
    "*elastic,type=ortho\n" + lines([*(MATRIX[i, j] for j in range(3) for i in range(j + 1)), *np.diag(MATRIX)[3:]],
                                    "294."),
    "*ELASTIC, TYPE = ANISOTROPIC\n" + lines([MATRIX[i, j] for j in range(6) for i in range(j + 1)], "20."),
])
def test_elastic_matrices_are_those_of_engineering_constants(tmp_path, text):
    result = deck(tmp_path / "a.inp", f"*MATERIAL, NAME=LINING\n{text}*SOLID SECTION, ELSET=ALL, MATERIAL=lining\n")
    expected = deck(tmp_path / "b.inp", LINING.replace(", ORIENTATION=axes", "")).materials["LINING"]
    made = result.materials["LINING"]
    assert made.elasticity() == pytest.approx(expected.elasticity(), rel=1e-8, abs=1e-5)
    assert made.young == pytest.approx(expected.young) and made.poisson == pytest.approx(expected.poisson)
    assert made.matrix is None and result.notes == ()


def test_a_matrix_that_couples_shear_is_kept(tmp_path):
    """D1112, the seventh: stress 11 by shear 12."""
    values = np.array([MATRIX[i, j] for j in range(6) for i in range(j + 1)])
    values[6] = 300.0
    made = deck(tmp_path / "a.inp", "*MATERIAL, NAME=B\n*ELASTIC, TYPE=ANISOTROPIC\n" + lines(values)).materials["B"]
    assert made.elasticity()[0, 5] == 300.0 and not made.isotropic
    assert made.scaled(1e6, 1e12).elasticity()[5, 0] == pytest.approx(3e8)


@pytest.mark.parametrize("axes", [
    "*ORIENTATION, NAME=AXES, SYSTEM=CYLINDRICAL\n0, 0, 0, 0, 0, 1\n",
    "*ORIENTATION, NAME=AXES, SYSTEM = C\n0, 0, -9, 0, 0, 30\n3, 0.\n"])
def test_cylindrical_axes_in_each_element(tmp_path, axes):
    """A ring of 16 elements: in each, E_1 acts along the radius of its middle."""
    (tmp_path / "a.inp").write_text(abaqus(ring(), more=LINING + axes))
    made = read_body(tmp_path / "a.inp", "mm-t-s")
    middle = made.mesh.node[made.mesh.element].mean(axis=1)
    for row, place in zip(made.element_material, middle, strict=True):
        across = place * (1, 1, 0) / np.hypot(*place[:2])
        assert made.materials[row].axes == pytest.approx(
            np.array([across, np.cross((0, 0, 1), across), (0, 0, 1)]), abs=1e-6)
    assert "LINING: along the cylindrical axes AXES, in each element those at its middle" in made.notes


def test_further_turns_and_axes_by_z(tmp_path):
    turned = deck(tmp_path / "a.inp", LINING + "*ORIENTATION, NAME=AXES\n1, 0, 0, 0, 1, 0\n3, 90.\n")
    assert np.allclose(turned.sections[0][2], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    by_z = deck(tmp_path / "b.inp", LINING + "*ORIENTATION, NAME=AXES, SYSTEM=Z RECTANGULAR\n1, 0, 0, 0, 1, 0\n")
    assert np.allclose(by_z.sections[0][2], [[0, 1, 0], [0, 0, 1], [1, 0, 0]])


def test_temperatures_are_said_and_other_laws_kept_unread(tmp_path):
    more = IRON + "*MATERIAL, NAME=B\n*ELASTIC\n100., 0.3, 20.\n90., 0.3, 200.\n*MATERIAL, NAME=C\n" \
                  "*ELASTIC, TYPE=LAMINA\n6000., 6000., 0.2, 2500., 1200., 1200.\n*MATERIAL, NAME=D\n" \
                  "*HYPERELASTIC, NEO HOOKE\n1., 2.\n*MATERIAL, NAME=E\n*DENSITY\n1.\n"
    result = deck(tmp_path / "a.inp", more)
    assert result.notes == ("not read: *ELASTIC of type LAMINA (material C), *HYPERELASTIC",
                            "*ELASTIC of B depends on temperature: its first line, that of temperature 20., is taken")
    unread = {name: material.unread and material.unread.found for name, material in result.materials.items()}
    assert unread == {"IRON": None, "B": None, "D": "*HYPERELASTIC", "E": None,
                      "C": "*ELASTIC, TYPE=LAMINA, which holds in a plane only"}


@pytest.mark.parametrize("more, message", [
    ("*ELASTIC\n1., 0.3\n", r"\*MATERIAL before \*ELASTIC"),
    ("*MATERIAL, NAME=A\n*ELASTIC\n1.\n", r"2 numbers of \*ELASTIC, found 1"),
    ("*MATERIAL, NAME=A\n*ELASTIC, TYPE=ORTHO\n1., 2., 3.\n4., 5., 6.\n",
     r":\d+: expected 9 numbers of \*ELASTIC, found 3; write 8 numbers in each line before the last"),
    ("*MATERIAL, NAME=A\n*ELASTIC, TYPE=ORTHO\n1., 2., 1., 2., 2., 1., 1., 1.,\n1.\n",
     r":\d+, material A: expected elastic constants of a positive strain energy"),
    ("*MATERIAL, NAME=A\n*DENSITY\nheavy\n", "a number, found 'heavy'"),
    ("*MATERIAL, NAME=A\n*MATERIAL, NAME=a\n", "each material once, found A again"),
])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.inp", more)
