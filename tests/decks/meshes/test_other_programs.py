"""Decks that other programs write, and what CalculiX computes from one of ours."""

import numpy as np
import pytest
import scipy

from pipeline.decks.meshes import abaqus, nastran
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.elasticity import assemble
from pipeline.physics.fem.mesh import block
from pipeline.physics.fem.mesh_file import mesh_of
from pipeline.physics.fem.reference_cells import quadrature, shape_functions
from pipeline.physics.fem.supports import held_modes
from tests.decks.meshes import written_by_gmsh
from tests.decks.meshes.small_decks import abaqus as written
from tests.physics.fem.mixed_meshes import cut

#: CalculiX 2.20, C3D10, *FREQUENCY: first natural frequencies [Hz] of the block of the test below
CALCULIX = (4444.479, 4634.954, 5191.592, 6357.095, 6655.358, 6856.341)
LINING = """*MATERIAL, NAME=LINING
*ELASTIC, TYPE=ENGINEERING CONSTANTS
6000., 5000., 1500., 0.1, 0.2, 0.3, 2500., 1200.,
1100., 20.
*DENSITY
2.6e-9
*ORIENTATION, NAME=AXES
0.6, 0.8, 0., -0.8, 0.6, 0.
*SOLID SECTION, ELSET=ALL, MATERIAL=LINING, ORIENTATION=AXES
"""


@pytest.mark.golden
@pytest.mark.parametrize("reader, suffix, text", [(abaqus, "inp", written_by_gmsh.ABAQUS),
                                                  (nastran, "bdf", written_by_gmsh.NASTRAN)])
def test_elements_of_gmsh(tmp_path, reader, suffix, text):
    """Each is a sound body: its mid-side nodes lie on its edges, its volume is that of its corners."""
    (tmp_path / f"all.{suffix}").write_text(text)
    deck = reader.read(tmp_path / f"all.{suffix}")
    volumes = {"hexahedron20": 8000e-9, "wedge15": 1000e-9, "tetra10": 1000e-9 / 6}
    assert [kind for kind, *_ in deck.blocks] == list(volumes) and deck.notes == ()
    for kind, numbers, rows in deck.blocks:
        mesh, _ = mesh_of(kind, deck.node, [(kind, rows)], "mm-t-s", numbers)
        mass = assemble(mesh.node, mesh.element, kind, [0], [1.0], [np.eye(6)])[1].sum() / 3
        assert mass == pytest.approx(volumes[kind], rel=1e-4)
    if suffix == "inp":
        assert list(deck.element_sets["WEDGE15"]) == [2] and list(deck.node_sets["TET10"]) == list(range(36, 46))


@pytest.mark.golden
def test_frequencies_of_calculix(tmp_path):
    """A lining with engineering constants along turned axes, held at z = 0.

    CalculiX integrates the mass of C3D10 by the four points of its stiffness, and so does this test.
    """
    mesh = cut(block(np.linspace(0, 0.1, 5), np.linspace(0, 0.08, 4), np.linspace(0, 0.03, 3), kind="hexahedron27"),
               "tetra10")
    (tmp_path / "a.inp").write_text(written(mesh, more=LINING))
    body = read_body(tmp_path / "a.inp", "mm-t-s")
    node, element, (material,) = body.mesh.node, body.mesh.element, body.materials
    stiffness, _ = assemble(node, element, "tetra10", body.element_material, [material.density],
                            [material.elasticity()])
    mass = np.zeros((len(node),) * 2)
    point, weight = quadrature("tetra10", 2)
    shape, gradient = shape_functions("tetra10", point)
    assert len(weight) == 4
    for cell in element:
        volume = weight * np.linalg.det(np.einsum("vx,qvr->qxr", node[cell], gradient))
        mass[np.ix_(cell, cell)] += material.density * np.einsum("q,qa,qb->ab", volume, shape, shape)
    held = np.flatnonzero(node[:, 2] < 1e-9)
    frequency, _ = held_modes(stiffness, sparse_of_each_axis(mass), held, "superlu", count=6)
    assert frequency == pytest.approx(CALCULIX, rel=1e-6)


def sparse_of_each_axis(matrix):
    """The same for each of three axes, axis last."""
    return scipy.sparse.kron(scipy.sparse.csr_matrix(matrix), scipy.sparse.identity(3), "csr")
