"""Named groups: every face of every element lies on the plane that its corners span; sets follow the mesh."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.decks.meshes.groups import named_nodes
from pipeline.physics.fem.mesh import block, boundary_faces
from tests.decks.meshes.small_decks import abaqus, ansys, cube

pytestmark = pytest.mark.exact
COUNT = {"hexahedron20": 6, "hexahedron27": 6, "tetra10": 4, "wedge15": 5, "mixed": 5}


def body(folder, mesh, more):
    (folder / "a.inp").write_text(abaqus(mesh, more=more))
    return read_body(folder / "a.inp", "mm-t-s")


@pytest.mark.parametrize("kind", COUNT)
def test_faces_of_all_elements_enclose_the_body(tmp_path, kind):
    """All faces of all elements, those that occur once: the boundary."""
    mesh = block(*[np.linspace(0, 0.1, 3)] * 3, kind=kind) if kind == "hexahedron27" else cube(kind)
    more = "*SURFACE, NAME=every\n" + "".join(f"ALL, S{k}\n" for k in range(1, COUNT[kind] + 1))
    if kind == "mixed":
        more += "*ELSET, ELSET=HEX, GENERATE\n1, 4\n*SURFACE, NAME=every\nHEX, S6\n"
    read = body(tmp_path, mesh, more)
    faces = read.surfaces["EVERY"]
    keys, times = np.unique(np.sort(faces, axis=1), axis=0, return_counts=True)
    boundary = np.unique(np.sort(boundary_faces(mesh), axis=1), axis=0)
    assert np.array_equal(keys[times == 1], boundary) and set(times) == {1, 2}


def test_sets_follow_the_mesh(tmp_path):
    """Numbers with gaps, and nodes that no element has."""
    more = "*NODE\n9999, 1., 2., 3.\n*NSET, NSET=odd\n9999, 3, 1\n*ELSET, ELSET=pair\n2, 5, 777\n" \
           "*SURFACE, NAME=top, TYPE=NODE\nodd,\n*SURFACE, NAME=none\n777, S1\n"
    read = body(tmp_path, cube(), more)
    assert list(read.node_sets["ODD"]) == [0, 2] and list(read.element_sets["PAIR"]) == [1, 4]
    assert read.surfaces["TOP"].tolist() == [[0], [2]] and read.surfaces["NONE"].shape == (0, 1)
    assert list(named_nodes(read, "odd", "here")) == [0, 2] == list(named_nodes(read, "Top", "here"))
    with pytest.raises(ConfigError, match="here: expected a set of nodes or a surface of the mesh file: NALL, ODD, TOP,"
                                          " found 'none'"):
        named_nodes(read, "none", "here")
    with pytest.raises(ConfigError, match="surface LOW: expected faces S1 to S6 of hexahedron20, found S7"):
        body(tmp_path, cube(), "*SURFACE, NAME=low\n1, S7\n")


def test_components_of_ansys(tmp_path):
    (tmp_path / "a.cdb").write_text(ansys(cube()))
    read = read_body(tmp_path / "a.cdb", "mm-t-s")
    assert list(read.node_sets["RIM"]) == [0, 3, 4, 5, 6] and len(read.element_sets["BODY"]) == 8
