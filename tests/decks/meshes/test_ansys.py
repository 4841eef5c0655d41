"""Archives of Ansys: every element with its collapsed forms, components, one sentence for each fault."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.ansys import read
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.reference_cells import by_kind
from tests.decks.meshes.small_decks import ansys, cube, ring

pytestmark = pytest.mark.exact


def deck(path, text):
    path.write_text(text)
    return read(path)


@pytest.mark.parametrize("kind, tetra", [("hexahedron20", 187), ("tetra10", 187), ("tetra10", 186), ("wedge15", 187),
                                         ("mixed", 187)])
def test_every_element_has_its_nodes(tmp_path, kind, tetra):
    mesh = ring(kind)
    result = deck(tmp_path / "a.cdb", ansys(mesh, tetra))
    assert np.allclose(result.node, 1e3 * mesh.node, atol=1e-9) and result.notes == ()
    for (name, numbers, rows), (given, elements, nodes) in zip(
            result.blocks, by_kind(mesh.kind, mesh.element), strict=True):
        assert name == given and np.array_equal(numbers, elements + 1) and np.array_equal(rows, nodes)
    assert list(result.node_sets["RIM"]) == [1, 4, 5, 6, 7]
    assert np.array_equal(result.element_sets["BODY"], np.arange(1, len(mesh.element) + 1))
    assert np.allclose(read_body(tmp_path / "a.cdb", "mm-t-s").mesh.node, mesh.node)


def test_nodes_of_a_short_format(tmp_path):
    """As Workbench writes them: one whole number, and no word SOLID."""
    text = "NBLOCK,3\n(1i9,3e20.9e3)\n        1" + "".join(f"    {k}.000000000E+000" for k in (1, 2, 3)) + "\n-1\n"
    assert deck(tmp_path / "a.cdb", text).node.tolist() == [[1, 2, 3]]


def test_what_is_not_read_is_said(tmp_path):
    more = "EBLOCK,10,,,2\n(15i9)\n        1        1\n       -1\nTB,PLAS,1\nTBDATA,1,2.\nD,ALL,ALL\nD,1,UX\n"
    result = deck(tmp_path / "a.cdb", ansys(cube(), more=more))
    assert result.notes == ("not read: EBLOCK of surface or line elements, TB, TBDATA, D (2 times)",
                            "8 elements of material 1, of which the file gives no value")


def swapped(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


@pytest.mark.parametrize("change, message", [
    (lambda t: swapped(t, "187\n", "154\n"), "elements of type 154"),
    (lambda t: swapped(t, "        2      187\n", ""), "elements of no type"),
])
def test_elements_of_other_types_are_said(tmp_path, change, message):
    result = deck(tmp_path / "a.cdb", change(ansys(cube("tetra10"))))
    assert not result.blocks and message in result.notes[0]


@pytest.mark.parametrize("change, message", [
    (lambda t: swapped(t, ",       81\n(3i9", ",       82\n(3i9"), "82 nodes, as NBLOCK says, found 81"),
    (lambda t: swapped(t, ",        8\n(19i9)", ",        9\n(19i9)"), "9 elements, as EBLOCK says, found 8"),
    (lambda t: swapped(t, "ET,        1,186", "ET,        1,187"), "10 nodes of SOLID187 1, found 20"),
    (lambda t: swapped(t, "       20        0        1", "       20        0        2"), "element 2 twice"),
    (lambda t: swapped(t, "        2        0        0 ", "        1        0        0 "), "node 1 twice"),
    (lambda t: swapped(t, "RIM     ,NODE,       3", "RIM,NODE,4"), "4 numbers, as CMBLOCK says, found 3"),
    (lambda t: swapped(t, "         1         4        -7", "        -1         4        -7"),
     "the first number of a range"),
    (lambda t: t + "NGEN,2,100,1,10\n", "written out in blocks, found NGEN; write it with CDWRITE"),
    (lambda t: t + "N,5,1.,2.\n", "written out in blocks, found N"),
    (lambda t: t + "/INPUT,mesh,inp\n", "written out in blocks, found /INPUT"),
    (lambda t: t + "EBLOCK,19,SOLID\n(19i9)\n        1        1\n", "11 numbers and the nodes of an element, found 2"),
    (lambda t: t + "EBLOCK,19,SOLID\n(19i9)\n" + "        1" * 8 + "       20        0       99        1\n",
     "20 nodes of element 99, found 1"),
])
def test_faults_have_one_sentence(tmp_path, change, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.cdb", change(ansys(cube())))


def test_pyramids_missing_middles_and_linear_elements_are_refused(tmp_path):
    mesh = cube()
    with pytest.raises(ConfigError, match="edges without .node 0.; write elements of second order"):
        deck(tmp_path / "a.cdb", ansys(type(mesh)(mesh.node, np.where(np.arange(20) == 9, -1, mesh.element), mesh.kind,
                                                  mesh.cell)))
    pyramid = mesh.element.copy()
    pyramid[:, 4:8] = pyramid[:, 4:5]
    with pytest.raises(ConfigError, match="found element 1 with 5 corners .a pyramid.; mesh without pyramids"):
        deck(tmp_path / "a.cdb", ansys(type(mesh)(mesh.node, pyramid, mesh.kind, mesh.cell)))
    (tmp_path / "a.cdb").write_text(ansys(mesh).replace("1,186", "1,185"))
    with pytest.raises(ConfigError, match="hexahedron; linear elements lock in shear"):
        read_body(tmp_path / "a.cdb", "mm-t-s")
