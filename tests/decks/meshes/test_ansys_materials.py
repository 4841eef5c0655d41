"""Materials of Ansys archives: MP and MPDATA, major and minor Poisson's ratios, element coordinate systems."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.ansys import read
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.elasticity import isotropic, orthotropic
from tests.decks.meshes.small_decks import DENSITY, POISSON, YOUNG, ansys, cube, ring

pytestmark = pytest.mark.exact
LINING = """MP,EX,1,6000
MP,EY,1,5000
MP,EZ,1,1500
MP,GXY,1,2500
MP,GYZ,1,1100
MP,GXZ,1,1200
MP,DENS,1,2.6e-9
"""


def body(path, more, system=0):
    path.write_text(ansys(cube(), more=more, system=system))
    return read_body(path, "mm-t-s")


def test_isotropic_with_density(tmp_path):
    (tmp_path / "a.cdb").write_text(ansys(cube()))
    material, = read_body(tmp_path / "a.cdb", "mm-t-s").materials
    assert material.name == "MATERIAL 1" and material.density == pytest.approx(1e12 * DENSITY)
    assert np.allclose(material.elasticity(), isotropic(1e6 * YOUNG, POISSON))


def test_major_and_minor_ratios_describe_the_same_material(tmp_path):
    """PRXY / EX = NUXY / EY."""
    major = "MP,PRXY,1,0.24\nMP,PRYZ,1,0.2\nMP,PRXZ,1,0.16\n"
    minor = f"MP,NUXY,1,0.2\nMP,NUYZ,1,{0.2 * 1500 / 5000}\nMP,NUXZ,1,{0.16 * 1500 / 6000}\n"
    expected = orthotropic((6e9, 5e9, 1.5e9), (0.2, 0.16, 0.24), (1.1e9, 1.2e9, 2.5e9))
    for more in (major, minor):
        assert np.allclose(body(tmp_path / "a.cdb", LINING + more).materials[0].elasticity(), expected)


RATIOS = "MP,PRXY,1,0.24\nMP,PRYZ,1,0.2\nMP,PRXZ,1,0.16\n"
MATRIX = orthotropic((6000.0, 5000.0, 1500.0), (0.2, 0.16, 0.24), (1100.0, 1200.0, 2500.0))


def table(matrix, head, split=6, name="TBDATA"):
    """21 constants of x, y, z, xy, yz, xz, column by column of the lower triangle."""
    order = (0, 1, 2, 5, 3, 4)
    values = [f"{matrix[order[i], order[j]]:.10g}" for j in range(6) for i in range(j, 6)]
    rows = [f"{name},{k + 1},{','.join(values[k:k + split])}\n" for k in range(0, len(values), split)]
    return head + "".join(rows) + "MP,DENS,1,2.6e-9\n"


@pytest.mark.parametrize("more", [
    table(MATRIX, "TB,ANEL,1,1,21,0\nTBTEMP,20.\n"), table(np.linalg.inv(MATRIX), "tb,anel,1,,,1\n", 3),
    table(MATRIX, "TB,ELASTIC,1,,,AELS\n", name="TBDAT"), table(np.linalg.inv(MATRIX), "TB,ELAS,1,1,21,AELF\n")])
def test_matrices_of_tables_are_those_of_nine_constants(tmp_path, more):
    made, = body(tmp_path / "a.cdb", more).materials
    expected, = body(tmp_path / "b.cdb", LINING + RATIOS).materials
    assert made.elasticity() == pytest.approx(expected.elasticity(), rel=1e-7, abs=1e3) and made.matrix is None
    assert made.density == pytest.approx(2600)


def test_a_later_temperature_does_not_take_the_place_of_the_first(tmp_path):
    more = "MPDATA,R5.0, 1,EX,1, 1, 110000., 100000.\nMPDATA,R5.0, 1,EX,1, 7, 60000.\nMP,PRXY,1,0.26\n" \
           "MP,DENS,1,7.1e-9\n"
    made = body(tmp_path / "a.cdb", more)
    assert made.materials[0].young[0] == pytest.approx(110e9)
    assert made.notes == ("EX of material 1 depends on temperature: its first value is taken",)
    law = table(MATRIX, "TB,ANEL,1,2,21\nTBTEMP,20.\n") + table(2 * MATRIX, "TBTEMP,200.\n")
    made = body(tmp_path / "b.cdb", law)
    assert made.materials[0].young[0] == pytest.approx(6e9)
    assert made.notes == ("TB ANEL of material 1 depends on temperature: that of the first one is taken",)


@pytest.mark.parametrize("more, axes", [
    ("LOCAL,R5.3,LOC,      11,  0,  0.,  0.,  0.\nLOCAL,R5.3,ANG,      11,  0,  90.,  0.,  0.\n",
     [(0, 1, 0), (-1, 0, 0), (0, 0, 1)]),
    ("LOCAL,11,0,0.,0.,0.,0.,90.\n", [(1, 0, 0), (0, 0, 1), (0, -1, 0)])])
def test_axes_of_a_local_cartesian_system(tmp_path, more, axes):
    made, = body(tmp_path / "a.cdb", more + LINING + RATIOS, system=11).materials
    assert made.axes == pytest.approx(np.array(axes), abs=1e-12)


@pytest.mark.parametrize("more, system", [
    ("", 1), ("LOCAL,R5.0,LOC, 12, 1, 0., 0., 7.\nLOCAL,R5.0,PRM, 12, 1, 1., 1.\n", 12)])
def test_axes_of_a_cylindrical_system(tmp_path, more, system):
    (tmp_path / "a.cdb").write_text(ansys(ring(), more=more + LINING + RATIOS, system=system))
    made = read_body(tmp_path / "a.cdb", "mm-t-s")
    middle = made.mesh.node[made.mesh.element].mean(axis=1)
    for row, place in zip(made.element_material, middle, strict=True):
        assert made.materials[row].axes[0] == pytest.approx(place * (1, 1, 0) / np.hypot(*place[:2]), abs=1e-6)


def test_axes_of_an_element_coordinate_system_that_is_not_there(tmp_path):
    with pytest.raises(ConfigError, match="MATERIAL 1: expected constants along x, y, z .* found ESYS 11; write LOCAL"):
        body(tmp_path / "a.cdb", LINING + RATIOS, system=11)
    with pytest.raises(ConfigError, match="found ESYS 11"):
        body(tmp_path / "b.cdb", "LOCAL,R5.3,LOC, 11, 2, 0., 0., 0.\n" + LINING + RATIOS, system=11)
    assert body(tmp_path / "a.cdb", f"MP,EX,1,{YOUNG}\nMP,NUXY,1,0.3\n", system=11).materials[0].isotropic


def test_constants_that_are_no_law_are_unread(tmp_path):
    (tmp_path / "a.cdb").write_text(ansys(cube(), more=LINING + "MP,DMPR,1,0.01\nMPDATA,R5.0, 2,EX,2, 1, 100., 90.\n"
                                          "TB,HYPER,3,1,2,NEO\nTBDATA,1,1.,2.\nTB,ELASTIC,4,1,9,OELM\n"))
    deck = read(tmp_path / "a.cdb")
    assert deck.materials["MATERIAL 1"].young is None and deck.materials["MATERIAL 1"].density == 2.6e-9
    assert deck.notes == ("not read: MP DMPR of material 1",
                          "EX of material 2 depends on temperature: its first value is taken")
    assert [m.unread.found for m in deck.materials.values()] == [
        "EX, EY, EZ, GXY, GYZ, GXZ of MATERIAL 1 alone", "EX of MATERIAL 2 alone", "TB,HYPER,,,,NEO",
        "TB,ELASTIC,,,,OELM"]


@pytest.mark.parametrize("more, message", [
    ("MP,EX,1,stiff\n", "a number, found 'stiff'"), ("MP,EX,x,1.\n", "a whole number, found 'x'"),
    ("MP,EX,1\n", "a value of EX, found none"),
    ("TB,ANEL,1\nTBDATA,1,1.,0.\n", "material MATERIAL 1: expected elastic constants of a positive strain energy"),
    ("TB,ANEL,1,,,1\nTBDATA,1,1.,0.\n", "MATERIAL 1: expected a compliance of a positive strain energy")])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        body(tmp_path / "a.cdb", more)
