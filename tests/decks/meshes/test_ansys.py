"""Archives of Ansys: every element with its collapsed forms, components, one sentence for each fault."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.ansys import read
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.reference_cells import by_kind
from tests.decks.meshes.small_decks import SOLID186, ansys, cells, cube, ring

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
    assert result.notes == ("not read: EBLOCK of surface or line elements, TB PLAS of material 1, D (2 times)",
                            "8 elements of material 1, of which the file gives no value")


def compact(mesh, number=186, width=21, head="", count=None):
    """An input of Workbench: blocks without the 11 numbers, whose elements have what the commands before them say."""
    nodes = [f"{k:9d}" + "".join(f"{x:20.9E}" for x in position) for k, position in enumerate(1e3 * mesh.node, 1)]
    rows = []
    for label, kind, each in cells(mesh):
        chosen = list(each) if number == 187 else [each[k] for k in SOLID186[kind]]
        values = [label, *chosen[:8 if number == 185 else None]]
        rows += ["".join(f"{v:9d}" for v in values[k:k + width]) for k in range(0, len(values), width)]
    return "\n".join(["/batch", "/prep7", f"et,4,{number}", head, f"nblock,3,,{len(nodes)}", "(1i9,3e20.9e3)", *nodes,
                      "-1", "type,4", "mat,3", f"eblock,{width},COMPACT,,{count or len(mesh.element)}",
                      f"({width}i9)", *rows, "-1", "MP,EX,3,110000.", "MP,NUXY,3,0.26", "MP,DENS,3,7.1e-9", "fini", ""])


@pytest.mark.parametrize("kind, number, width", [
    ("hexahedron20", 186, 21), ("hexahedron20", 186, 19), ("wedge15", 186, 21), ("tetra10", 186, 21),
    ("mixed", 186, 11), ("tetra10", 187, 11), ("tetra10", 187, 19)])
def test_compact_blocks(tmp_path, kind, number, width):
    """In one line or several, hexahedra as they are or collapsed to wedges and tetrahedra."""
    mesh = ring(kind)
    (tmp_path / "ds.dat").write_text(compact(mesh, number, width))
    made = read_body(tmp_path / "ds.dat", "mm-t-s")
    for (name, _, nodes), (given, _, expected) in zip(
            sorted(by_kind(made.mesh.kind, made.mesh.element)), sorted(by_kind(mesh.kind, mesh.element)), strict=True):
        assert name == given and np.array_equal(nodes, expected)
    assert np.allclose(made.mesh.node, mesh.node, atol=1e-9) and made.notes == ()
    assert made.materials[0].young[0] == pytest.approx(110e9) and (made.element_material == 0).all()


def test_compact_blocks_of_other_elements(tmp_path):
    with pytest.raises(ConfigError, match="hexahedron; linear elements lock in shear"):
        (tmp_path / "a.cdb").write_text(compact(cube(), 185, 9))
        read_body(tmp_path / "a.cdb", "mm-t-s")
    assert "elements of type 174 (8 times)" in deck(tmp_path / "b.cdb", compact(cube(), 174)).notes[0]
    with pytest.raises(ConfigError, match="9 elements, as EBLOCK says, found 8"):
        deck(tmp_path / "c.cdb", compact(cube(), count=9))
    cut_off = compact(cube()).splitlines()
    last = next(k for k, line in enumerate(cut_off) if line.startswith("type,4")) + 4
    with pytest.raises(ConfigError, match="20 nodes of element 8, found 2"):
        deck(tmp_path / "d.cdb", "\n".join([*cut_off[:last + 7], cut_off[last + 7][:27], "-1"]))


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
