"""Solids of mesh files: lining and backplate, contact faces, mirror images, dimensions, and what is said of them."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.elasticity import assemble, isotropic, orthotropic
from pipeline.physics.fem.mesh import revolve
from pipeline.systems.mesh_files.bodies import CONTACT, from_files, given, measured, notes, pad_solid, solid
from pipeline.systems.mesh_files.places import named_mean
from stages.structure import Caliper, Disc, Pad, Settings
from tests.decks.meshes.small_decks import IRON, abaqus
from tests.physics.fem.mixed_meshes import cut

pytestmark = pytest.mark.exact
#: lining between 10 and 20 mm, plate to 25 mm, with a groove of 4 mm along its middle
RADIUS, ANGLE, HEIGHT = np.array([0.09, 0.1, 0.12]), np.linspace(-0.3, 0.3, 4), np.array([0.01, 0.014, 0.02, 0.025])


def pad(path, kind="hexahedron20", groove=True, more="", **values):
    mask = np.ones((2, 3, 3), bool)
    mask[:, 1, 0] = not groove
    mesh = cut(revolve(RADIUS, ANGLE, HEIGHT, mask, kind="hexahedron27"), kind)
    height = mesh.node[mesh.element].mean(axis=1)[:, 2]
    numbers = "\n".join(str(k) for k in np.flatnonzero(height < 0.02) + 1)
    path.write_text(abaqus(mesh, more=f"{more}*ELSET, ELSET=LINING\n{numbers}\n"))
    return Pad(mesh_file=path, mesh_units="mm-t-s", **values)


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "wedge15", "mixed"])
def test_lining_and_plate_on_both_sides(tmp_path, kind):
    section = pad(tmp_path / "a.inp", kind)
    outer, inner = pad_solid(section, 1), pad_solid(section, -1)
    assert outer.material_name == ("lining", "steel") and list(outer.density) == [2600, 7820]
    for one, other in zip(outer.matrices(), inner.matrices(), strict=True):
        sign = np.tile([1, 1, -1.0], len(outer.mesh.node))
        assert abs(one - other.multiply(sign[:, None]).multiply(sign)).max() < 1e-9 * abs(one).max()
    for made, side in ((outer, 1), (inner, -1)):
        z = made.mesh.node[np.unique(made.mesh.groups[CONTACT]), 2]
        assert side * z == pytest.approx(0.01), "the bottom of the groove is no contact"


def test_dimensions_are_those_of_the_mesh(tmp_path):
    section = pad(tmp_path / "a.inp")
    found = measured(section, pad_solid(section, 1).mesh, 0.02)
    assert [found.inner_radius, found.outer_radius, found.angle] == pytest.approx([0.09, 0.12, 0.6])
    assert [found.lining_thickness, found.backplate_thickness] == pytest.approx([0.01, 0.005])


def test_the_lining_by_its_material(tmp_path):
    section = pad(tmp_path / "a.inp", more="*ELSET, ELSET=SOFT, GENERATE\n1, 5\n*SOLID SECTION, ELSET=SOFT,"
                  " MATERIAL=RESIN\n*MATERIAL, NAME=RESIN\n*ELASTIC\n3000., 0.2\n*DENSITY\n2.4e-9\n",
                  lining_set="resin", backplate_density="7820 kg/m^3")
    made = pad_solid(section, 1)
    assert made.material_name == ("lining", "steel") and (made.element_material == 0).sum() == 5
    assert made.elasticity[0] == pytest.approx(isotropic(3e9, 0.2)) and made.density[0] == pytest.approx(2400)
    assert given(Settings(pad=section)) == tuple(f"pad.lining_{key}" for key in (
        "young_radial", "young_tangential", "young_normal", "poisson", "shear_normal", "shear_in_plane", "density"))
    stated = section.model_copy(update={"lining_young_normal": 2e9})
    assert given(Settings(pad=stated)) == ("pad.lining_density",)
    assert pad_solid(stated, 1).elasticity[0] == pytest.approx(orthotropic(
        (6e9, 6e9, 2e9), (0.2,) * 3, (1.2e9, 1.2e9, 2.5e9)))
    with pytest.raises(ConfigError, match="lining_set: expected .*: ALL, SOFT, LINING, RESIN, found 'felt'"):
        pad_solid(section.model_copy(update={"lining_set": "felt"}), 1)


def test_a_pad_on_the_wrong_side(tmp_path):
    section = pad(tmp_path / "a.inp")
    wrong = section.model_copy(update={"inner_mesh_file": section.mesh_file})
    assert pad_solid(wrong, 1) is not None
    made = pad_solid(wrong, -1)
    assert made.mesh.node[np.unique(made.mesh.groups[CONTACT]), 2].min() > 0.01


def test_groups_say_where_joints_act(tmp_path):
    """Mean over nodes, or over the area of faces; a name without its last word stands for all of them."""
    mesh = revolve(RADIUS, ANGLE, HEIGHT)
    more = "*NSET, NSET=FINGER_LEADING_INNER\n1, 2\n*SURFACE, NAME=GUIDE_PIN_TRAILING\nALL,\n"
    (tmp_path / "a.inp").write_text(abaqus(mesh, more=more))
    made = solid(Caliper(mesh_file=tmp_path / "a.inp", mesh_units="mm-t-s"), "caliper")
    nodes = named_mean(made.mesh, "finger_leading_inner")
    assert list(nodes.indices) == [0, 1] and list(nodes.data) == [0.5, 0.5]
    assert named_mean(made.mesh, "finger_leading_outer") is None and named_mean(mesh, "finger") is None
    faces = named_mean(made.mesh, "guide_pin_trailing_front")
    assert faces.sum() == pytest.approx(1) and (faces @ mesh.node[:, 2]) == pytest.approx(0.0175, rel=1e-2)
    assert notes(Settings(caliper=Caliper(mesh_file=tmp_path / "a.inp", mesh_units="mm-t-s")))[-1] == (
        "caliper: joints act at its groups FINGER_LEADING_INNER, GUIDE_PIN_TRAILING")


def test_a_caliper_and_what_is_said(tmp_path):
    mesh = revolve(RADIUS, ANGLE, HEIGHT)
    (tmp_path / "a.inp").write_text(abaqus(mesh, more=IRON + "*DAMPING, ALPHA=1.\n*NSET, NSET=spot\n1, 2\n"))
    section = Caliper(mesh_file=tmp_path / "a.inp", mesh_units="mm-t-s", density="7100 kg/m^3", loss_factor=0.01)
    made = solid(section, "caliper")
    expected = assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), [7100],
                        [isotropic(110e9, 0.26)])
    assert abs(made.matrices()[0] - expected[0]).max() < 1e-6 * abs(expected[0]).max()
    assert list(made.mesh.groups["SPOT"].ravel()) == [0, 1] and list(made.loss_factor) == [0.01]
    brake = Settings(caliper=section)
    assert from_files(brake) == [("caliper", section)] and given(brake) == ("caliper.young", "caliper.poisson")
    assert notes(brake)[:2] == ("caliper: not read: *DAMPING",
                                "caliper: IRON: Young's modulus 1.1e+11 Pa, from the file")
    assert from_files(SimpleNamespace(disc=Disc())) == [] and len(read_body(tmp_path / "a.inp", "mm-t-s").ties) == 0
