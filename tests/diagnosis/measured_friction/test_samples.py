"""Coefficients of friction from tables and from strokes."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.measured_friction.samples import joined, of_slides, tabulated
from pipeline.products import MeasuredFriction

RATE, STROKE, PERIOD, LOAD = 200.0, 2e-3, 4.0, 5.0


def table(**given):
    values = {"friction": [0.4, 0.42], "friction_std": [0.0, 0.01], "pressure": [1e6, 2e6], "speed": [1.0, 1.0],
              "distance": [0.0, 1.0], "temperature": [300.0, 400.0]}
    return MeasuredFriction(**{**values, **given})


def strokes(mu=0.3, strokes=6, offset=0.2, build_up=0.2e-3):
    """(load, friction, position) of a triangular motion; friction builds up over ``build_up`` m after a reversal."""
    time = np.arange(round(strokes * PERIOD * RATE) + 1) / RATE
    phase = (time / PERIOD) % 1
    position = STROKE * np.where(phase < 0.5, 2 * phase, 2 - 2 * phase)
    way = np.where(phase < 0.5, 1.0, -1.0)
    gone = np.where(phase < 0.5, position, STROKE - position)
    load = LOAD * (1 + 0.01 * np.sin(time))
    return load, offset + mu * load * way * (1 - 2 * np.exp(-gone / build_up * 3)), position


def test_a_table_is_taken_as_it_is():
    made = joined([tabulated("a", table()), tabulated("b", table())])
    assert made.friction.tolist() == [0.4, 0.42] * 2 and made.run.tolist() == ["a", "a", "b", "b"] and len(made) == 4


@pytest.mark.parametrize("given, message", [
    ({"friction": [0.4, -0.4]}, "run a: friction: expected values above 0, found -0.4 in row 2"),
    ({"friction": [40.0, 42.0]}, "expected coefficients, a few tenths as a rule, found 42"),
    ({"pressure": [1e6, 0.0]}, "run a: pressure")])
def test_what_cannot_be_friction_is_refused(given, message):
    with pytest.raises(ConfigError, match=message):
        tabulated("a", table(**given))


def test_strokes_give_the_coefficient_whatever_the_offset():
    load, friction, position = strokes()
    made = of_slides("s", load, friction, position, RATE, 1e-6, 293.15)
    assert len(made) == 6 and made.friction == pytest.approx(0.3, rel=2e-3)
    assert made.speed == pytest.approx(2 * STROKE / PERIOD, rel=1e-2) and (made.temperature == 293.15).all()
    assert made.pressure == pytest.approx(LOAD / 1e-6, rel=0.02)
    assert np.diff(made.distance) == pytest.approx(2 * STROKE, rel=0.02)
    assert (made.friction_std < 3e-3).all()


def test_missing_samples_and_noise_do_not_matter():
    load, friction, position = strokes()
    random = np.random.default_rng(1)
    friction = friction + 0.02 * random.standard_normal(len(friction))
    position = position + 2e-6 * random.standard_normal(len(position))
    for each in (load, friction, position):
        each[500:520] = np.nan
    made = of_slides("s", load, friction, position, RATE, 1e-6, 293.15)
    assert len(made) >= 5 and made.friction == pytest.approx(0.3, rel=0.01)


def test_a_motion_one_way_and_a_load_of_the_wrong_sign_are_refused():
    load, friction, position = strokes()
    with pytest.raises(ConfigError, match="slides both ways"):
        of_slides("s", load[:300], friction[:300], position[:300], RATE, 1e-6, 293.15)
    with pytest.raises(ConfigError, match="a load above 0"):
        of_slides("s", -load, friction, position, RATE, 1e-6, 293.15)


def test_replaced_fields_keep_their_length():
    made = tabulated("a", table())
    assert len(replace(made, run=np.array(["x", "y"]))) == 2
