"""Materials of Ansys archives: MP and MPDATA, major and minor Poisson's ratios, element coordinate systems."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.ansys import read
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.elasticity import isotropic, orthotropic
from tests.decks.meshes.small_decks import DENSITY, POISSON, YOUNG, ansys, cube

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


def test_axes_of_an_element_coordinate_system_are_refused(tmp_path):
    with pytest.raises(ConfigError, match="MATERIAL 1: expected constants along the axes of the file .ESYS 0., found"):
        body(tmp_path / "a.cdb", LINING + "MP,PRXY,1,0.1\nMP,PRYZ,1,0.2\nMP,PRXZ,1,0.1\n", system=11)
    assert body(tmp_path / "a.cdb", f"MP,EX,1,{YOUNG}\nMP,NUXY,1,0.3\n", system=11).materials[0].isotropic


def test_values_that_are_not_taken_are_said(tmp_path):
    (tmp_path / "a.cdb").write_text(ansys(cube(), more=LINING + "MP,DMPR,1,0.01\nMPDATA,R5.0, 2,EX,2, 1, 100., 90.\n"))
    deck = read(tmp_path / "a.cdb")
    assert deck.materials["MATERIAL 1"].young is None and deck.materials["MATERIAL 1"].density == 2.6e-9
    assert deck.notes == (
        "not read: MP DMPR of material 1", "EX of material 2 depends on temperature: its first value is taken",
        "MATERIAL 1 lacks elastic constants, which are not taken: the file gives EX, EY, EZ, GXY, GYZ, GXZ",
        "MATERIAL 2 lacks elastic constants, which are not taken: the file gives EX")


@pytest.mark.parametrize("more, message", [
    ("MP,EX,1,stiff\n", "a number, found 'stiff'"), ("MP,EX,x,1.\n", "a whole number, found 'x'"),
    ("MP,EX,1\n", "a value of EX, found none")])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        body(tmp_path / "a.cdb", more)
