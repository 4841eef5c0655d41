"""The residual of the equation of motion on exact and on simulated motions."""

from dataclasses import replace

import numpy as np
import pytest
import scipy
from scipy.signal import decimate

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.elements import Element, Polynomial, Power, iwan
from pipeline.physics.time_stepping.simulate import Hard, Penalty
from pipeline.physics.virtual_rig.force_residual import (
    Resting,
    applied_force,
    below,
    equation_residual,
    held_at_rest,
    thinned,
)
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, Sensor
from tests.physics.lumps import belt, lumps

CHANNELS = (Sensor("one", DISPLACEMENT, "sensor_0", gain=2.0, offset=0.1),
            Sensor("two", DISPLACEMENT, "sensor_1"))
RATE = 2000.0


def pair(*laws):
    model = lumps([1.0, 2.0], [[1, 0], [1, -1]], [4e3, 9e3], [3.0, 5.0])
    elements = tuple(Element(f"e{k}", np.array([1.0, -1.0]), law) for k, law in enumerate(laws))
    return Bench(replace(model, elements=elements), Hard(), constant(0.0), 1e-4, CHANNELS)


def shaken(seconds=2.0):
    run = Run("shaken", seconds, RATE)
    return replace(run, inputs={"input_0": 30 * np.sin(47 * run.time) + 20 * np.sin(81 * run.time)})


@pytest.mark.exact
def test_nothing_is_left_of_the_model_that_made_the_motion():
    for laws in ((), (Polynomial(cubic=4e8), Power(20.0, 2.0)), (iwan(4e3, 4.0, -0.2, elastic=True),)):
        bench, run = pair(*laws), shaken()
        left = equation_residual(bench, run, respond(bench, run))
        assert abs(left[:, 5:-5]).max() < 0.01 * 50


@pytest.mark.exact
def test_what_is_left_is_the_force_of_the_missing_element():
    truth, run = pair(Polynomial(cubic=4e8)), shaken()
    measured = respond(truth, run)
    between = (measured["one"] - 0.1) / 2 - measured["two"]
    left = equation_residual(pair(), run, measured)
    force = -4e8 * between**3
    np.testing.assert_allclose(left[:, 5:-5], np.outer([1, -1], force[5:-5]), atol=0.01 * 50)
    assert abs(force).max() > 10


@pytest.mark.exact
def test_the_residual_is_linear_in_the_parameters():
    run, measured = shaken(), respond(pair(Polynomial(cubic=4e8)), shaken())
    options = {"corner": 200.0, "decimation": 5, "trim": 20}
    none, one, both = (equation_residual(pair(Polynomial(cubic=k), Power(c)), run, measured, **options)
                       for k, c in ((0, 0), (1e8, 0), (1e8, 7.0)))
    other = equation_residual(pair(Polynomial(cubic=0.0), Power(7.0)), run, measured, **options)
    np.testing.assert_allclose(both - none, (one - none) + (other - none), atol=1e-9)
    assert none.shape == (2, len(np.arange(4001 - 40)[::5]))


@pytest.mark.exact
def test_a_linear_model_closes_with_few_samples_a_period_and_a_corner_within_the_motion():
    """m x'' + k x = f in closed form, two tones of 9 and 5 samples a period, the corner between them."""
    model, run = lumps([2.0], [[1.0]], [4e3], [0.0]), Run("tones", 8.0, 200.0)
    bench = Bench(model, Hard(), constant(0.0), 1e-4, (Sensor("x", DISPLACEMENT, "sensor_0"),))
    tones = [(2 * np.pi * 200 / samples, 1e-3) for samples in (9.0, 5.0)]
    motion = sum(size * np.sin(w * run.time) for w, size in tones)
    force = sum(size * (4e3 - 2.0 * w**2) * np.sin(w * run.time) for w, size in tones)
    left = equation_residual(bench, replace(run, inputs={"input_0": force}), {"x": motion}, corner=30.0, trim=60)
    heavier = replace(bench, model=replace(model, mass=1.01 * model.mass))
    off = equation_residual(heavier, replace(run, inputs={"input_0": force}), {"x": motion}, corner=30.0, trim=60)
    assert left.std() < 0.1 * off.std(), "a percent of the mass is told"


@pytest.mark.exact
def test_filtering_takes_noise_off_but_not_the_force():
    run, truth = shaken(), pair(Polynomial(cubic=4e8))
    noisy = {n: v + 1e-6 * np.random.default_rng(3).standard_normal(len(v)) for n, v in respond(truth, run).items()}
    rough, smooth = (equation_residual(truth, run, noisy, corner=c, trim=100).std() for c in (None, 150.0))
    assert smooth < 0.1 * rough


@pytest.mark.exact
@pytest.mark.parametrize("law", [Penalty(1e4, 3.0)])
def test_contacts_and_friction_joints_belong_to_the_equation(law):
    bench = Bench(belt(400.0, 1.0), law, constant(0.3), 1e-4, CHANNELS)
    run = Run("pressed", 1.0, RATE, conditions={"input_1": -20.0, "speed": 5.0})
    run = replace(run, inputs={"input_0": 3 * np.sin(30 * run.time)})
    left = equation_residual(bench, run, respond(bench, run))
    assert abs(left[:, 200:-5]).max() < 0.02 * 20
    with pytest.raises(ConfigError, match="yields"):
        equation_residual(replace(bench, law=Hard()), run, respond(bench, run))


@pytest.mark.exact
def test_a_held_force_is_balanced_exactly_on_a_free_mass():
    """Second differences of exact parabolas between the samples are the mean of the steps before and after."""
    bench = Bench(lumps([2.0]), Hard(), constant(0.0), 1e-3, (Sensor("one", DISPLACEMENT, "sensor_0"),))
    run = Run("held", 1.0, 50.0, held=("input_0",))
    run = replace(run, inputs={"input_0": np.random.default_rng(4).standard_normal(run.samples)})
    left = equation_residual(bench, run, respond(bench, run))
    assert abs(left[0, 1:-1]).max() < 1e-9


def test_too_few_channels_and_an_impossible_corner_are_refused():
    bench, run = pair(), shaken(0.1)
    measured = respond(bench, run)
    with pytest.raises(ConfigError, match="all 2 coordinates"):
        equation_residual(bench, run, {"one": measured["one"]})
    with pytest.raises(ConfigError, match="corner"):
        equation_residual(bench, run, measured, corner=RATE)


@pytest.mark.exact
def test_samples_are_thinned_out_as_scipy_does():
    values = np.random.default_rng(5).standard_normal((2, 900))
    np.testing.assert_allclose(thinned(values, 10, 50), decimate(values[:, 50:-50], 10, axis=1, zero_phase=True),
                               atol=1e-10)
    assert thinned(values, 1, 0) is not values and np.array_equal(thinned(values, 1, 0), values)


@pytest.mark.exact
def test_filters_run_forth_and_back_are_those_of_scipy():
    values, run = np.random.default_rng(3).standard_normal((2, 300)) + 2.0, Run("noise", 299 / RATE, RATE)
    sections = scipy.signal.butter(4, 2 * 150 / RATE, output="sos")
    np.testing.assert_allclose(below(run, values, 150.0), scipy.signal.sosfiltfilt(sections, values, axis=1),
                               atol=1e-12)


@pytest.mark.exact
def test_without_any_motion_what_is_left_is_the_applied_force():
    run = shaken()
    still = {name: np.zeros(run.samples) for name in ("one", "two")}
    still["one"] = still["one"] + 0.1
    np.testing.assert_allclose(equation_residual(pair(), run, still), -applied_force(pair(), run), atol=1e-9)


@pytest.mark.exact
def test_friction_at_rest_takes_what_it_can_hold():
    row, share = np.array([1.0, -1.0]), np.array([1.0, 1.0, 0.0])
    left, taken = held_at_rest(np.array([[3.0, -9.0, 3.0], [-3.0, 9.0, -3.0]]), [Resting(row, share, 5.0, 4.0)],
                               np.zeros(2))
    np.testing.assert_allclose(left, [[0.0, -4.0, 3.0], [0.0, 4.0, -3.0]])
    np.testing.assert_allclose(taken, [[0.5, 0.5, 0.0]] * 2)


@pytest.mark.parametrize("force", [0.1, 0.3, 1.0, 3.0, 10.0])
def test_friction_at_rest_explains_no_noise(force):
    """However large, its chi^2 where noise alone is seen is no smaller than without it."""
    noise = 0.2 * np.random.default_rng(1).standard_normal((1, 20000))
    left, taken = held_at_rest(noise, [Resting(np.ones(1), np.ones(20000), 0.2 * force, 0.2 * force)], np.array([0.2]))
    assert np.mean(left**2 + taken * 0.2**2) > 0.995 * np.mean(noise**2)


def test_a_run_shorter_than_the_ends_of_the_filters_is_refused_in_a_sentence():
    with pytest.raises(ConfigError, match="as many samples as the filters need at its ends, found 20 samples"):
        thinned(np.zeros((1, 20)), 4, 0)
