"""Stage model_update on an assembled brake whose values are known, tested with meshes of its own."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

import stages
from pipeline.case_models.bodies.updated_case import completed
from pipeline.contract import ConfigError, ConvergenceError
from pipeline.contract import case as cases
from pipeline.products import ModalTest
from pipeline.views.chapters.bench.model_update import headline, strange, values
from stages.modal_test import Settings as Identification
from stages.modal_test import modal_test
from stages.model_update import Settings, model_update
from tests.stages.hammered_brake import (
    COARSE,
    FINER,
    POINTS,
    brake_of,
    full_modes,
    hammered,
    motions,
    points,
    responses,
)

#: the disc of lifted pads is not part of the motion
SMALL = {"disc": {"web_cells": 2, "ring_cells": 2, "angular_cells": 12}}
TRUE = {"finger_stiffness": "520 MN/m", "abutment_stiffness": "40 MN/m", "abutment_radial_stiffness": "6 MN/m",
        "finger_shear_stiffness": "16 MN/m", "piston_shear_stiffness": "24 MN/m", "guide_pin_stiffness": "25 MN/m"}
BEFORE = ("recording", "response_functions", "modal_test", "report")
UNSEEN = ("clip_stiffness",)
VALUES = {f"joints.{name}": {"spread": 0.3} for name in (*TRUE, *UNSEEN)}
STRUCK = ["pad_outer 0 direction 3", "pad_inner 0 direction 2", "caliper 1 direction 1"]
BODIES = ("pad_outer", "pad_inner", "caliper")


def settings(values=VALUES, **more):
    given = [point for point in points() if point["body"] in BODIES]
    return Settings(**{"body": "assembly", "values": values, "points": given, "finer": None} | COARSE | SMALL | more)


def off(result, sections):
    """How far the logarithm of each value is from the truth, and its standard deviation."""
    true = brake_of(sections)[1]
    known = [getattr(getattr(true, part), key) for part, key in (str(name).split(".") for name in result.parameter)]
    return np.log(result.after / known), result.after_spread


@pytest.fixture(scope="module")
def lifted():
    """Joints 10 to 30 % off, an update with the meshes of the truth."""
    return model_update(*hammered(COARSE | SMALL | {"joints": TRUE}, STRUCK, (100.0, 2200.0)), settings=settings())


@pytest.mark.exact
def test_stiffnesses_of_joints_come_back_as_well_as_they_say(lifted):
    apart, spread = off(lifted, COARSE | {"joints": TRUE})
    assert (abs(apart) < 2.5 * spread).all() and (abs(apart[:6]) < 0.03).all()
    assert lifted.clear.all() and len(lifted.clear) >= 9 and lifted.model_error < 1e-3
    before, after = (abs(f[lifted.pair] / lifted.measured_frequency - 1) for f in (lifted.frequency_before,
                                                                                 lifted.frequency))
    assert before.max() > 0.05 and after.max() < 1e-3


def test_a_joint_that_the_test_cannot_see_keeps_its_prior_and_the_page_says_so(lifted):
    assert lifted.after[-1] == pytest.approx(1e6, rel=0.1) and lifted.after_spread[-1] == pytest.approx(0.3, rel=0.05)
    assert "hardly tells joints.clip_stiffness: what was stated decides" in values(lifted)


def test_bodies_that_move_are_named(lifted):
    assert set(lifted.mover) >= set(BODIES) and lifted.mover_share[lifted.pair].min() > 0.3


@pytest.mark.slow
def test_on_another_mesh_intervals_hold_the_error_of_the_mesh():
    result = model_update(*hammered(FINER | SMALL | {"joints": TRUE}, STRUCK, (100.0, 2200.0)),
                          settings=settings(finer=1.5))
    apart, spread = off(result, FINER | {"joints": TRUE})
    assert (abs(apart) < 2 * spread).all() and result.mesh_checked
    assert (abs(apart[1:6]) < 0.05).all() and (result.after_spread[1:6] < 0.1).all()


@pytest.mark.slow
def test_pressed_pads_tell_the_stiffness_of_the_contact():
    """Another mesh, and a contact 20 % stiffer across and 12 % softer along the disc than stated."""
    known = {"stiffness": 1.2e12, "tangential_stiffness": 0.7e12}
    more = {"pressed.stiffness": {"spread": 0.4}, "pressed.tangential_stiffness": {"spread": 0.4}}
    test = hammered(FINER | {"joints": TRUE}, [*STRUCK, "disc 1 direction 3"], (100.0, 2500.0), (5e3, *known.values()))
    result = model_update(*test, settings=settings(VALUES | more | {"disc.young": {"spread": 0.03}}, **COARSE,
                                                   points=points(), pressed={"force": "5 kN"}, finer=1.5))
    names = list(map(str, result.parameter))
    true = brake_of(FINER | {"joints": TRUE})[1]
    for name, value, spread in zip(names, result.after, result.after_spread, strict=True):
        part, key = name.split(".")
        exact = known[key] if part == "pressed" else getattr(getattr(true, part), key)
        assert abs(np.log(value / exact)) < 2 * spread, name
    same = hammered(COARSE | {"joints": TRUE}, [*STRUCK, "disc 1 direction 3"], (100.0, 2500.0), (5e3, *known.values()))
    exact = model_update(*same, settings=settings(VALUES | more, **COARSE, points=points(), pressed={"force": "5 kN"}))
    np.testing.assert_allclose(exact.after[-2:], list(known.values()), rtol=0.08)
    assert (exact.after_spread[-2:] < 0.06).all()


@pytest.mark.slow
def test_from_frequency_responses_with_noise_to_joints():
    """Two blows on the outer pad and the caliper, 1 % noise, poles and residues by the stage modal_test."""
    sections = FINER | SMALL | {"joints": TRUE}
    brake, frequency, shape = full_modes(sections, 3500.0)
    names, motion = motions(brake, shape)
    kept = [k for k, name in enumerate(names) if name.startswith(("pad_outer", "caliper"))]
    names, motion = [names[k] for k in kept], motion[kept]
    measured = responses(names, frequency, motion, ["pad_outer 0 direction 3", "caliper 1 direction 1"],
                         np.arange(250.0, 2200.0, 1.0))
    modes = modal_test(measured, settings=Identification(lowest_frequency="260 Hz", highest_frequency="2100 Hz"))
    seen = {name: VALUES[name] for name in ("joints.finger_shear_stiffness", "joints.guide_pin_stiffness",
                                            "joints.abutment_radial_stiffness", "joints.piston_shear_stiffness")}
    given = [point for point in points() if point["body"] in ("pad_outer", "caliper")]
    stated = {"joints": {name: TRUE[name] for name in ("finger_stiffness", "abutment_stiffness")}}
    result = model_update(measured, modes, settings=settings(seen, points=given, finer=1.5, **stated))
    apart, spread = off(result, sections)
    assert (abs(apart) < 2 * spread).all() and (abs(apart[:2]) < 0.05).all() and result.clear.sum() >= 6


@pytest.mark.slow
def test_another_brake_is_refused():
    """Pads and caliper of other sizes and joints of other stiffness: nothing settles."""
    other = COARSE | SMALL | {
        "pad": COARSE["pad"] | {"lining_thickness": "6 mm", "backplate_thickness": "8 mm", "angle": "66 deg"},
        "caliper": COARSE["caliper"] | {"finger_thickness": "22 mm", "bridge_outer_radius": "190 mm", "angle": "62 deg",
                                        "young": "110 GPa"},
        "joints": {"guide_pin_stiffness": "6 MN/m", "finger_shear_stiffness": "80 MN/m",
                   "abutment_radial_stiffness": "30 MN/m", "piston_shear_stiffness": "5 MN/m"}}
    with pytest.raises(ConvergenceError, match="the test may be of something else than the model"):
        model_update(*hammered(other, STRUCK, (100.0, 2200.0)), settings=settings())


def test_a_brake_of_much_the_same_shape_is_told_by_what_no_value_mends():
    other = COARSE | SMALL | {"pad": COARSE["pad"] | {"lining_thickness": "8 mm", "backplate_thickness": "7 mm"},
                              "caliper": COARSE["caliper"] | {"finger_thickness": "20 mm", "young": "150 GPa"},
                              "joints": {"guide_pin_stiffness": "14 MN/m", "finger_shear_stiffness": "35 MN/m"}}
    result = model_update(*hammered(other, STRUCK, (100.0, 2200.0)), settings=settings())
    assert "No values of these bring the frequencies of the model within 2" in strange(result)
    assert headline(result)[1] == "warning"


def test_values_of_a_disc_alone_are_handed_on_to_the_brake(tmp_path, lifted):
    """disc_updated.yaml is the base of the case of the brake: its values with their spreads are priors there."""
    points_of_disc = [{"place": f"disc {k}", "position": [f"{x} mm" for x in p]} for k, p in enumerate(POINTS["disc"])]
    document = {"chain": "model_update", "recording": {"files": []}, "model_update": {
        "body": "disc", "values": {"young": {"spread": 0.1}, "density": {"spread": 0.02}}, "points": points_of_disc}}
    product = replace(lifted, body="disc", parameter=np.array(["disc.young", "disc.density"]),
                      unit=np.array(["Pa", "kg/m^3"]), before=np.array([120e9, 7200.0]),
                      before_spread=np.array([0.1, 0.02]), after=np.array([118e9, 7150.0]),
                      after_spread=np.array([0.02, 0.019]), correlation=np.array([[1, 0.95], [0.95, 1]]),
                      mesh_spread=np.zeros(2))
    for name, text in completed(product, cases.CaseText("disc", document)).items():
        (tmp_path / name).write_text(text)
    (tmp_path / "brake.yaml").write_text(yaml.safe_dump({"based_on": "disc_updated.yaml", "model_update": {
        "body": "assembly", "values": VALUES, "points": points()}}))
    given = cases.load(tmp_path / "brake.yaml", stages.CHAINS, stages.load, unread=BEFORE).sections["model_update"]
    brake = cases.load(tmp_path / "disc_brake.yaml", stages.CHAINS, stages.load).sections["structure"]
    assert brake.disc.young == pytest.approx(118e9) and brake.disc.density == pytest.approx(7150)
    assert given.disc.young == pytest.approx(118e9) and given.body == "assembly"
    assert given.values["disc.young"].spread == pytest.approx(0.02)
    assert given.values["disc.density"].correlation == {"disc.young": 0.95} and set(VALUES) < set(given.values)


@pytest.mark.parametrize(("more", "message"), [
    ({"values": {"joints.fingers": {"spread": 0.1}}}, "found joints.fingers"),
    ({"values": {"finger_stiffness": {"spread": 0.1}}}, "found finger_stiffness"),
    ({"values": {}}, "values of bodies and joints that may be off"),
    ({"values": {"joints.mount_stiffness": {"spread": 0.1}}}, "joints that this brake has.*found joints.mount"),
    ({"values": {"pressed.stiffness": {"spread": 0.1}}}, "pads pressed by a force, found pressed.stiffness"),
    ({"points": []}, "points of the test with the bodies that they lie on.*found none"),
    ({"points": [{"place": "p", "position": ["1 mm", "0 mm", "0 mm"]}]}, "one of disc, pad_outer, .*found none"),
    ({"points": [{"place": "p", "position": ["1 mm", "0 mm", "0 mm"], "body": "bracket"}]},
     "one of disc, pad_outer, pad_inner, caliper, found bracket")])
def test_what_the_brake_does_not_have_is_refused_before_anything_is_computed(more, message):
    with pytest.raises(ConfigError, match=message):
        model_update.check({"model_update": settings(**more)})


def test_a_run_without_modes_is_refused():
    test = hammered(COARSE | SMALL, STRUCK, (100.0, 400.0))
    with pytest.raises(ConfigError, match="a run with modes"):
        model_update(test[0], ModalTest(runs={}), settings=settings())
