"""A whole brake from one Abaqus deck, linings and backplates of unlike meshes, beside the program's own."""

from operator import attrgetter

import numpy as np
import pytest

import stages
from pipeline.contract import ConfigError, Context
from pipeline.contract import case as cases
from pipeline.physics.numerics.sparse_solver import available
from pipeline.systems.disc_brake import build
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from stages.structure import Caliper, Disc, Joints, Pad, Settings, structure
from tests.decks.meshes.small_decks import abaqus
from tests.stages.brake_deck import SETS, deck, meshes
from tests.stages.test_structure import friction_map
from tests.systems.test_disc_brake_bracket import BODIES

pytestmark = pytest.mark.exact
#: two modes of this brake are unstable
BRAKE = {"disc": Disc(web_cells=2, ring_cells=4, angular_cells=30), "caliper": Caliper(
    radial_cells=2, angular_cells=4, housing_cells=1, bridge_cells=1), "frequency_max": "6 kHz",
    "free_frequency_max": "1 kHz", "pressures": ["3 MPa"], "joints": Joints(
        abutment_stiffness="17 MN/m", clip_stiffness="0.34 MN/m", abutment_radial_stiffness="1 MN/m",
        finger_stiffness="500 MN/m", finger_shear_stiffness="15.5 MN/m", piston_shear_stiffness="55 MN/m",
        guide_pin_stiffness="36 MN/m", loss_time="1 us")}
NATIVE = Settings(**BRAKE, pad=Pad(cells_per_patch=1, lining_layers=1))


def from_deck(path, text=None, **changes):
    path.write_text(deck(NATIVE) if text is None else text)
    return Settings(**{**BRAKE, "mesh_file": path, "mesh_units": "mm-t-s", "mesh_sets": SETS, **changes})


def unstable(settings):
    """(k,) growth rates + i angular frequencies of the unstable modes at 3 MPa and 12 rad/s, by frequency."""
    context = Context(solver=available()[0])
    brake = structure(friction_map(), settings, context=context)
    model = reduced_model(brake, Reduction(fixed_below="6 kHz", residual_below="100 kHz"), context=context)
    modes = complex_modes(model, friction_map(), None, brake, Modes(
        speeds=("12 rad/s",), friction_steps=2, frequency_max="6 kHz"), context=context)
    return brake, np.sort_complex(-1j * modes.unstable_root) * 1j


@pytest.mark.slow
def test_the_unstable_modes_are_those_of_the_native_brake(tmp_path):
    native, expected = unstable(NATIVE)
    brake, roots = unstable(from_deck(tmp_path / "brake.inp"))
    assert len(roots) == len(expected) == 2
    assert roots.imag == pytest.approx(expected.imag, rel=0.01)
    assert roots.real == pytest.approx(expected.real, rel=0.1)
    assert len(brake.pad_outer.ties) == len(brake.pad_inner.ties) == 1 and not native.pad_outer.ties
    assert brake.pad_outer.ties["tie_1"].share == pytest.approx(1, abs=0.01)


def test_every_body_has_its_mass_and_place(tmp_path):
    made, native = (build(settings) for settings in (from_deck(tmp_path / "brake.inp"), NATIVE))
    for body, expected in zip(made.bodies, native.bodies, strict=True):
        mass, other = (each.matrices()[1].sum() / 3 for each in (body, expected))
        assert mass == pytest.approx(other, rel=2e-4)
        assert np.allclose(body.mesh.node.min(axis=0), expected.mesh.node.min(axis=0), atol=1e-9)
    assert made.pad_area == pytest.approx(native.pad_area) and made.joints.name == native.joints.name
    assert np.allclose(made.contacts.position, native.contacts.position, atol=1e-9)


def test_an_inner_pad_is_the_mirror_image_of_the_outer_one(tmp_path):
    sets = {key: names for key, names in SETS.items() if key != "pad_inner"}
    made = build(from_deck(tmp_path / "brake.inp", mesh_sets=sets))
    outer, inner = made.bodies[1:3]
    assert np.allclose(inner.mesh.node, outer.mesh.node * (1, 1, -1))
    for one, other in zip(outer.matrices(), inner.matrices(), strict=True):
        sign = np.tile([1, 1, -1.0], len(outer.mesh.node))
        assert abs(one - other.multiply(sign[:, None]).multiply(sign)).max() < 1e-9 * abs(one).max()


def test_one_file_a_body(tmp_path):
    """The pads alone from the deck; what the case states goes before the file."""
    (tmp_path / "brake.inp").write_text(deck(NATIVE))
    pad = {"mesh_file": str(tmp_path / "brake.inp"), "mesh_units": "mm-t-s", "mesh_sets": SETS["pad_outer"],
           "backplate_young": "100 GPa", "lining_young_normal": "2 GPa"}
    made = build(Settings(**BRAKE, pad=pad))
    stated = build(Settings(**BRAKE, pad={"cells_per_patch": 1, "lining_layers": 1, "backplate_young": "100 GPa",
                                          "lining_young_normal": "2 GPa"}))
    assert made.bodies[1].elasticity == pytest.approx(stated.bodies[1].elasticity)
    assert made.bodies[1].material_name == ("lining", "STEEL")


@pytest.mark.parametrize("changes, replaced, message", [
    ({"mesh_sets": {**SETS, "caliper": "HOUSING"}}, (), "sets of solid elements, of DISC, CALIPER, OUTER_LINING, .*"
     "found 'HOUSING'; name sets"),
    ({}, ("*TIE, NAME=OUTER_GLUE", "*EQUATION, NAME=A"), "OUTER_PLATE: expected one node in one place|one connected"),
    ({}, ("OUTER_LINING_FACE, OUTER_PLATE_FACE", "OUTER_LINING_FACE, NOWHERE"),
     "surfaces that the deck defines: .*found 'NOWHERE'; define it"),
    ({}, ("*ELSET, ELSET=LINING", "*ELSET, ELSET=FRICTION"), "structure.pad.lining_set: expected a set of elements, or"
     " a material, of the pad in the mesh file: .*found 'LINING'"),
    ({}, ("1., 0., 0., 0., 1., 0.", "1., 0., 0., 2., 0., 0."), "points that span a plane"),
    ({}, ("*SOLID SECTION, ELSET=CALIPER, MATERIAL=NODULAR", "*DAMPING"), "structure.caliper: expected a material of"
     " the ductile iron, found none of IRON, NODULAR, STEEL, RESIN on its elements; write a section"),
    ({}, ("*SOLID SECTION, ELSET=OUTER_PLATE, MATERIAL=STEEL", "*DAMPING"), "structure.pad: expected a material of the"
     " steel, found none of IRON"),
    ({"mesh_units": "mm-kg-ms"}, (), "declare mesh_units: mm-t-s"),
])
def test_faults_are_named_with_their_remedy(tmp_path, changes, replaced, message):
    text = deck(NATIVE).replace(*replaced) if replaced else deck(NATIVE)
    with pytest.raises(ConfigError, match=message):
        build(from_deck(tmp_path / "brake.inp", text, **changes))


def test_pads_that_do_not_lie_on_the_disc(tmp_path):
    with pytest.raises(ConfigError, match="contact of the outer pad with the disc: expected a lining whose face lies"
                       " on the ring, within 0.1 mm, found 100% of it off the disc, at heights of 0.0054"):
        build(from_deck(tmp_path / "brake.inp", deck(NATIVE, lift=2e-3)))


def test_joints_by_groups_where_the_dimensions_are_others(tmp_path):
    """Guide pins that the stated radius puts off the housing: the place is named, and a group of that name serves."""
    joints = Joints(guide_pin_radius="190 mm")
    with pytest.raises(ConfigError, match="structure.joints: guide_pin_leading_front: expected a group"
                                          " GUIDE_PIN_LEADING_FRONT in the mesh of the caliper"):
        build(from_deck(tmp_path / "brake.inp", joints=joints))
    mesh = meshes(NATIVE)["CALIPER"]
    first = 1 + sum(len(each.node) for name, each in meshes(NATIVE).items() if name == "DISC")
    angle = np.arctan2(mesh.node[:, 1], mesh.node[:, 0])
    sets = [f"*NSET, NSET=GUIDE_PIN_{end}\n" + "".join(f"{first + k},\n" for k in np.flatnonzero(
        sign * angle > 0.99 * angle.max())) for end, sign in (("LEADING", -1), ("TRAILING", 1))]
    made = build(from_deck(tmp_path / "brake.inp", deck(NATIVE) + "".join(sets), joints=joints))
    row = made.joints.rows.parts[3][list(made.joints.name).index("guide_pin_leading_axial_front")]
    assert row.sum() == pytest.approx(1) and (row.indices[row.data != 0] % 3 == 2).all()


def test_a_case_is_checked_before_anything_is_computed(tmp_path):
    (tmp_path / "brake.inp").write_text(deck(NATIVE))
    head = "chain: own_brake\nstructure:\n  mesh_file: brake.inp\n  mesh_units: mm-t-s\n"
    for more, message in (("  mesh_sets: {caliper: HOUSING}\n", "found 'HOUSING'"),
                          ("  mesh_sets: {hub: DISC}\n", "expected bodies disc, pad_outer, .*found 'hub'"),
                          ("", "found no mesh_sets"),
                          ("  mesh_sets: {disc: DISC}\n  disc: {mesh_file: a.inp}\n", "found disc.mesh_file besides")):
        (tmp_path / "a.yaml").write_text(head + more)
        with pytest.raises(ConfigError, match=message):
            cases.load(tmp_path / "a.yaml", stages.CHAINS, stages.load)


def test_bracket_and_piston_from_files_of_their_own(tmp_path):
    """Their own meshes as decks: the same matrices, joints and line pressure as without files."""
    settings = Settings(**BODIES)
    native, changed = build(settings), {}
    for name in ("bracket", "piston", "caliper"):
        (tmp_path / f"{name}.inp").write_text(abaqus(native.bodies[native.names.index(name)].mesh))
        changed[name] = getattr(settings, name).model_copy(update={
            "mesh_file": tmp_path / f"{name}.inp", "mesh_units": "mm-t-s"})
    made = build(Settings(**{**BODIES, **changed}))
    assert made.names == native.names and made.joints.name == native.joints.name
    for one, other in zip(made.bodies, native.bodies, strict=True):
        assert abs(one.matrices()[0] - other.matrices()[0]).max() < 1e-6 * abs(other.matrices()[0]).max()
    for rows in ("joints.rows", "piston"):
        one, other = (attrgetter(rows)(brake).matrix for brake in (made, native))
        assert abs(one - other).max() < 1e-6
