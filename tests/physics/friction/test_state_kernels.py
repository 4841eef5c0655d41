"""Steps of friction states against their differential equations."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.physics.friction.dry_friction import (
    DELAYED,
    FACTOR,
    LOAD_KEPT,
    LOAD_SHARE,
    SPEED_KEPT,
    SPEED_SHARE,
    constant,
    kernel,
)
from pipeline.physics.friction.state_kernels import (
    EVOLVING,
    INVERSE,
    PARAMETERS,
    expect,
    factor,
    factor_slope,
    settle,
    source_and_rate,
    state_slopes,
)
from pipeline.physics.friction.state_variables import Evolving, Fade, Film, Healing, Memory, Plateaus, state_kernel

AREA, LOAD, SPEED, DRAWN, STEP = 2e-3, 30.0, 1.5, 9.0, 0.05


def one(state):
    friction = replace(constant(0.3), states=(state,))
    return state_kernel(friction, np.array([AREA])), kernel(friction, 1)


def each(value):
    return np.array([value], float)


@pytest.mark.exact
@pytest.mark.parametrize("state", [Film(0.3, 0.2, 1e4), Fade(0.4, 2e4, 0.1), Healing(0.1, 3.0, 0.2),
                                   Plateaus(0.5, 2e4, 0.1)], ids=lambda s: type(s).__name__)
def test_one_long_step_is_exact_where_nothing_changes(state):
    states, dry = one(state)
    source, rate = source_and_rate(states.kind[0], states.parameter[0], LOAD, AREA, SPEED, DRAWN)
    exact = solve_ivp(lambda t, x: source - rate * x, (0, STEP), [0.7], "DOP853", rtol=1e-12, atol=1e-14).y[0, -1]
    value = np.array([[0.7, 0.0]])
    expect(states, value, dry, each(LOAD), each(-SPEED), each(-DRAWN), 0.0, 0.0, STEP, False)
    assert dry.contact[0, FACTOR] == pytest.approx(factor(states.kind[0], states.parameter[0], exact, 0.0), rel=1e-12)
    settle(states, value, each(LOAD), each(LOAD), each(-SPEED), each(-SPEED), each(-DRAWN), STEP)
    assert value[0, 0] == pytest.approx(exact, rel=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("length", [1e-6, 0.05, 1e3])
def test_memory_of_a_load_that_grows_over_the_step(length):
    """x' = (v / L) (N(t) - x), N from 30 to 36 N; the weights of the step say the same, by its end and by its mean."""
    states, dry = one(Memory(length))
    exact = solve_ivp(lambda t, x: SPEED / length * (LOAD + 6 * t / STEP - x), (0, STEP), [20.0], "Radau", rtol=1e-10,
                      atol=1e-10).y[0, -1]
    value, steady = np.array([[20.0, SPEED]]), each(SPEED)
    for middle, told in ((False, exact), (True, (20.0 + exact) / 2)):
        expect(states, value, dry, each(LOAD), steady, each(DRAWN), 0.0, 0.0, STEP, middle)
        own = dry.contact[0]
        assert own[DELAYED] == 1.0
        assert own[LOAD_KEPT] + own[LOAD_SHARE] * 36.0 == pytest.approx(told, rel=1e-7)
        assert own[SPEED_KEPT] + own[SPEED_SHARE] * SPEED == pytest.approx(SPEED, rel=1e-12)
    settle(states, value, each(LOAD), each(36.0), steady, steady, each(DRAWN), STEP)
    assert value[0, 0] == pytest.approx(exact, rel=1e-7)
    settle(states, value, each(36.0), each(0.0), steady, steady, each(DRAWN), STEP)
    assert value[0, 0] == 0.0


OWN = Evolving((0.5, 0.2, 3e-5, 0.0), (1.0, 0.4, 2e-5, 0.0), INVERSE, 0.3)


@pytest.mark.exact
@pytest.mark.parametrize("state", [Healing(0.1, 3.0, 0.2), Plateaus(0.5, 2e4, 0.1), Film(0.3, 0.2, 1e4), OWN],
                         ids=lambda s: type(s).__name__)
def test_slopes_are_those_of_the_equations(state):
    p, x, small = one(state)[0].parameter[0], 0.8, 1e-6

    def moving(load, speed):
        source, rate = source_and_rate(EVOLVING, p, load, AREA, speed, 0.0)
        return source - rate * x, rate

    (here, leaving), (rate, by_load, by_speed) = moving(LOAD, SPEED), state_slopes(p, x, LOAD, AREA, SPEED)
    assert rate == leaving
    heavier, faster = moving(LOAD + small, SPEED)[0], moving(LOAD, SPEED + small)[0]
    assert ((heavier - here) / small, (faster - here) / small) == pytest.approx((by_load, by_speed), rel=1e-5, abs=1e-8)
    change = (factor(EVOLVING, p, x + small, 0.0) / factor(EVOLVING, p, x, 0.0) - 1) / small
    assert change == pytest.approx(factor_slope(p, x), rel=1e-5)


def test_a_film_without_gain_is_none():
    assert factor(EVOLVING, np.zeros(PARAMETERS), 5.0, 0.0) == 1.0
