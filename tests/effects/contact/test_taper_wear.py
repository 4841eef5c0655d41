"""Contacts that wear more at one end."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Penalty
from pipeline.physics.virtual_rig.response import Bench, respond
from pipeline.physics.virtual_rig.sensor import NORMAL_FORCE, Sensor
from tests.effects.benches import at_angles, evolved, rubbing, steady
from tests.physics.lumps import lumps

TAPER, SPEED, RATE = named("taper_wear"), 2.0, 4e-8


def pair():
    """A mass that does not tilt, on two contacts a quarter of a turn apart, damped."""
    model = lumps([1.0, 1.0], [[1, 0], [0, 1]], [400.0, 0.0], [2.0, 200.0], [[0, 1], [0, 1]], [[1, 0], [1, 0]], SPEED)
    channels = (Sensor("first", NORMAL_FORCE, "first"), Sensor("last", NORMAL_FORCE, "last"))
    return Bench(at_angles(model, 3.0, 3.0 + np.pi / 2, area=1e-3), Penalty(1e4), constant(0.0), 1e-4, channels,
                 {"first": (0,), "last": (1,)}, settled=True)


@pytest.mark.exact
@pytest.mark.parametrize("sign, worn", [(1, "first"), (-1, "last")])
def test_the_load_goes_over_to_the_end_that_does_not_wear(sign, worn):
    """m y'' = N_1 + N_2 - P - c y', N_1 = -k (y + h), N_2 = -k y, h' = 2 r N_1 |v| / A: in slow wear N_1 is
    P / 2 exp(-r k |v| t / A)."""
    run, kept = steady(40.0, 1.0), "last" if worn == "first" else "first"
    found = respond(TAPER.on(pair(), "contact", {"rate": sign * RATE}), run)
    pace = 2 * RATE * SPEED / 1e-3
    y, _, h, _ = evolved([[0, 1, 0, 0], [-2e4, -200, -1e4, -40], [-1e4 * pace, 0, -1e4 * pace, 0], np.zeros(4)],
                         [-2e-3, 0, 0, 1], run)
    np.testing.assert_allclose(found[worn], -1e4 * (y + h), rtol=2e-5)
    np.testing.assert_allclose(found[kept], -1e4 * y, rtol=2e-5)
    np.testing.assert_allclose(found[worn], 20 * np.exp(-1e4 * pace / 2 * run.time), rtol=0.01)


@pytest.mark.exact
def test_rates_are_linear_along_the_sliding_and_never_negative():
    changed = TAPER.on(pair(), "contact", {"rate": -RATE}).model.contacts.wear
    np.testing.assert_allclose(changed * 1e-3, [0.0, 2 * RATE], atol=1e-24)


def test_a_single_contact_has_no_ends():
    assert TAPER.locations(rubbing()) == ("contact",)
    with pytest.raises(ConfigError, match="location"):
        TAPER.on(rubbing(), "left", {"rate": RATE})
