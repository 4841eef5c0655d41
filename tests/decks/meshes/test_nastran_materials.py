"""MAT9 and MAT11 of Nastran decks along the basic system or CORD2R and CORD2C, and laws that are not read."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.decks.meshes.nastran import read
from pipeline.physics.fem.elasticity import isotropic, orthotropic
from tests.decks.meshes.small_decks import cube, nastran, ring

pytestmark = pytest.mark.exact
#: along x, y, z in MPa
E, NU, G = (6000.0, 5000.0, 1500.0), (0.3, 0.2, 0.1), (1100.0, 1200.0, 2500.0)
MAT11 = "MAT11,7,6000.,5000.,1500.,.1,.2,.3,2500.\n,1200.,1100.,2.6-9\n"


def mat9(matrix, label=7):
    """MAT9 of an elasticity in the order xx yy zz yz xz xy: Nastran's is x y z xy yz zx."""
    order = [0, 1, 2, 5, 3, 4]
    values = [f"{matrix[order[i], order[j]]:.6e}" for i in range(6) for j in range(i, 6)] + ["2.6-9"]
    fields = [str(label), *values]
    return "".join(("MAT9," if k == 0 else ",") + ",".join(fields[k:k + 8]) + "\n" for k in range(0, len(fields), 8))


def body(path, more, mesh=None):
    path.write_text(nastran(cube() if mesh is None else mesh, more=more))
    return read_body(path, "mm-t-s")


@pytest.mark.parametrize("card", [mat9(orthotropic(E, NU, G)), MAT11])
def test_nine_constants_in_either_card(tmp_path, card):
    material, = body(tmp_path / "a.bdf", f"PSOLID,1,7\n{card}").materials
    assert material.young == pytest.approx([1e6 * e for e in E], rel=1e-5) and material.density == pytest.approx(2600)
    assert np.allclose(material.elasticity(), 1e6 * orthotropic(E, NU, G), rtol=1e-5, atol=1e3)
    assert not material.isotropic and material.matrix is None


def test_an_isotropic_mat9_and_a_coupled_one(tmp_path):
    iron, = body(tmp_path / "a.bdf", "PSOLID,1,7\n" + mat9(isotropic(110e3, 0.26))).materials
    assert iron.isotropic and iron.young[0] == pytest.approx(110e9, rel=1e-5)
    coupled = isotropic(110e3, 0.26)
    coupled[0, 4] = coupled[4, 0] = 9e3
    material, = body(tmp_path / "b.bdf", "PSOLID,1,7\n" + mat9(coupled)).materials
    assert np.allclose(material.elasticity(), 1e6 * coupled, rtol=1e-5, atol=1e3) and not material.isotropic


def test_axes_of_a_cartesian_system(tmp_path):
    """Its z axis lies along y, its x axis along z: E3 acts along y, E1 along z, E2 along x."""
    made = body(tmp_path / "a.bdf", f"PSOLID,1,7,4\nCORD2R,4,0,0.,0.,0.,0.,1.,0.\n,0.,0.,1.\n{MAT11}")
    compliance = np.linalg.inv(made.materials[0].elasticity())
    assert 1 / np.diag(compliance)[:3] == pytest.approx([5e9, 1.5e9, 6e9])


def test_axes_of_a_cylindrical_system(tmp_path):
    made = body(tmp_path / "a.bdf", f"PSOLID,1,7,4\nCORD2C,4,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n{MAT11}", ring(cells=16))
    middle = made.mesh.node[made.mesh.element].mean(axis=1)
    for row, place in zip(made.element_material, middle, strict=True):
        radial = place * (1, 1, 0) / np.hypot(*place[:2])
        assert made.materials[row].axes[0] == pytest.approx(radial, abs=1e-6)
    assert len(made.materials) == 16
    assert "MAT11 7: along the cylindrical axes 4, in each element those at its middle" in made.notes


def test_mat1_of_one_constant_and_others_are_unread(tmp_path):
    (tmp_path / "a.bdf").write_text(nastran(cube(), more="MAT1,1,1.+5\nMAT8,2,1.+5,1.+5,.3,1.+4\nMATHP,3,1.\n"))
    materials = read(tmp_path / "a.bdf").materials
    assert [m.unread.found for m in materials.values()] == [
        "one constant alone of MAT1 1", "MAT8 2, of shells, which holds in a plane only", "MATHP 3, hyperelastic"]
    assert all(m.young is None for m in materials.values())


@pytest.mark.parametrize("more, message", [
    ("PSOLID,1,7,-1\n" + MAT11, "axes of MAT11 7 that are read, found CORDM -1: the axes of each element; write CORDM"),
    ("PSOLID,1,7,4\n" + MAT11, "found a system 4 that no card defines"),
    ("PSOLID,1,7,4\nCORD1R,4,1,2,3\n" + MAT11, "found CORD1R 4"),
    ("PSOLID,1,7,4\nCORD2R,4,9,0.,0.,0.,0.,1.,0.\n,0.,0.,1.\n" + MAT11, "found CORD2R 4 in the system 9"),
    ("MAT11,7,6000.\n", "of MAT11 7, found 1 of them; write all nine"),
    ("MAT9,7,1.\n", "material MAT9 7: expected elastic constants of a positive strain energy"),
    ("MAT1,7,1.+5,,.3\nMAT9,7,1.\n", "each material once, found MAT9 7 again"),
])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        body(tmp_path / "a.bdf", more)
