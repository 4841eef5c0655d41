"""States of friction against closed forms, in motions whose slip speed is as good as given."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant, tabulated
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.friction.state_variables import (
    Distance,
    Evolving,
    Fade,
    Film,
    Healing,
    Memory,
    Plateaus,
    Scatter,
    factors,
    started,
    state_kernel,
)
from pipeline.physics.time_stepping.simulate import Hard, History, Penalty, Start, simulate
from pipeline.physics.virtual_rig.response import Run, respond
from tests.effects.benches import RATE, anchored

MU, LOAD, SPEED, AREA = 0.3, 40.0, 2.0, 1e-3
DESCRIPTIONS = [{}, {"description": "elastic", "stiffness": 2e5}]


def slid(state, run=None, **options):
    """(time, T / (mu N), N) of a heavy mass with a state of friction."""
    run = run or Run("steady", 1.0, RATE, {"input_1": -LOAD})
    found = respond(anchored(replace(constant(MU, **options), states=(state,))), run)
    return run.time[2:], found["t"][2:] / (MU * found["n"][2:]), found["n"][2:]


@pytest.mark.exact
@pytest.mark.parametrize("options", DESCRIPTIONS, ids=["rigid", "elastic"])
@pytest.mark.parametrize("state, exact", [
    (Film(0.4, 0.5, 2e4), lambda t: 1 + 0.4 * LOAD / AREA / 2e4 * (1 - np.exp(-SPEED * t / 0.5))),
    (Healing(0.1, 5.0, 1e-2), lambda t: 1 + 0.1 * np.log(1 + 5.0 / SPEED) + 0 * t),
    (Plateaus(0.5, 4e4, 0.1), lambda t: 1.5 / (1 + 0.5 * LOAD * SPEED / AREA / 4e4) + 0 * t),
    (Scatter(0.2, 3.0, 0.4), lambda t: 1 + 0.2 * np.cos(3 * SPEED * t - 0.4)),
    (Memory(0.1), lambda t: 1 + 0 * t)], ids=["film", "healing", "plateaus", "scatter", "memory"])
def test_friction_in_steady_sliding(state, exact, options):
    time, ratio, _ = slid(state, **options)
    np.testing.assert_allclose(ratio, exact(time), rtol=2e-6)


@pytest.mark.exact
@pytest.mark.parametrize("options", DESCRIPTIONS, ids=["rigid", "elastic"])
def test_heat_fades_friction(options):
    """tau x' = c / (1 + d x) - x with c = mu N v / (A q): (1 + d x) dx / (c - x - d x^2) by partial fractions."""
    drop, heat, tau = 0.5, 2e4, 0.2
    time, ratio, _ = slid(Fade(drop, heat, tau), **options)
    c = MU * LOAD * SPEED / (AREA * heat)
    high, low = ((-1 + s * np.sqrt(1 + 4 * drop * c)) / (2 * drop) for s in (1, -1))
    x = (1 / ratio - 1) / drop
    weight = [(1 + drop * r) / (drop * (high - low)) for r in (high, low)]
    passed = -weight[0] * np.log(1 - x / high) + weight[1] * np.log(1 - x / low)
    early = time < 4 * tau
    np.testing.assert_allclose(tau * passed[early], time[early], atol=2e-6)


@pytest.mark.exact
@pytest.mark.parametrize("options", DESCRIPTIONS, ids=["rigid", "elastic"])
def test_friction_follows_the_load_over_a_length(options):
    """N = N0 + dN sin(w t): T / mu lags by the phase atan(w tau) and is smaller by cos of it, tau = L / v."""
    run = Run("swinging", 2.0, RATE)
    angular, length = 2 * np.pi * 20.0, 0.02
    run = replace(run, inputs={"input_1": -LOAD - 4 * np.sin(angular * run.time)})
    time, ratio, normal = slid(Memory(length), run, **options)
    late = time > 1.0
    turn = np.exp(-1j * angular * time[late])
    told = ((ratio * normal)[late] * turn).mean() / (normal[late] * turn).mean()
    assert told == pytest.approx(1 / (1 + 1j * angular * length / SPEED), rel=1e-4)


@pytest.mark.exact
def test_friction_follows_the_speed_over_a_length():
    """v steps from 2 to 1 m/s: the speed that friction hears is 1 + exp(-v t / L)."""
    friction = replace(tabulated([0.0, 4.0], [0.1, 0.5]), states=(Memory(0.05),))
    run = Run("slowing", 0.2, RATE, {"input_1": -LOAD}, drive=SPEED)
    run = replace(run, drive=np.where(run.time < 0.01, 2.0, 1.0))
    found = respond(anchored(friction), run)
    after = run.time > 0.012
    heard = (found["t"] / found["n"] - 0.1) / 0.1
    slope = np.polyfit(run.time[after], np.log(heard[after] - 1.0), 1)[0]
    assert slope == pytest.approx(-1.0 / 0.05, rel=1e-3)


@pytest.mark.exact
def test_friction_over_the_distance_slid():
    law = FrictionLaw([0.0], [0.0], [0.0, 10.0], [[[0.2, 0.7]]])
    friction = replace(constant(MU), law=law, states=(Distance(),), distance=0.5)
    run = Run("steady", 1.0, RATE, {"input_1": -LOAD})
    found = respond(anchored(friction), run)
    np.testing.assert_allclose(found["t"][2:] / found["n"][2:], 0.2 + 0.05 * (0.5 + SPEED * run.time[2:]), rtol=1e-6)


@pytest.mark.exact
@pytest.mark.parametrize("state", [Memory(5e-3), Healing(0.2, 3.0, 5e-3), Fade(0.5, 2e4, 0.02),
                                   Plateaus(0.5, 4e4, 0.02)], ids=lambda s: type(s).__name__)
def test_the_step_is_of_second_order(state):
    """Errors of the friction that a swinging load gives a light mass fall by four when the step is halved."""
    def end(step):
        model = anchored(constant(MU), 1.0).model
        start = np.array([0.0, -LOAD / 1e6])
        motion = simulate(model, Penalty(1e6), replace(constant(MU), states=(state,)), step=step, duration=0.064,
                          inputs=History([[0.0, -LOAD], [0.0, -1.5 * LOAD]], 0.064), start=Start(start, np.zeros(2)))
        return motion.displacement[0, -1]

    one, two, four = (end(step) for step in (1.6e-4, 8e-5, 4e-5))
    assert (one - two) / (two - four) == pytest.approx(4.0, rel=0.15)


def test_where_states_begin():
    states = state_kernel(replace(constant(MU), states=(Memory(1.0), Film(1.0, 1.0, 1.0), Healing(1.0, 3.0, 1.0))),
                          np.ones(1))
    np.testing.assert_array_equal(started(states, [5.0], [-2.0]), [[5.0, 2.0], [0.0, 0.0], [1.5, 0.0]])
    assert started(states, [5.0], [0.0])[2, 0] == 1.0
    assert factors(states, np.ones((3, 2)), 0.0) == pytest.approx([2 * (1 + np.log(2))])


def test_memory_of_impulses_and_endless_values_are_refused():
    bench = anchored(replace(constant(MU), states=(Memory(0.1),)))
    run = Run("steady", 0.1, RATE, {"input_1": -LOAD})
    with pytest.raises(ConfigError, match="yield"):
        respond(replace(bench, law=Hard(), settled=False), run)
    with pytest.raises(ConfigError, match="finite"):
        respond(replace(bench, friction=replace(bench.friction, states=(Memory(np.inf),))), run)


def test_a_state_under_heat_does_not_settle():
    with pytest.raises(ConfigError, match="no heat where a state settles"):
        Evolving((0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0))
