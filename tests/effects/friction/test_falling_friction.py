"""Friction that falls with speed."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.sensor import MEASURANDS, Sensor
from tests.effects.benches import rubbing, slider, steady


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.05, 0.3, 2.0])
def test_steady_friction_at_each_speed(speed):
    bench = named("falling_friction").on(slider(), "contact", {"rise": 0.4, "decay_speed": 0.3})
    exact = 0.3 * (1 + 0.4 * np.exp(-speed / 0.3)) * 40.0
    assert respond(bench, steady(speed=speed))["t"][0] == pytest.approx(exact, rel=2e-4)


@pytest.mark.exact
def test_growth_rate_of_a_mass_on_a_belt():
    """The slope -r mu / v_s acts as a negative damper: x grows as exp(-(c + N dmu/dv) t / (2 m))."""
    bench = named("falling_friction").on(slider(), "contact", {"rise": 0.4, "decay_speed": 0.3})
    speed, load = 0.3, 40.0
    rate = -(2.0 - load * 0.3 * 0.4 / 0.3 * np.exp(-1.0)) / 2
    run = steady(load, 3.0, speed)
    x = respond(bench, replace(run, inputs={**run.inputs, "input_0": 0.02 * (run.time < 0.05)}))["x"]
    swing = x - respond(bench, run)["x"]
    turn = round(2 * np.pi / np.sqrt(400 - rate**2) * 2000)
    first, last = (abs(swing[k:k + turn]).max() for k in (500, 500 + 5 * turn))
    assert np.log(last / first) * 2000 / (5 * turn) == pytest.approx(rate, rel=0.03)


@pytest.mark.exact
def test_one_group_of_contacts_alone():
    channels = tuple(Sensor(f"{q} {g}", MEASURANDS[f"{q}_force"], g) for q in ("normal", "friction")
                     for g in ("left", "right"))
    bench = named("falling_friction").on(replace(rubbing(), channels=channels), "left", {"rise": 0.4, "decay_speed": 2})
    found = respond(bench, steady(speed=2.0))
    for group, mu in (("left", 0.3 * (1 + 0.4 * np.exp(-1))), ("right", 0.3)):
        np.testing.assert_allclose(found[f"friction {group}"], mu * found[f"normal {group}"], rtol=1e-3)
