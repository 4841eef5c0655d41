"""Parts and instances of Abaqus decks: numbers, sets, sections and ties of each copy, shifted and turned."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.abaqus import read
from pipeline.decks.meshes.body import read_body
from tests.decks.meshes.small_decks import IRON, abaqus, cube

pytestmark = pytest.mark.exact
SECTION, _, MATERIAL = IRON.partition("*MATERIAL")
SIDES = "*SURFACE, NAME=top\nALL, S2\n*SURFACE, NAME=all_sides\nALL,\n*NSET, NSET=first\n1, 2\n"


def part(name, more=""):
    return f"*PART, NAME={name}\n{abaqus(cube()).partition('a body')[2]}{SECTION}{SIDES}{more}*END PART\n"


def instance(name, of, data=""):
    return f"*INSTANCE, NAME={name}, PART={of}\n{data}*END INSTANCE\n"


def deck(path, parts, instances, more=""):
    path.write_text(f"{parts}*ASSEMBLY, NAME=A\n{instances}{more}*END ASSEMBLY\n*MATERIAL{MATERIAL}")
    return path


def test_one_instance_keeps_its_numbers_and_is_shifted(tmp_path):
    end = "*NSET, NSET=top, INSTANCE=I\n1, 2\n"
    result = read(deck(tmp_path / "a.inp", part("P"), instance("I", "P", "0, 0, 5.\n"), end))
    assert np.allclose(result.node, 1e3 * cube().node + (0, 0, 5)) and list(result.node_sets["TOP"]) == [1, 2]


def test_several_instances_are_bodies_by_their_names(tmp_path):
    """A body of each instance; the second lies beside the first and is turned by 90 degrees about z."""
    file = deck(tmp_path / "a.inp", part("P"), instance("I-1", "P") + instance(
        "I-2", "P", "300., 0., 0.\n300., 0., 0., 300., 0., 1., 90.\n"))
    result = read(file)
    assert len(result.label) == 2 * len(cube().node) == len(np.unique(result.label))
    assert len(result.element_sets["ALL"]) == 16 and len(result.element_sets["I-2.ALL"]) == 8
    first, second = (read_body(file, "mm-t-s", [name]) for name in ("i-1", "I-2"))
    x, y, z = cube().node.T
    assert np.allclose(first.mesh.node, cube().node)
    assert np.allclose(second.mesh.node, np.column_stack((0.3 - y, x, z)))
    assert [m.name for m in second.materials] == ["IRON"] and (second.element_material == 0).all()
    assert len(second.node_sets["FIRST"]) == 2 == len(second.node_sets["I-2.FIRST"])
    assert len(second.node_sets["I-1.FIRST"]) == 0 and len(second.surfaces["TOP"]) == 8
    assert len(second.surfaces["ALL_SIDES"]) == 24


def test_axes_of_a_material_turn_with_the_instance(tmp_path):
    constants = "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n6000., 5000., 1500., 0.2, 0.2, 0.2, 2500., 1200.,\n1200."
    lining, turn = MATERIAL.replace("*ELASTIC\n110000.0, 0.26", constants), "0, 0, 0\n0, 0, 0, 0, 0, 1, 90.\n"
    file = deck(tmp_path / "a.inp", part("P"), instance("I", "P") + instance("J", "P", turn))
    file.write_text(file.read_text().replace(MATERIAL, lining))
    straight, turned = (read_body(file, "mm-t-s", [name]).materials[0].elasticity() for name in "IJ")
    assert turned[0, 0] == pytest.approx(straight[1, 1]) and turned[1, 1] == pytest.approx(straight[0, 0])
    assert turned[5, 5] == pytest.approx(straight[5, 5])


def test_tied_instances_are_one_body(tmp_path):
    """The upper cube is the lower one, turned over its upper face and tied there."""
    ties = "*SURFACE, NAME=a\nI.TOPS, S2\n*ELSET, ELSET=upper, INSTANCE=J\n1, 2, 3, 4, 5, 6, 7, 8\n*SURFACE, NAME=b\n" \
           "upper,\n*TIE, NAME=glue\na, b\n"
    file = deck(tmp_path / "a.inp", part("P", "*ELSET, ELSET=tops\n2, 4, 6, 8\n"),
                instance("I", "P") + instance("J", "P", "0, 0, 100.\n"), ties)
    body = read_body(file, "mm-t-s", ["I", "J"])
    (name, first, second), = body.ties
    assert name == "GLUE" and len(first) == 4 and len(second) == 24
    assert read_body(file, "mm-t-s", ["I"]).notes == ("not read: *TIE GLUE with another body",)
    file.write_text(file.read_text().replace("*TIE, NAME=glue\na, b\n", ""))
    with pytest.raises(ConfigError, match="I and J: expected one node in one place, .* or tie the parts"):
        read_body(file, "mm-t-s", ["I", "J"])
    assert len(read_body(file, "mm-t-s", ["J"]).mesh.element) == 8


def test_reference_points_of_the_assembly_are_no_nodes_of_bodies(tmp_path):
    points = "*NODE\n1, 7., 7., 7.\n*NSET, NSET=point\n1\n*NSET, NSET=corner, INSTANCE=I\n1\n"
    result = read(deck(tmp_path / "a.inp", part("P"), instance("I", "P"), points))
    assert len(result.label) == len(cube().node)
    assert len(result.node_sets["POINT"]) == 0 and list(result.node_sets["CORNER"]) == [1]


@pytest.mark.parametrize("instances, more, message", [
    (instance("I", "Q"), "", "an instance of one of the parts P, each name once, found I of Q"),
    (instance("I", "P") * 2, "", "each name once, found I of P"),
    (instance("I", "P"), "*NSET, NSET=a, INSTANCE=J\n1\n", "one of the instances I, found J"),
    (instance("I", "P"), "*TIE, NAME=T\nTOP, BOTTOM\n", "surfaces that the deck defines: I.TOP, .*found 'BOTTOM'"),
    (instance("I", "P"), "*TIE, NAME=T\nTOP\n", "two surfaces of .TIE, found TOP"),
    (instance("I", "P", "0, 0, 5.\n0, 0, 0, 0, 0, 0, 90.\n"), "", "an axis through two points"),
    (instance("I", "P", "0, 0, 5.\n0, 0, 0, 0\n"), "", "7 numbers of .INSTANCE"),
])
def test_faults_have_one_sentence(tmp_path, instances, more, message):
    with pytest.raises(ConfigError, match=message):
        read(deck(tmp_path / "a.inp", part("P"), instances, more))


def test_a_part_stands_once(tmp_path):
    with pytest.raises(ConfigError, match="each part once, found P again"):
        read(deck(tmp_path / "a.inp", part("P") * 2, instance("I", "P")))
