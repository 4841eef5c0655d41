"""Contact ageing."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from pipeline.physics.virtual_rig.sensor import VELOCITY, Sensor
from tests.effects.benches import slider, steady

VALUES = {"share": 0.1, "speed": 0.5, "length": 0.01}


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.05, 0.3, 2.0])
def test_steady_friction_at_each_speed(speed):
    found = respond(named("contact_ageing").on(slider(), "contact", VALUES), steady(speed=speed))
    np.testing.assert_allclose(found["t"], 0.3 * (1 + 0.1 * np.log(1 + 0.5 / speed)) * 40.0, rtol=1e-6)


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.05, 0.3])
def test_growth_rates_against_speed(speed):
    """(s^2 + c s + k)(s + v / L) - N mu b x / ((1 + x) L) s = 0 with x = v_0 / v."""
    bench, x = named("contact_ageing").on(slider(speed=speed), "contact", VALUES), 0.5 / speed
    driven = 40 * 0.3 * 0.1 * x / (1 + x) / 0.01
    exact = np.roots(np.polyadd(np.polymul([1.0, 2.0, 400.0], [1.0, speed / 0.01]), [0.0, 0.0, -driven, 0.0]))
    found = roots(bench, steady())
    assert max(abs(found - root).min() for root in exact) < 1e-8 * abs(exact).max()


@pytest.mark.exact
def test_a_contact_at_rest_ages_with_the_time():
    """mu (1 + b ln(1 + x)) holds: a block that just came to rest at t = 0 (x = 1) ages as x = 1 + v_0 t / L and slips
    when the ramp of the force gets there."""
    bench = replace(named("contact_ageing").on(slider(speed=0.0), "contact", VALUES), settled=False,
                    channels=(Sensor("v", VELOCITY, "sensor_0"),))
    run = steady(duration=1.0, speed=0.0)
    run = replace(run, inputs={"input_0": 20.0 * run.time, "input_1": -40.0},
                  start=Start(np.array([0.0, -40 / 2e4]), np.zeros(2), np.array([40.0]), np.zeros(1)))
    slips = run.time[np.argmax(abs(respond(bench, run)["v"]) > 1e-6)]
    exact = brentq(lambda t: 20 * t - 40 * 0.3 * (1 + 0.1 * np.log(2 + 0.5 * t / 0.01)), 0.0, 1.0)
    assert slips == pytest.approx(exact, abs=2 / 2000)
