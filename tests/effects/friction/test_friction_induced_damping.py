"""Friction-induced damping."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Penalty, Start
from pipeline.physics.virtual_rig.response import Bench, respond
from pipeline.physics.virtual_rig.roots import roots
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, ELEMENT_FORCE, VELOCITY, Sensor
from tests.effects.benches import slider, steady
from tests.physics.lumps import lumps


def sideways(share, speed=2.0):
    """The slider, free to swing sideways as well on 900 N/m; pressed by input_1, moved sideways by input_2."""
    model = lumps([1.0, 1.0, 1.0], [[1, 0, 0], [0, 0, 1]], [400.0, 900.0], [2.0, 0.5], [[0, 1, 0]], [[1, 0, 0]], speed)
    contacts = replace(model.contacts, lateral=np.array([[0.0, 0.0, 1.0]]))
    bench = Bench(replace(model, contacts=contacts), Penalty(2e4), constant(0.3), 1e-4,
                  (Sensor("z", DISPLACEMENT, "sensor_2"),), settled=True)
    return named("friction_induced_damping").on(bench, "contact", {"share": share})


@pytest.mark.exact
@pytest.mark.parametrize("speed, load", [(2.0, 40.0), (0.5, 40.0), (2.0, 80.0)])
def test_roots_are_damped_by_load_over_speed(speed, load):
    exact = np.roots([1.0, 0.5 + 0.3 * load / speed, 900.0])
    found = roots(sideways(1.0, speed), steady(load))
    assert abs(found[:, None] - exact).min(axis=0).max() < 1e-8


@pytest.mark.exact
def test_a_simulated_swing_decays_so():
    """z = a exp(-d t) cos(w t + phi): the step answer to a small force, by its root."""
    run = steady(duration=0.5)
    run = replace(run, inputs={**run.inputs, "input_2": np.full(run.samples, 0.01)})
    start = np.array([0.3 * 40 / 400, -40 / 2e4, 0.0])
    run = replace(run, start=Start(start, np.zeros(3)))
    root = np.roots([1.0, 0.5 + 0.3 * 40 / 2.0, 900.0])[0]
    rest = 0.01 / 900
    weight = -rest * np.conj(root) / (np.conj(root) - root)
    exact = rest + 2 * (weight * np.exp(root * run.time)).real
    np.testing.assert_allclose(respond(sideways(1.0), run)["z"], exact, atol=2e-3 * rest)


@pytest.mark.exact
def test_the_force_never_exceeds_friction_and_takes_energy_out():
    run = steady(duration=0.5)
    run = replace(run, inputs={**run.inputs, "input_2": 60 * np.sin(30 * run.time)})
    bench = sideways(1.0)
    seen = (Sensor("f", ELEMENT_FORCE, "friction_induced_damping 0"), Sensor("v", VELOCITY, "sensor_2"))
    found = respond(replace(bench, channels=seen), run)
    assert abs(found["f"]).max() <= 0.3 * 40 * 1.05 and abs(found["v"]).max() > 2.0
    assert np.all(found["f"] * found["v"] >= 0)


def test_contacts_that_never_move_sideways_are_no_place_of_it():
    assert named("friction_induced_damping").locations(slider()) == ()
    with pytest.raises(ConfigError, match="friction_induced_damping: location: expected one of none here"):
        named("friction_induced_damping").on(slider(), "contact", {"share": 1.0})
