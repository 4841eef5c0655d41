"""Typical quantities at locations of a bench."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects.typical import (
    CHANNEL,
    CHANNEL_PAIR,
    CONTACT,
    CONTACT_ROW,
    CONTACTS,
    DOUBLET,
    INPUT,
    JOINT,
    POINT,
    PRESSED,
    Typical,
    locations,
    typical,
)
from pipeline.physics.time_stepping.elements import Element, Wave
from pipeline.physics.time_stepping.simulate import Hard, Penalty, Start
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import RATE, let_go, pressed, rubbing, slider, sprung, steady


@pytest.mark.exact
def test_sizes_of_a_swinging_mass():
    found = typical(JOINT, sprung(damping=0.0), "joint_0", (let_go(0.01), let_go(0.02)))
    assert (found.stiffness, found.mass, found.interval, found.time) == (400.0, pytest.approx(1.0), 1 / RATE, 0.5)
    assert found.length == pytest.approx(0.02, rel=1e-3) and found.speed == pytest.approx(0.4, rel=1e-3)
    assert found.force == pytest.approx(8.0, rel=1e-3)
    assert typical(POINT, sprung(damping=0.0), "sensor_0", (let_go(0.02),)).stiffness == 400.0


@pytest.mark.exact
def test_the_force_at_a_joint_is_the_largest_on_what_it_moves():
    """A wall of which nothing is assumed carries nothing: what rubs there is as large as what the spring carries."""
    bench, run = sprung(damping=0.0), let_go(0.02)
    model = bench.model
    joints = replace(model.joints, name=(*model.joints.name, "wall"), rows=np.vstack((model.joints.rows, [[1.0]])),
                     stiffness=np.append(model.joints.stiffness, 0.0), damping=np.append(model.joints.damping, 0.0))
    walled = replace(bench, model=replace(model, joints=joints, input_name=("push",), input_rows=np.array([[0.5]])))
    assert typical(JOINT, walled, "wall", (run,)).force == pytest.approx(8.0, rel=1e-3)
    pushed = typical(JOINT, walled, "wall", (replace(run, inputs={"push": 100.0}),))
    assert (pushed.force, pushed.scaled(0.1).force) == (pytest.approx(92.0, rel=1e-3), pytest.approx(50.0))
    heavy = walled.with_elements(Element("weight", np.array([1.0]), Wave(1.0, amplitude=-60.0)))
    assert typical(JOINT, heavy, "wall", (run,)).pushed == pytest.approx(60.0), "a weight is a force as any other"


@pytest.mark.exact
def test_sizes_of_a_contact():
    found = typical(CONTACT, slider(), "contact", (steady(speed=-3.0),))
    assert (found.force, found.speed, found.stiffness) == (pytest.approx(40.0), 3.0, 2e4)
    assert found.pressure == pytest.approx(40.0 / 1e-3) and found.length == pytest.approx(2e-3)


def test_a_contact_past_a_drive_at_rest_slides_as_fast_as_it_moves():
    released = replace(steady(speed=0.0), start=Start(np.array([0.0, 0.0]), np.array([0.2, 0.0])))
    found = typical(CONTACT, slider(), "contact", (released,))
    assert 0.05 < found.speed <= 0.2


def test_a_contact_that_never_closes_has_the_force_of_its_motion():
    moved = replace(steady(0.0, speed=0.0), start=Start(np.zeros(2), np.array([0.0, 0.2])))
    found = typical(CONTACT, slider(Penalty(2e4, gap=1.0), speed=0.0), "contact", (moved,))
    assert found.force == 2e4 * found.length > 0


@pytest.mark.exact
def test_sizes_along_an_input_and_of_a_mode():
    found = typical(INPUT, slider(), "input_1", (steady(30.0), steady(50.0)))
    assert (found.force, found.stiffness, found.mass) == (50.0, 0.0, pytest.approx(1.0))
    found = typical(DOUBLET, rubbing(), "tilt", (pressed(),))
    assert (found.stiffness, found.damping, found.mass) == pytest.approx((500.0, 5.0, 1.0), rel=1e-12)


@pytest.mark.exact
def test_the_time_scale_of_a_location():
    assert Typical(mass=2.0, stiffness=50.0).period == pytest.approx(0.2)
    assert Typical(stiffness=0.0, time=3.0).period == 3.0
    assert Typical(stiffness=50.0, force=3.0).holding == 50.0
    assert Typical(stiffness=0.0, force=3.0, length=0.1).holding == pytest.approx(30.0)


def test_what_a_channel_shows():
    assert typical(CHANNEL, sprung(), "v", (let_go(0.02),)).shown == pytest.approx(0.4, rel=0.02)


def test_places_of_each_kind():
    bench = rubbing()
    assert locations(JOINT, bench) == ("joint_0", "joint_1", "joint_2")
    assert locations(CONTACTS, bench) == ("contact",)
    assert locations(INPUT, bench) == ("input_0", "input_1", "input_2")
    assert locations(DOUBLET, bench) == ("tilt",) and locations(DOUBLET, sprung()) == ()
    assert locations(CONTACT_ROW, bench) == ("contact",)
    assert locations(CONTACT, bench) == ("contact", "left", "right") and locations(CONTACT, sprung()) == ()
    assert np.all(np.isin(("x", "y"), locations(CHANNEL, bench)))
    with pytest.raises(ConfigError, match="one nominal run"):
        typical(JOINT, bench, "joint_0", ())


def test_what_cannot_open_is_no_pressed_contact():
    """Friction joints have friction, whose way is that along the sliding, but no gap, waviness or normal law."""
    bench = slider()
    fixed = replace(bench.model.contacts, normal=np.zeros((1, 2)), preload=np.array([40.0]))
    held = replace(bench, model=replace(bench.model, contacts=fixed), law=Hard(), settled=False)
    assert locations(PRESSED, bench) == locations(CONTACT, held) == ("contact",) and locations(PRESSED, held) == ()
    run = replace(steady(), inputs={"input_0": 8.0})
    assert typical(CONTACTS, held, "contact", (run,)).length == respond(held, run)["x"].max() > 0


def test_pairs_of_channels_are_of_one_unit():
    assert locations(CHANNEL_PAIR, sprung()) == () and "x and turn" in locations(CHANNEL_PAIR, rubbing())
    assert typical(CHANNEL_PAIR, rubbing(), "x and y", (let_go(0.02),)).time == 0.5


def test_nothing_turns_where_no_contact_slides_and_no_run_tells_a_speed():
    """The speed that a bench has by default drives nothing on a mass, a spring and a damper."""
    still, run = sprung(), let_go(0.01)
    still = replace(still, model=still.model.at_speed(3.0))
    assert typical("joint", still, "joint_0", [run]).drive == 0.0
    assert typical("joint", still, "joint_0", [replace(run, conditions={"speed": 6.0})]).drive == 6.0
    assert typical("joint", still, "joint_0", [replace(run, drive=5.0)]).drive == 5.0
