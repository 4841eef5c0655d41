"""The stage on a coarse brake: modes, contact law, preload and what changes them."""

from dataclasses import replace

import numpy as np
import pytest

import stages
from pipeline.contract import ConfigError, Context
from pipeline.contract import case as cases
from pipeline.physics.numerics.sparse_solver import available
from pipeline.products import FrictionMap
from pipeline.recordings import registry
from pipeline.systems.disc_brake_disc import disc_mesh
from stages.structure import Joints, Settings, structure
from tests.commands import ROOT
from tests.decks.meshes.small_decks import abaqus
from tests.systems.test_disc_brake import COARSE
from tests.systems.test_disc_brake_bracket import BODIES

pytestmark = pytest.mark.exact
QUICK = {**COARSE, "frequency_max": "4 kHz", "free_frequency_max": "1 kHz", "pressures": ["1 MPa", "3 MPa"]}
#: moduli of a lining
MODULI = [f"lining_{kind}" for kind in ("young_radial", "young_tangential", "young_normal", "shear_normal",
                                        "shear_in_plane")]


def friction_map(stiffness=(5e11, 1e12, 1.4e12)):
    table = np.outer(stiffness, [1.0, 1.2])
    return FrictionMap(pressure=[1e6, 2e6, 3e6], speed=[1.0], distance=[0.0, 0.02],
                       friction=np.full((3, 1, 2), 0.5), friction_std=np.zeros((3, 1, 2)), normal_stiffness=table,
                       computed_pressure=[1e6, 2e6, 3e6], computed_speed=[1.0], best_pressure=[2e6, 2e6],
                       pressure_slope_std=[0.0, 0.0], speed_slope_std=[0.0, 0.0],
                       error_correlation=np.tile(np.eye(3), (2, 1, 1)), bulk_temperature=0.0)


def run(stiffness=(5e11, 1e12, 1.4e12), **changes):
    return structure(friction_map(stiffness), Settings(**{**QUICK, **changes}), context=Context(solver=available()[0]))


@pytest.fixture(scope="module")
def brake():
    return run()


def test_a_brake_without_them_has_four_bodies(brake):
    assert not brake.others and len(brake.body_name) == 4 and not len(brake.fluid_stiffness)


def test_pads_carry_the_piston_force(brake):
    """The seal spring keeps at most 1 % of it; both pads are pressed alike, stiffer under more pressure."""
    for force, pressure in zip(brake.preload, brake.pressure, strict=True):
        for pad in (1, 2):
            assert force[brake.contact_body == pad].sum() == pytest.approx(pressure * brake.piston_area, rel=1e-2)
    assert brake.closed.all()
    assert (brake.contact_stiffness[1] >= brake.contact_stiffness[0]).all()


def test_preload_is_even_about_the_middle_of_the_pad(brake):
    """Without friction, leading and trailing patches mirror one another."""
    force = brake.preload[0].reshape(2, 6, 3)
    assert force == pytest.approx(force[:, ::-1], rel=0.05)


def test_modes_of_free_and_mounted_bodies(brake):
    assert list(brake.free_diameters[:5]) == [2, 2, 0, 3, 3]
    assert brake.free_frequency[:5] == pytest.approx([259.4, 259.4, 431.6, 660.1, 660.1], rel=5e-3)
    assert brake.disc.frequency[0] > brake.free_frequency[0]
    assert brake.pad_outer.frequency[:6] == pytest.approx(0, abs=1)
    assert not brake.disc.shape[:, brake.disc.supported].any()
    assert brake.pad_outer.frequency[6:] == pytest.approx(brake.pad_inner.frequency[6:])


def test_bracket_and_piston_as_bodies():
    """The line pressure still reaches both pads in full, and the fluid adds no static stiffness to the seal's."""
    brake = run(**BODIES)
    assert list(brake.body_name[4:]) == ["bracket", "piston"] == list(brake.others)
    assert brake.body("bracket") is brake.others["bracket"] and brake.body("disc") is brake.disc
    for name in brake.others:
        assert brake.body(name).frequency[:6] == pytest.approx(0, abs=1)
    for force, pressure in zip(brake.preload, brake.pressure, strict=True):
        for pad in (1, 2):
            assert force[brake.contact_body == pad].sum() == pytest.approx(pressure * brake.piston_area, rel=1e-2)
    assert len(brake.fluid_stiffness) == len(brake.line_inertia) == 1
    stiffer = run(**{**BODIES, "piston": {"kind": "body", "fluid": {"bulk_modulus": "3 GPa"}}})
    assert stiffer.fluid_stiffness[0] == pytest.approx(2 * brake.fluid_stiffness[0])
    assert np.array_equal(stiffer.preload, brake.preload)


def test_law_follows_the_interface_stiffness(brake):
    slope = np.diff(brake.law_pressure) / np.diff(brake.law_closure)
    middle = (brake.law_pressure[1:] + brake.law_pressure[:-1]) / 2
    expected = np.interp(middle, [1e6, 2e6, 3e6], 1.1 * np.array([5e11, 1e12, 1.4e12]))
    inside = (middle > 1e6) & (middle < 3e6)
    assert slope[inside] == pytest.approx(expected[inside], rel=1e-2)


@pytest.mark.parametrize("changes", [
    {"stiffness": (2e11, 5e11, 7e11)}, {"joints": Joints(finger_stiffness="100 MN/m")},
    {"caliper": COARSE["caliper"].model_copy(update={"young": 8e10})},
    {"pad": COARSE["pad"].model_copy(update={"lining_young_normal": 8e8})}])
def test_interface_joint_caliper_and_lining_change_the_preload(brake, changes):
    assert np.abs(run(**changes).preload / brake.preload - 1).max() > 1e-3


def test_same_bits_again(brake):
    again = run()
    assert np.array_equal(again.preload, brake.preload)
    assert np.array_equal(again.disc.shape, brake.disc.shape)


def test_settings_without_unit_or_size_are_refused():
    with pytest.raises(ValueError, match="quantity in m"):
        Settings(disc={"ring_thickness": 7})
    with pytest.raises(ValueError, match="greater than 0"):
        Settings(disc={"ring_thickness": "-7 mm"})
    with pytest.raises(ConfigError, match="pads that lie on the ring"):
        run(pad=COARSE["pad"].model_copy(update={"inner_radius": 0.05}))


def test_a_disc_from_a_deck(tmp_path, brake):
    """The own mesh as an Abaqus deck with its material: the same modes; what is not read stands in the product."""
    deck = abaqus(disc_mesh(COARSE["disc"]), more="*SOLID SECTION, ELSET=ALL, MATERIAL=IRON\n*MATERIAL, NAME=IRON\n"
                  "*ELASTIC\n120000., 0.27\n*DENSITY\n7.2e-9\n*DAMPING, ALPHA=1.\n")
    (tmp_path / "disc.inp").write_text(deck)
    section = COARSE["disc"].model_copy(update={"mesh_file": tmp_path / "disc.inp", "mesh_units": "mm-t-s"})
    read = run(disc=section)
    assert list(read.mesh_given) == ["disc.young", "disc.poisson", "disc.density"] and len(brake.mesh_given) == 0
    assert read.free_frequency == pytest.approx(brake.free_frequency, rel=1e-6)
    assert read.mesh_note[0] == "disc: not read: *DAMPING" and len(read.mesh_note) == 4 and len(brake.mesh_note) == 0


def test_a_faulty_deck_is_refused_before_anything_is_computed(tmp_path):
    (tmp_path / "disc.inp").write_text("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D10\n1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n")
    (tmp_path / "a.yaml").write_text("chain: own_brake\nstructure: {disc: {mesh_file: disc.inp}}\n")
    with pytest.raises(ConfigError, match="disc.inp: expected nodes that the deck defines, found node 2 of element 1"):
        cases.load(tmp_path / "a.yaml", stages.CHAINS, stages.load)


def test_warm_linings_are_those_of_softer_moduli(brake):
    """All moduli of the linings by one factor, nothing else; without a softening the temperature changes nothing."""
    def warmed(softening):
        changed = Settings(**QUICK | {"pad": QUICK["pad"].model_copy(update={"lining_softening": softening})})
        return structure(replace(friction_map(), bulk_temperature=200.0), changed,
                         context=Context(solver=available()[0]))

    pad = Settings(**QUICK).pad
    softer = run(pad=pad.model_copy(update={name: 0.7 * getattr(pad, name) for name in MODULI}))
    warm = warmed(1.5e-3)
    for name in ("pad_outer", "pad_inner", "disc"):
        np.testing.assert_allclose(getattr(warm, name).frequency, getattr(softer, name).frequency, rtol=1e-9,
                                   atol=0.1)
    np.testing.assert_allclose(warm.preload, softer.preload, rtol=1e-9)
    assert (warm.pad_outer.frequency[6:] < 0.99 * brake.pad_outer.frequency[6:]).any()
    np.testing.assert_array_equal(warmed(0.0).preload, brake.preload)


@pytest.mark.parametrize(("changes", "message"), [
    (("friction_map.bulk_temperature=400 K", "structure.pad.lining_softening=3e-3 1/K"),
     "lining_softening: expected less than 0.0025 1/K, so that moduli are left at friction_map.bulk_temperature 400 K,"
     " found 0.003 1/K"),
    (("structure.pad.lining_pressure_exponent=0.3",), "structure.pad.damping_ratio: 0 beside it"),
    (("structure.pad.lining_pressure_exponent=0.3", "structure.pad.damping_ratio=0"), "0 in a chain with multibody"),
    (("structure.piston={kind: body, diameter: 62 mm}",), "structure.piston.diameter: expected a rim on the backplate"),
    (("structure.bracket={kind: body, arm_height: 15 mm}",), "structure.bracket.arm_height: expected arms that cover"),
    (("friction_map.bulk_temperature=2500 K",), "friction_map.bulk_temperature: expected less than 2000 K"),
])
def test_what_cannot_be_is_refused_before_all_else(changes, message):
    with pytest.raises(ConfigError, match=message):
        cases.load(ROOT / "configs" / "disc_brake_quick.yaml", stages.CHAINS, stages.load, changes, registry.path)


def test_a_fixed_caliper_presses_both_pads_alike():
    """Four pistons; each pad carries the whole force, up to what their seals keep."""
    made = run(caliper=COARSE["caliper"].model_copy(update={"fixed": True}),
               piston={"kind": "body", "count": 2, "diameter": "38 mm"}, pressures=["1 MPa"])
    for pad in (1, 2):
        assert made.preload[0][made.contact_body == pad].sum() == pytest.approx(1e6 * made.piston_area, rel=1e-2)
    assert (made.others["piston"].frequency < 1).sum() == 24 and len(made.fluid_stiffness) == made.piston_rows.rows == 2


def test_linings_stiffen_with_pressure(brake):
    """The preload at 3 MPa is that of moduli 3^n times as large, that at the pressure of their statement stays."""
    pad = Settings(**QUICK).pad
    made = run(pad=pad.model_copy(update={"lining_pressure_exponent": 0.4, "damping_ratio": 0.0}))
    stiffer = run(pad=pad.model_copy(update={name: 3**0.4 * getattr(pad, name) for name in MODULI}))
    np.testing.assert_allclose(made.preload[0], brake.preload[0], rtol=1e-9)
    np.testing.assert_allclose(made.preload[1], stiffer.preload[1], rtol=1e-9)
    assert made.lining_exponent == 0.4 and made.lining_pressure == 1e6
    assert np.abs(stiffer.preload[1] / brake.preload[1] - 1).max() > 1e-3
