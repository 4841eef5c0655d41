"""Decks of Nastran: every element in every form of fields, materials, what is not read, one sentence for each fault."""

import meshio
import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.decks.meshes.nastran import read
from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.reference_cells import by_kind
from tests.decks.meshes.small_decks import DENSITY, NASTRAN_IRON, POISSON, YOUNG, cube, nastran, ring

pytestmark = pytest.mark.exact


def deck(path, text):
    path.write_text(text)
    return read(path)


@pytest.mark.parametrize("form", ["fixed", "marked", "large", "free", "open"])
@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "wedge15", "mixed"])
def test_every_element_in_every_form(tmp_path, kind, form):
    mesh = ring(kind)
    result = deck(tmp_path / "a.bdf", nastran(mesh, form))
    assert np.abs(result.node - 1e3 * mesh.node).max() < 6e-4
    for (name, numbers, rows), (given, elements, nodes) in zip(
            result.blocks, by_kind(mesh.kind, mesh.element), strict=True):
        assert name == given and np.array_equal(numbers, elements + 1) and np.array_equal(rows, nodes)
    assert result.notes == ("not read: executive and case control: SOL, CEND, SPC",)
    assert np.array_equal(result.element_sets["PROPERTY 1"], np.arange(1, len(mesh.element) + 1))


def test_the_order_of_nodes_is_that_of_a_known_element(tmp_path):
    """CPENTA: G10 to G12 stand on the edges between both faces, as in the manual's figure; a body of that is sound."""
    corner = np.array([(0, 0, 0), (20, 0, 0), (0, 20, 0), (0, 0, 20), (20, 0, 20), (0, 20, 20)], float)
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)]
    node = np.vstack([corner, *(corner[list(edge)].mean(axis=0)[None] for edge in edges)])
    text = "".join(f"GRID,{k},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(node, 1))
    (tmp_path / "a.bdf").write_text(f"{text}CPENTA,1,1,1,2,3,4,5,6\n,7,8,9,10,11,12,13,14\n,15\n")
    mesh = read_body(tmp_path / "a.bdf", "mm-t-s").mesh
    assert mesh.kind == "wedge15" and np.allclose(mesh.node[mesh.element[0, 12:]] * 1e3, [(0, 0, 10), (20, 0, 10),
                                                                                      (0, 20, 10)])


def test_materials(tmp_path):
    (tmp_path / "a.bdf").write_text(nastran(cube(), more=NASTRAN_IRON))
    body = read_body(tmp_path / "a.bdf", "mm-t-s")
    material, = body.materials
    assert material.name == "MAT1 7" and material.density == pytest.approx(1e12 * DENSITY)
    assert np.allclose(material.elasticity(), isotropic(1e6 * YOUNG, POISSON)) and (body.element_material == 0).all()


def test_two_of_three_constants_and_wtmass(tmp_path):
    shear = YOUNG / (2 * (1 + POISSON))
    cards = f"MAT1,1,{YOUNG},{shear},,.5\nMAT1,2,,{shear},{POISSON}\nMAT1,3,1.+5,1.+5,.3,,,,.02\nMAT1,4,1.+5\n" \
            "PARAM,WTMASS,2.\nPARAM,GRDPNT,0\nCBAR,99,1,2\n"
    result = deck(tmp_path / "a.bdf", nastran(cube(), more=cards))
    first, second, _, last = result.materials.values()
    assert first.poisson[0] == pytest.approx(POISSON) and second.young[0] == pytest.approx(YOUNG)
    assert first.density == 1 and second.density is None and last.young is None
    assert result.notes == (
        "not read: PARAM GRDPNT, CBAR, executive and case control: SOL, CEND, SPC",
        "MAT1 3: G 100000 is not E / (2 (1 + nu)); E and nu are taken",
        "MAT1 3: GE 0.02 (structural damping) is not taken; state a loss factor",
        "PARAM WTMASS 2: densities are multiplied by it")


def test_properties_without_what_they_name(tmp_path):
    other = deck(tmp_path / "a.bdf", nastran(cube(), more="PLSOLID,1,5\nMATHP,5,1.\n"))
    (_, name, axes), = other.sections
    assert name == "MATHP 5" and axes is None and other.materials[name].unread.found == "MATHP 5, hyperelastic"
    lacking = deck(tmp_path / "a.bdf", nastran(cube(), more="PSOLID,2,7\nMAT1,7,1.+5,,.3\n"))
    assert not lacking.sections and "8 elements of PID 1, which no PSOLID gives" in lacking.notes


@pytest.mark.parametrize("more, message", [
    ("GRID,1,,0.,0.,0.\n", "one node of each number, found node 1 twice"),
    ("GRID,900,3,0.,0.,0.\n", r"a.bdf:\d+: expected grid points in the basic .* found CP 3 of GRID 900; write"),
    ("GRDSET,,3\n", "found CP 3 of GRDSET"),
    ("GRID,900,,0.,y,0.\n", "expected a number, found 'y'"),
    ("GRID,x,,0.,0.,0.\n", "a whole number, found 'x'"),
    ("CTETRA,90,1,1,2,3,9999\n", "node 9999 of element 90, which no line defines"),
    ("CHEXA,90,1,1,2,3,4,5,6\n,7,8,9,10,11,12\n", "8 or 20 nodes of CHEXA 90, found 12 nodes; write mid-side"),
    ("CTETRA,90,1,1,2,3,4,5,6\n,7,8,9,10,11\n", "4 or 10 nodes of CTETRA 90, found 11 nodes"),
    ("CTETRA,90,1,1,2,,4,5,6\n,7,8,9,10,11\n", "found 10 nodes"),
    ("PSOLID,1,5\n", "a material that the deck defines, found 5"),
    ("PSOLID,1,7\nPSOLID,1,7\n", "each PSOLID once"), ("MAT1,7,1.\nMAT1,7,1.\n", "each material once"),
])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.bdf", nastran(cube(), more=more))


def test_linear_elements_are_refused_with_the_reason(tmp_path):
    text = "".join(f"GRID,{k},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(99 * np.eye(4, 3, -1), 1))
    (tmp_path / "a.bdf").write_text(f"{text}CTETRA,1,1,1,2,3,4\n")
    with pytest.raises(ConfigError, match="tetra; linear elements lock in shear"):
        read_body(tmp_path / "a.bdf", "mm-t-s")


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10"])
def test_a_deck_that_meshio_writes(tmp_path, kind):
    mesh = ring(kind)
    meshio.Mesh((1e3 * mesh.node).round(3), [(kind, mesh.element)]).write(tmp_path / "a.bdf")
    read = read_body(tmp_path / "a.bdf", "mm-t-s")
    assert np.allclose(read.mesh.node, mesh.node, atol=1e-6) and np.array_equal(read.mesh.element, mesh.element)
