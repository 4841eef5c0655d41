"""The axis of a disc by its volume: about z, about another axis, tilted, beside z, and what is no disc."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.mesh import block
from pipeline.systems.disc_brake_disc import disc, disc_mesh
from pipeline.systems.mesh_files.bodies import notes
from pipeline.systems.mesh_files.disc_axis import refuse_other_axis, turning_axis
from stages.structure import Disc, Settings
from tests.decks.meshes.small_decks import IRON, abaqus, nastran, ring

pytestmark = pytest.mark.exact
COARSE = Disc(web_cells=2, ring_cells=3, angular_cells=24)


def turned(mesh, rows):
    return type(mesh)(mesh.node @ np.array(rows, float).T, mesh.element, mesh.kind, mesh.cell)


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "mixed"])
def test_a_disc_about_z_is_left_alone(kind):
    mesh = ring(kind)
    centre, axis = turning_axis(mesh)
    assert axis == pytest.approx([0, 0, 1], abs=1e-6) and centre == pytest.approx([0, 0, 0.01], abs=1e-5)
    refuse_other_axis(mesh, ())


def test_holes_and_vanes_in_equal_steps_do_not_move_the_axis():
    vaned = disc_mesh(Disc(ring_thickness="24 mm", cheek_thickness="7 mm", vane_count=24, vane_share=0.4, web_cells=2,
                           ring_cells=2, angular_cells=24))
    assert turning_axis(vaned)[1] == pytest.approx([0, 0, 1], abs=1e-6)
    refuse_other_axis(vaned, ())


@pytest.mark.parametrize("rows, about, ways", [
    ([(0, 0, 1), (1, 0, 0), (0, 1, 0)], "x", ("y, z, x", "y, -z, -x")),
    ([(0, 1, 0), (0, 0, 1), (1, 0, 0)], "y", ("z, x, y", "z, -x, -y"))])
@pytest.mark.parametrize("write, suffix", [(abaqus, "inp"), (nastran, "bdf")])
def test_a_disc_about_another_axis_names_the_setting_and_that_turns_it(tmp_path, rows, about, ways, write, suffix):
    mesh, more = disc_mesh(COARSE), IRON if suffix == "inp" else "PSOLID,1,7\nMAT1,7,1.1+5,,.26,7.1-9\n"
    (tmp_path / f"a.{suffix}").write_text(write(turned(mesh, rows), more=more))
    named = {"mesh_file": tmp_path / f"a.{suffix}", "mesh_units": "mm-t-s"}
    with pytest.raises(ConfigError, match=f"about the axis z, found one that turns about {about}; write"
                       rf" structure.disc.mesh_axes: \[{ways[0]}\], or \[{ways[1]}\] where"):
        disc(Disc(**named))
    settings = Disc(**named, mesh_axes=ways[0].split(", "))
    assert np.allclose(disc(settings).mesh.node, mesh.node, atol=1e-6) and len(disc(settings).supported)
    assert f"disc: turned: {ways[0]} of its file are x, y, z" in notes(Settings(disc=settings))


def test_wrong_axes_are_told_in_those_of_the_file(tmp_path):
    (tmp_path / "a.inp").write_text(abaqus(disc_mesh(COARSE), more=IRON))
    with pytest.raises(ConfigError, match=r"found one that turns about z; write structure.disc.mesh_axes: \[x, y, z\]"):
        disc(Disc(mesh_file=tmp_path / "a.inp", mesh_units="mm-t-s", mesh_axes=["y", "z", "x"]))


def test_tilted_discs_and_those_beside_the_axis():
    cos, sin = np.cos(np.radians(7)), np.sin(np.radians(7))
    with pytest.raises(ConfigError, match=r"turns about \(0.122, .*\), 7 degrees off z; turn the mesh"):
        refuse_other_axis(turned(ring(), [(cos, 0, sin), (0, 1, 0), (-sin, 0, cos)]), ())
    mesh = ring()
    moved = type(mesh)(mesh.node + (0.02, 0, 0), mesh.element, mesh.kind, mesh.cell)
    with pytest.raises(ConfigError, match=r"about a line through \(0.02, .*\) m; move the mesh"):
        refuse_other_axis(moved, ())


def test_what_is_no_body_of_revolution_is_not_judged():
    assert turning_axis(block(*[np.linspace(0, size, 3) for size in (0.1, 0.2, 0.3)])) is None
    assert turning_axis(block(*[np.linspace(0, 0.1, 3)] * 3)) is None
