"""Decks of Abaqus and CalculiX: round trips of every kind, sets, includes, parts, and one sentence for each fault."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.abaqus import read
from pipeline.physics.fem.mesh import block
from pipeline.physics.fem.reference_cells import by_kind
from tests.decks.meshes.small_decks import IRON, abaqus, cube, ring

pytestmark = pytest.mark.exact


def deck(path, text):
    path.write_text(text)
    return read(path)


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "wedge15", "mixed"])
def test_every_element_has_its_nodes(tmp_path, kind):
    mesh = ring(kind)
    result = deck(tmp_path / "a.inp", abaqus(mesh))
    assert np.allclose(result.node, 1e3 * mesh.node, atol=1e-7)
    for (name, numbers, rows), (given, elements, nodes) in zip(
            result.blocks, by_kind(mesh.kind, mesh.element), strict=True):
        assert name == given and np.array_equal(numbers, elements + 1) and np.array_equal(rows, nodes)
    assert result.notes == ()
    assert np.array_equal(result.element_sets["ALL"], np.arange(1, len(mesh.element) + 1))
    assert np.array_equal(result.node_sets["NALL"], np.arange(1, len(mesh.node) + 1))


def test_twenty_seven_nodes(tmp_path):
    mesh = block(*[np.linspace(0, 0.1, 3)] * 3, kind="hexahedron27")
    (kind, _, rows), = deck(tmp_path / "a.inp", abaqus(mesh)).blocks
    assert kind == "hexahedron27" and np.array_equal(rows, mesh.element)


def test_sets_and_surfaces(tmp_path):
    more = """*NSET, NSET=Some, GENERATE
1, 9, 4
*NSET, NSET=both
some, 2
*ELSET, ELSET=odd, generate
 1, 7, 2
*SURFACE, NAME=face, TYPE=ELEMENT
odd, S1
2, S3
*SURFACE, NAME=nodes, TYPE=NODE
both,
"""
    result = deck(tmp_path / "a.inp", abaqus(cube(), more=more))
    assert list(result.node_sets["BOTH"]) == [1, 2, 5, 9] and list(result.element_sets["ODD"]) == [1, 3, 5, 7]
    (odd, first), (two, third) = result.surfaces["FACE"]
    assert (list(odd), first, list(two), third) == ([1, 3, 5, 7], "S1", [2], "S3")
    assert sorted(result.surfaces["NODES"][0][0]) == [1, 2, 5, 9]


def test_includes_lie_in_the_folder_of_the_deck(tmp_path):
    text = abaqus(cube())
    head, nodes, elements = text.partition("*Element")[0], "", text.partition("*Element")
    folder = tmp_path / "model"
    (folder / "parts").mkdir(parents=True)
    (folder / "parts" / "nodes.txt").write_text(head.partition("NALL\n")[2])
    (folder / "parts" / "elements.inc").write_text("".join(elements[1:]))
    result = deck(folder / "a.inp", "*NODE, NSET=NALL, INPUT=parts/nodes.txt\n*INCLUDE, INPUT=parts/elements.inc\n")
    assert len(result.blocks[0][2]) == 8 and nodes == ""
    (tmp_path / "out.inc").write_text("*NODE\n1, 0, 0, 0\n")
    for name in ("../out.inc", str(tmp_path / "out.inc")):
        with pytest.raises(ConfigError, match=r"a.inp:1: expected an include within .*model.*copy it there"):
            deck(folder / "a.inp", f"*INCLUDE, INPUT={name}\n")
    (folder / "link.inc").symlink_to(tmp_path / "out.inc")
    with pytest.raises(ConfigError, match="an include within"):
        deck(folder / "a.inp", "*INCLUDE, INPUT=link.inc\n")
    with pytest.raises(ConfigError, match="a.inp:1: expected a file to include, found none at"):
        deck(folder / "a.inp", "*INCLUDE, INPUT=none.inc\n")
    (folder / "b.inc").write_text("*INCLUDE, INPUT=b.inc\n")
    with pytest.raises(ConfigError, match="b.inc:1: expected includes that end"):
        deck(folder / "a.inp", "*INCLUDE, INPUT=b.inc\n")


def test_what_is_not_read_is_said(tmp_path):
    more = f"""{IRON}*DAMPING, ALPHA=3.
*ELEMENT, TYPE=SPRING1, ELSET=springs
9001, 1
9002, 2
*STEP
*FREQUENCY
20,
*END STEP
*STEP
*END STEP
"""
    note, = deck(tmp_path / "a.inp", abaqus(cube(), more=more)).notes
    assert note == ("not read: *DAMPING, *STEP (2 times), *FREQUENCY, *ELEMENT of type SPRING1 (2 times)")


@pytest.mark.parametrize("more, message", [
    ("*NODE\n1, 0, 0, 0\n", "one node of each number, found node 1 twice"),
    ("*ELEMENT, TYPE=C3D10\n1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n",
     "one element of each number, found element 1 twice"),
    ("*ELEMENT, TYPE=C3D10\n99, 1, 2, 3, 4, 5, 6, 7, 8, 9, 5000\n", "node 5000 of element 99, which no line defines"),
    ("*ELEMENT, TYPE=C3D20\n99, 1, 2, 3\n", "20 nodes of an element of type C3D20, found 3 nodes; end lines"),
    ("*ELEMENT, TYPE=C3D10\n99, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11\n", "10 nodes of an element .* found 11 nodes"),
    ("*ELEMENT, TYPE=C3D7\n1, 2\n", "expected C3D20, C3D27, C3D10 or C3D15.*found C3D7"),
    ("*ELEMENT, ELSET=A\n1, 2\n", r"\*ELEMENT with TYPE=, found none"),
    ("*NSET, NSET=a\nnowhere\n", "a number, or one of the sets NALL, found 'nowhere'; define"),
    ("*SURFACE, NAME=a\nnowhere, S1\n", "one of the sets ALL, found 'nowhere'"),
    ("*NODE\n500, 0, x, 0\n", r"a.inp:\d+: expected a number, found 'x'"),
    ("*NODE\n500.5, 0, 0, 0\n", "a whole number, found '500.5'"),
    ("*NODE\n500, 0, nan, 0\n", "a number, found 'nan'"),
    ("*NODE, SYSTEM=C\n500, 1, 90, 0\n", "Cartesian coordinates"),
    ("*NSET, NSET=a, GENERATE\n1, 99999999999, 1\n", "a range of numbers"),
    ("*NSET, NSET=a, GENERATE\n1\n", "first number, last and step"),
    ("*NGEN\n1, 2\n", r"a mesh that is written out, found \*NGEN"),
    ("*SOLID SECTION, ELSET=ALL, MATERIAL=LEAD\n", "a material that the deck defines, found 'LEAD'"),
    ("*MATERIAL, NAME=A\n*SOLID SECTION, ELSET=NO, MATERIAL=A\n",
     "a set of elements that the deck defines, found 'NO'"),
])
def test_faults_have_one_sentence(tmp_path, more, message):
    with pytest.raises(ConfigError, match=message):
        deck(tmp_path / "a.inp", abaqus(cube(), more=more))


def test_data_before_a_keyword(tmp_path):
    with pytest.raises(ConfigError, match="a.inp:1: expected a keyword such as .NODE, found 'no deck'"):
        deck(tmp_path / "a.inp", "no deck\n")
