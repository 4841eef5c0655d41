"""Meshes of files: round trips of every kind, units, and what is refused, with part and remedy."""

import meshio
import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block, boundary_faces, revolve
from pipeline.physics.fem.mesh_file import check, read_mesh
from pipeline.physics.fem.reference_cells import by_kind
from tests.physics.fem.mixed_meshes import cut

pytestmark = pytest.mark.exact


def written(path, mesh, scale=1.0):
    blocks = [(kind, cells) for kind, _, cells in by_kind(mesh.kind, mesh.element)]
    form = "gmsh" if path.suffix == ".msh" else None
    meshio.Mesh(scale * mesh.node, blocks).write(path, form)
    return path


def ring(kind):
    lines = np.array([0.1, 0.15]), np.linspace(0, 2 * np.pi, 17), np.array([0, 0.02])
    return cut(revolve(*lines, kind="hexahedron27"), kind)


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10"])
@pytest.mark.parametrize("suffix", ["vtu", "inp", "msh"])
def test_a_ring_in_millimetres_has_its_mass(tmp_path, kind, suffix):
    mesh = ring(kind)
    read, *_ = read_mesh(written(tmp_path / f"ring.{suffix}", mesh, 1e3), "mm-t-s")
    assert read.kind == kind and len(read.node) == len(mesh.node)
    table = [7200.0], [isotropic(1e11, 0.3)]
    masses = [assemble(m.node, m.element, m.kind, np.zeros(len(m.element), int), *table)[1].sum() for m in (mesh, read)]
    assert masses[1] == pytest.approx(masses[0], rel=1e-9)
    assert masses[1] / 3 == pytest.approx(7200 * np.pi * 0.0125 * 0.02, rel=1e-3)


@pytest.mark.parametrize("suffix, kind", [("bdf", "hexahedron20"), ("bdf", "tetra10")])
def test_nastran(tmp_path, suffix, kind):
    mesh = ring(kind)
    mesh = type(mesh)(mesh.node.round(6), mesh.element, kind, mesh.cell)
    read, *_ = read_mesh(written(tmp_path / f"ring.{suffix}", mesh))
    assert np.allclose(read.node[read.element], mesh.node[mesh.element], atol=1e-6)


def test_millimetres_taken_for_metres_are_refused_and_the_reverse(tmp_path):
    with pytest.raises(ConfigError, match="300 m with mesh_units: SI; declare mesh_units: mm-t-s or mm-kg-ms"):
        read_mesh(written(tmp_path / "a.vtu", ring("tetra10"), 1e3))
    with pytest.raises(ConfigError, match="declare mesh_units: SI"):
        read_mesh(written(tmp_path / "b.vtu", ring("tetra10")), "mm-t-s")


@pytest.mark.parametrize("kind", ["hexahedron", "tetra"])
def test_linear_elements_are_refused_with_the_reason(tmp_path, kind):
    count = {"hexahedron": 8, "tetra": 4}[kind]
    mesh = block(*[np.linspace(0, 0.1, 2)] * 3, kind="hexahedron")
    meshio.Mesh(mesh.node, [(kind, mesh.element[:, :count])]).write(tmp_path / "linear.vtu")
    with pytest.raises(ConfigError, match=f"{kind}; linear elements lock.*20 %.*write quadratic"):
        read_mesh(tmp_path / "linear.vtu")


def test_damaged_files_and_other_cells_are_refused(tmp_path):
    (tmp_path / "broken.vtu").write_text("no mesh")
    with pytest.raises(ConfigError, match="broken.vtu"):
        read_mesh(tmp_path / "broken.vtu")
    (tmp_path / "blank.bdf").write_text("BEGIN BULK\nGRID,1,,0.,0.,0.\nCTETRA,1,1,1,1,1,1,1,1\n,1,1,1,1\nENDDATA\n")
    with pytest.raises(ConfigError, match="blank.bdf"):
        read_mesh(tmp_path / "blank.bdf")
    meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])]).write(tmp_path / "flat.vtu")
    with pytest.raises(ConfigError, match="no solid cells"):
        read_mesh(tmp_path / "flat.vtu")


def test_coincident_nodes_parts_and_inverted_elements_are_refused(tmp_path):
    mesh = block(*[np.linspace(0, 0.1, 3)] * 3)
    split = type(mesh)(mesh.node[mesh.element].reshape(-1, 3), np.arange(mesh.element.size).reshape(-1, 20), mesh.kind,
                       mesh.cell)
    with pytest.raises(ConfigError, match="one node in one place.*merge"):
        read_mesh(written(tmp_path / "split.vtu", split))
    shifted = np.concatenate([mesh.node, mesh.node + (0.2, 0, 0)])
    two = type(mesh)(shifted, np.concatenate([mesh.element, mesh.element + len(mesh.node)]), mesh.kind, mesh.cell)
    with pytest.raises(ConfigError, match="one connected body.*2 parts"):
        read_mesh(written(tmp_path / "two.vtu", two))
    with pytest.raises(ConfigError, match="positive Jacobians.*element 0.*order of its vertices"):
        mirrored = type(mesh)(mesh.node * (1, 1, -1), mesh.element, mesh.kind, mesh.cell)
        read_mesh(written(tmp_path / "turned.vtu", mirrored))


def test_what_is_not_taken_is_said(tmp_path):
    mesh = ring("tetra10")
    faces = boundary_faces(mesh)
    meshio.Mesh(mesh.node, [("tetra10", mesh.element), ("triangle6", faces)],
                point_data={"rim": np.ones(len(mesh.node))}).write(tmp_path / "a.vtu")
    read, _, notes = read_mesh(tmp_path / "a.vtu")
    assert len(read.element) == len(mesh.element) and notes == (
        f"not read: {len(faces)} cells triangle6; data at points rim",)
    assert read_mesh(written(tmp_path / "b.vtu", mesh))[2] == ()


def test_mid_side_nodes_off_their_edges_are_refused():
    """Of a straight edge of length 1 up to 0.3; a quarter is the limit of a sound element."""
    mesh = block(*[np.linspace(0, 0.1, 2)] * 3)
    for off, sound in ((0.2, True), (0.35, False)):
        node = mesh.node.copy()
        node[mesh.element[0, 8]] += (0, -0.1 * off, 0)
        moved = type(mesh)(node, mesh.element, mesh.kind, mesh.cell)
        if sound:
            check(moved, "a")
        else:
            with pytest.raises(ConfigError, match="node 9 of element 7 .hexahedron20. 0.35 of its edge away"):
                check(moved, "a", np.array([7]))


def test_physical_groups_of_gmsh(tmp_path):
    """A group of solids and one of faces, beside points that no solid has."""
    mesh = ring("tetra10")
    faces = boundary_faces(mesh)
    inner = faces[np.hypot(*mesh.node[faces[:, 0], :2].T) < 0.101]
    node = np.vstack([[(9.0, 9.0, 9.0)], mesh.node])
    physical = [np.where(np.arange(len(mesh.element)) < 5, 1, 4), np.full(len(inner), 2)]
    meshio.Mesh(node, [("tetra10", mesh.element + 1), ("triangle6", inner + 1)],
                cell_data={"gmsh:physical": physical, "gmsh:geometrical": physical},
                field_data={"few": np.array([1, 3]), "Bore": np.array([2, 2])}).write(tmp_path / "a.msh", "gmsh22")
    read, groups, notes = read_mesh(tmp_path / "a.msh")
    assert set(groups) == {"FEW", "BORE"} and list(groups["FEW"]) == [0, 1, 2, 3, 4] and notes == ()
    assert np.array_equal(read.node[groups["BORE"]], mesh.node[inner])


@pytest.mark.parametrize("vertex", [-1, 20, 10**9])
def test_elements_of_nodes_that_are_not_there_are_refused(tmp_path, vertex):
    """meshio passes them on, and -1 would be the last node."""
    mesh = block(*[np.linspace(0, 0.1, 2)] * 3, kind="hexahedron20")
    element = mesh.element.copy()
    element[0, 3] = vertex
    meshio.Mesh(mesh.node, [("hexahedron20", element)]).write(tmp_path / "a.vtu")
    with pytest.raises(ConfigError, match=f"expected elements of its 20 nodes, found a vertex at row {vertex}"):
        read_mesh(tmp_path / "a.vtu")


@pytest.mark.parametrize("name", ["a.med", "a.xdmf", "a.cgns", "a.e", "a"])
def test_formats_that_take_data_from_other_files_are_refused(tmp_path, name):
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(ConfigError, match=r"expected one of \.inp, \.msh, \.vtu"):
        read_mesh(tmp_path / name)
