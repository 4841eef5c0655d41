"""Bodies of decks: mass, frequencies and materials in SI units from every system of units, and what is refused."""

import os

import meshio
import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.elasticity import assemble, isotropic
from tests.decks.meshes.small_decks import DENSITY, IRON, abaqus, ansys, cube, nastran, ring
from tests.decks.meshes.test_abaqus_materials import LINING
from tests.physics.fem.test_mesh_file import written

pytestmark = pytest.mark.exact
#: system of units -> (millimetres of a metre, Young's modulus and density of the same iron)
SYSTEMS = {"SI": (1.0, 110e9, 7100.0), "mm-t-s": (1e3, 110e3, 7.1e-9), "mm-kg-ms": (1e3, 110.0, 7.1e-6)}


def iron(young, density):
    return f"*SOLID SECTION, ELSET=ALL, MATERIAL=IRON\n*MATERIAL, NAME=IRON\n*ELASTIC\n{young}, 0.26\n" \
           f"*DENSITY\n{density}\n"


def body(path, text, units="mm-t-s"):
    path.write_text(text)
    return read_body(path, units)


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "wedge15", "mixed"])
@pytest.mark.parametrize("units", SYSTEMS)
def test_a_ring_has_its_mass_and_material(tmp_path, kind, units):
    mesh, (scale, *values) = ring(kind), SYSTEMS[units]
    read = body(tmp_path / "a.inp", abaqus(mesh, scale, iron(*values)), units)
    assert np.allclose(read.mesh.node, mesh.node) and read.mesh.kind == mesh.kind
    material, = read.materials
    assert (read.element_material == 0).all() and material.density == pytest.approx(7100)
    assert np.allclose(material.elasticity(), isotropic(110e9, 0.26))
    mass = assemble(read.mesh.node, read.mesh.element, read.mesh.kind, read.element_material, [material.density],
                    [material.elasticity()])[1].sum() / 3
    assert mass == pytest.approx(7100 * np.pi * 0.0125 * 0.02, rel=1e-3)


@pytest.mark.parametrize("given, declared, remedy", [
    ("mm-t-s", "mm-kg-ms", "declare mesh_units: mm-t-s"), ("mm-kg-ms", "mm-t-s", "declare mesh_units: mm-kg-ms")])
def test_density_tells_systems_of_one_length_apart(tmp_path, given, declared, remedy):
    scale, *values = SYSTEMS[given]
    with pytest.raises(ConfigError, match=f"material IRON: expected a density of 100 to 25000.*{remedy}"):
        body(tmp_path / "a.inp", abaqus(cube(), scale, iron(*values)), declared)


def test_constants_that_no_part_has(tmp_path):
    with pytest.raises(ConfigError, match="expected a Young's modulus of 100000 to 2e.12 Pa, found 1.1e.17 Pa"):
        body(tmp_path / "a.inp", abaqus(cube(), 1e3, iron(1.1e11, DENSITY)))
    with pytest.raises(ConfigError, match="expected a shear modulus of 100000 to 2e.12 Pa, found"):
        body(tmp_path / "a.inp", abaqus(cube(), 1e3, iron(1.1e5, DENSITY).replace("0.26", "-3.")))
    with pytest.raises(ConfigError, match="2e.12 Pa, found 0 Pa"):
        body(tmp_path / "a.inp", abaqus(cube(), 1e3, iron(1.1e5, DENSITY).replace("0.26", "-1.")))
    with pytest.raises(ConfigError, match="material IRON: expected a positive strain energy"):
        body(tmp_path / "a.inp", abaqus(cube(), 1e3, iron(1.1e5, DENSITY).replace("0.26", "0.6")))


def test_sections_choose_the_material_of_each_element(tmp_path):
    more = IRON + "*MATERIAL, NAME=B\n*ELASTIC\n2e5, 0.3\n*ELSET, ELSET=LEFT\n1, 2, 3\n" \
                  "*SOLID SECTION, ELSET=LEFT, MATERIAL=B\n*MATERIAL, NAME=UNUSED\n"
    read = body(tmp_path / "a.inp", abaqus(cube(), more=more))
    assert [m.name for m in read.materials] == ["IRON", "B"] and read.materials[1].density is None
    assert list(read.element_material) == [1, 1, 1, 0, 0, 0, 0, 0]
    partly = more.replace("ELSET=ALL, MATERIAL=Iron", "ELSET=LEFT, MATERIAL=Iron")
    read = body(tmp_path / "b.inp", abaqus(cube(), more=partly))
    assert [m.name for m in read.materials] == ["B"] and list(read.element_material) == [0] * 3 + [-1] * 5


def test_linear_elements_and_others_are_refused_with_their_remedy(tmp_path):
    nodes = "*NODE\n1, 0, 0, 0\n2, 99, 0, 0\n3, 0, 99, 0\n4, 0, 0, 99\n5, 50, 50, 99\n"
    for kind, message in (("C3D4", "tetra; linear elements lock.*write quadratic elements"), ("C3D5", "found pyramid")):
        text = f"{nodes}*ELEMENT, TYPE={kind}\n1, " + ", ".join("12345"[:int(kind[3:])]) + "\n"
        with pytest.raises(ConfigError, match=message):
            body(tmp_path / "a.inp", text)
    with pytest.raises(ConfigError, match="no solid cells"):
        body(tmp_path / "a.inp", nodes)


def test_nodes_in_the_order_of_another_program_are_refused(tmp_path):
    """Mid-side nodes of the upper face and of the vertical edges are interchanged, as in a deck of Nastran."""
    mesh = cube()
    swapped = type(mesh)(mesh.node, mesh.element[:, [*range(12), *range(16, 20), *range(12, 16)]], mesh.kind, mesh.cell)
    with pytest.raises(ConfigError, match="expected mid-side nodes near the middles.*node 1[37] of element 1 .*order"):
        body(tmp_path / "a.inp", abaqus(swapped))


def test_axes_of_a_file_turned_to_those_of_the_program(tmp_path):
    """A file whose disc turns about x, with a material, springs and their axes."""
    mesh = ring()
    about_x = type(mesh)(mesh.node[:, [2, 0, 1]], mesh.element, mesh.kind, mesh.cell)
    more = LINING + "*ORIENTATION, NAME=AXES\n0, 1, 0, 0, 0, 1\n*ELEMENT, TYPE=SPRING2, ELSET=S\n900, 1, 2\n" \
                    "*SPRING, ELSET=S\n1, 1\n5.\n"
    (tmp_path / "a.inp").write_text(abaqus(about_x, more=more))
    made = read_body(tmp_path / "a.inp", "mm-t-s", axes=("y", "z", "x"))
    assert np.allclose(made.mesh.node, mesh.node) and made.springs[0].freedoms == (2, 2)
    assert np.allclose(made.materials[0].axes, np.eye(3)), "E_1 along y of the file, which is x"
    other = read_body(tmp_path / "a.inp", "mm-t-s", axes=("y", "-z", "-x"))
    assert np.allclose(other.mesh.node, mesh.node * (1, -1, -1))
    assert np.allclose(other.materials[0].axes, np.diag([1, -1, -1]))
    (tmp_path / "b.inp").write_text(abaqus(about_x, more=more.replace("\n1, 1\n5.", "\n1, 2\n5.")))
    with pytest.raises(ConfigError, match="spring s_900: expected .* whose axes mesh_axes turns alike"):
        read_body(tmp_path / "b.inp", "mm-t-s", axes=("y", "-z", "-x"))


def test_a_file_that_changed_is_read_again(tmp_path):
    path = tmp_path / "a.inp"
    assert len(body(path, abaqus(cube())).mesh.element) == 8
    assert len(body(path, abaqus(ring())).mesh.element) == 16
    assert read_body(path, "mm-t-s") is read_body(path, "mm-t-s")
    os.utime(path, (1, 1))
    assert len(read_body(path, "mm-t-s").mesh.element) == 16


def test_meshio_reads_all_others(tmp_path):
    read = read_body(written(tmp_path / "ring.vtu", ring(), 1e3), "mm-t-s")
    assert read.materials == () and (read.element_material == -1).all() and len(read.mesh.element) == 16


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10"])
def test_a_deck_that_meshio_writes(tmp_path, kind):
    mesh = ring(kind)
    meshio.Mesh(1e3 * mesh.node, [(kind, mesh.element)]).write(tmp_path / "a.inp")
    read = read_body(tmp_path / "a.inp", "mm-t-s")
    assert np.allclose(read.mesh.node, mesh.node) and np.array_equal(read.mesh.element, mesh.element)


@pytest.mark.parametrize("write, kind", [(abaqus, "*NODE"), (nastran, "GRID"), (ansys, "NBLOCK")])
def test_a_dat_file_is_told_by_its_content(tmp_path, write, kind):
    text = write(cube())
    assert kind in text and len(body(tmp_path / "a.dat", text).mesh.element) == 8
