"""Contacts that recede."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Bench, respond
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, NORMAL_FORCE, Sensor
from tests.effects.benches import evolved, slider, steady
from tests.physics.lumps import lumps

WEAR, SPEED, AREA = named("wear"), 2.0, 1e-3
RATE = 4e-9


@pytest.mark.exact
def test_under_a_load_the_mass_follows_its_contact():
    """N stays: y = -N / k - r (N / A) |v| t, after the start has rung down."""
    bench = WEAR.on(slider(Penalty(2e4, 60.0), constant(0.0), SPEED, AREA), "contact", {"rate": RATE})
    run = steady(40.0, 1.0)
    found, late = respond(bench, run), run.time > 0.5
    pace = RATE * 40 / AREA * SPEED
    np.testing.assert_allclose(found["y"][late], (-40 / 2e4 - pace * run.time)[late], atol=1e-3 * pace)
    np.testing.assert_allclose(found["n"][late], 40.0, rtol=1e-5)


def wedged(duration=1.0):
    """A mass held by a spring of 3e3 N/m and set 1 mm deep into a contact of 2e4 N/m; damped so that nothing rings."""
    model = lumps([1.0, 1.0], [[1.0, 0.0], [0.0, 1.0]], [400.0, 3e3], [2.0, 80.0], [[0.0, 1.0]], [[1.0, 0.0]], SPEED)
    model = replace(model, contacts=replace(model.contacts, area=np.array([AREA])))
    channels = (Sensor("x", DISPLACEMENT, "sensor_0"), Sensor("y", DISPLACEMENT, "sensor_1"),
                Sensor("n", NORMAL_FORCE, "contact"))
    return Bench(model, Penalty(2e4, gap=-1e-3), constant(0.0), 1e-4, channels, settled=True), steady(0.0, duration)


@pytest.mark.exact
def test_at_a_fixed_distance_the_pressure_fades_with_the_way():
    """m y'' = N - k_s y - c y', N = k (d - y - h), h' = r N |v| / A: in slow wear N_0 exp(-r k' |v| t / A), k and k_s
    in series k'."""
    base, run = wedged()
    found = respond(WEAR.on(base, "contact", {"rate": RATE * 20}), run)["n"]
    pace, series = 20 * RATE * SPEED / AREA, 1 / (1 / 3e3 + 1 / 2e4)
    force = np.array([-2e4, 0.0, -2e4, 20.0])       # of y, y', h and 1
    y, _, h, _ = evolved([[0, 1, 0, 0], force - [3e3, 80.0, 0, 0], pace * force, np.zeros(4)],
                         [series * 1e-3 / 3e3, 0, 0, 1], run)
    np.testing.assert_allclose(found, 2e4 * (1e-3 - y - h), rtol=2e-5)
    np.testing.assert_allclose(found, series * 1e-3 * np.exp(-pace * series * run.time), rtol=0.025)
    assert found[-1] < 0.7 * found[0]


def test_its_own_motion_leaves_nothing():
    base, run = wedged(0.5)
    bench = WEAR.on(base, "contact", {"rate": RATE * 20})
    seen = respond(bench, run)
    left, missed = (abs(equation_residual(b, run, seen)).max() for b in (bench, base))
    assert left < 0.01 * missed


def test_a_surface_does_not_grow():
    with pytest.raises(ConfigError, match="rate"):
        WEAR.on(slider(), "contact", {"rate": -RATE})
