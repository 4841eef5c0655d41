"""Start states: the exact solution of a linear decay gives them back from any channel, with deviations that hold."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.diagnosis.signals.start_states import begun, estimated, held, moves_freely, start_parameters, started
from pipeline.inference.fitting.calibration import recalibrate
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Hypothesis, operating_points
from pipeline.inference.rules import DEFAULTS
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard, Start
from tests.diagnosis import small_rig
from tests.diagnosis.decays import DAMPING, MASS, RATE, STIFFNESS, UNITS, problem, recording
from tests.physics.lumps import belt, lumps

START = (0.05, -1.1)


def exact(start, duration=2.0, rate=RATE):
    """(displacement, velocity, acceleration) (n,) of the linear decay, in closed form."""
    time = np.arange(round(duration * rate) + 1) / rate
    decay = DAMPING / (2 * MASS)
    root = -decay + 1j * np.sqrt(STIFFNESS / MASS - decay**2)
    wave = (start[0] + (start[0] * root.real - start[1]) * 1j / root.imag) * np.exp(root * time)
    return tuple(np.real(wave * root**k) for k in range(3))


def rig(motion, quantity, **bench):
    """(Bench of the true values, {name: Recorded}, section) of noiseless recordings of {run: motion}."""
    section = small_rig.laid_out(channels={"x": {"quantity": quantity, "source": "block"}}, inputs={}, step="0.2 ms",
                                 corrections={"joints.mount.stiffness": f"{STIFFNESS} N/m",
                                              "joints.mount.damping": f"{DAMPING} N s/m"}, **bench)
    given, _ = recording(motion, quantity, noise=0.0)
    return benches.built(small_rig.model(), section), recorded(given, section), section


@pytest.mark.exact
@pytest.mark.parametrize("quantity", UNITS)
def test_a_linear_decay_gives_back_its_start_from_any_channel(quantity):
    bench, runs, section = rig({"a": exact(START)}, quantity)
    start = started(bench, runs, section)["a"].run.start
    error = 2e-5 if quantity == "acceleration" else 1e-6         # the rig differentiates velocities over its steps
    np.testing.assert_allclose([start.displacement[0], start.velocity[0]], START, rtol=error)


@pytest.mark.exact
@pytest.mark.parametrize("quantity", [
    "acceleration", *(pytest.param(each, marks=pytest.mark.slow) for each in ("displacement", "velocity"))])
def test_its_stated_deviations_hold_in_95_of_100_draws(quantity):
    """Stiffness and damping are unknown as well; 200 draws of noise, two numbers each: 95.4 % expected, +- 1.0 %."""
    clean, within = {"a": exact(START), "last": exact((0.0, 1.0))}, []
    whole = problem(clean, quantity, weighed=["cubic_stiffness"])
    run, = whole.problem.training
    silent, std = recording(clean, quantity, noise=0.0)[0].runs["a"].channels["x"].samples, whole.budget["a"].std[0]
    names = [p.name for p in whole.problem.nominal.parameters if p.run == "a"]
    null = recalibrate(whole.problem, whole.budget, DEFAULTS.calibration).null
    for seed in range(200):
        samples = silent + std * np.random.default_rng(seed).standard_normal(len(silent))
        drawn = replace(whole.problem, runs=(replace(run, samples=samples[None]), *whole.problem.held_out))
        begin = linearised(drawn, null.noises, null.hypothesis, null.latent, drawn.training)
        fit = recalibrate(drawn, whole.budget, DEFAULTS.calibration, begin).null
        spread = fit.spread()
        within += [abs(fit.values[name] - true) < 2 * spread[name] for name, true in zip(names, START, strict=True)]
    assert 0.93 <= np.mean(within) <= 0.97, np.mean(within)


def test_a_start_is_as_uncertain_as_the_recording_moves_beyond_its_estimate():
    """The bench of the true values explains all of its own decay, and hardly any of one four times as stiff."""
    bench, runs, section = rig({"a": exact(START)}, "velocity")
    own = started(bench, runs, section)["a"]
    stiff = replace(bench, model=replace(bench.model, joints=replace(
        bench.model.joints, stiffness=bench.model.joints.stiffness / 4)))
    other = estimated(stiff, runs["a"])
    energy = abs(own.run.start.velocity[0]) ** 2 + STIFFNESS / MASS * own.run.start.displacement[0] ** 2
    assert own.unknown.velocity[0] == pytest.approx(np.sqrt(energy), rel=0.02)
    kinetic = abs(other.run.start.velocity[0]) ** 2 + STIFFNESS / 4 / MASS * other.run.start.displacement[0] ** 2
    assert other.unknown.velocity[0] > 1.5 * np.sqrt(kinetic)


def test_starts_are_fitted_where_a_run_moves_by_itself():
    bench, runs, section = rig({"a": exact(START)}, "velocity")
    assert moves_freely(bench, runs["a"]) and started(bench, runs, section)["a"].unknown is not None
    for given in ("rest", "fitted"):
        stated = started(bench, runs, section.model_copy(update={"start": given}))["a"]
        assert (stated.run.start is None) == (given == "rest")
    assert started(bench, runs, section.model_copy(update={"measured_start": True}))["a"].run.start is not None
    with pytest.raises(ConfigError, match=r"bench.start: expected fitted, or no measured_start"):
        started(bench, runs, section.model_copy(update={"start": "rest", "measured_start": True}))
    shaken = recorded(small_rig.recording(), small_rig.laid_out())
    driven = benches.built(small_rig.model(), small_rig.laid_out())
    assert started(driven, shaken, small_rig.laid_out())["level_1"] is shaken["level_1"], "a shaken rig starts at rest"


@pytest.mark.exact
def test_a_forced_run_may_begin_in_motion():
    section = small_rig.laid_out(start="fitted")
    bench = benches.built(small_rig.model(), section)
    one = recorded(small_rig.recording(noise=0.0), section)["level_1"]
    whole, first = one.samples[0], 300
    later = replace(one, run=replace(one.run, duration=(len(whole) - 1 - first) / RATE200, inputs={
        "shaker": one.run.inputs["shaker"][first:]}), samples=one.samples[:, first:], valid=one.valid[:, first:])
    begun_run = started(bench, {"level_1": later}, section)["level_1"].run
    np.testing.assert_allclose(shown(bench, begun_run, ("x",)), later.samples, atol=1e-9 * abs(whole).max())


RATE200 = small_rig.RATE


def test_a_start_that_cannot_be_estimated_is_refused_in_one_sentence():
    bench, runs, section = rig({"a": exact(START, duration=0.25)}, "velocity")
    with pytest.raises(ConfigError, match=r"run a: start: expected a run of at least one period, 0\.31 s.*found 0\.25 s"
                                          r".*state bench.start: rest"):
        started(bench, runs, section)
    bench, runs, section = rig({"a": tuple(0 * q for q in exact(START))}, "velocity", start="fitted")
    with pytest.raises(ConfigError, match=r"run a: start: expected samples of a motion within the first period"):
        started(bench, runs, section)
    alone = replace(bench, model=lumps([1.0, 1.0], [[1.0, 0.0], [0.0, 1.0]], [400.0, 500.0], [1.0, 1.0]))
    seen = replace(alone, channels=(replace(bench.channels[0], source="sensor_0"),))
    one = rig({"a": exact(START)}, "velocity")[1]["a"]
    with pytest.raises(ConfigError, match=r"how all 2 coordinates began.*found 2 of 4 displacements and velocities"):
        estimated(seen, one)


def test_parameters_belong_to_their_run_and_make_its_start():
    bench, runs, section = rig({"a": exact(START), "b": exact((0.01, 0.5))}, "velocity")
    given = started(bench, runs, section)
    own = [p for record in given.values() for p in start_parameters(bench, record, True)]
    assert [p.run for p in own] == ["a"] * 3 + ["b"] * 3 and own[2].name == "start@a.relaxed position of block"
    assert len(start_parameters(bench, given["a"], False)) == 2 and start_parameters(bench, runs["a"], True) == ()
    hypothesis = Hypothesis("nominal", (), tuple(own))
    values = hypothesis.values(hypothesis.nominal) | {"start@b.velocity of block": 7.0}
    start = begun(given["b"].run, hypothesis, values).start
    assert start.velocity == [7.0] and start.relaxed == [0.0] and start.displacement == pytest.approx([0.01], rel=1e-5)
    assert begun(given["a"].run, Hypothesis("nominal"), {}) is given["a"].run
    widest = np.hypot(START[0], START[1] / np.sqrt(STIFFNESS / MASS))
    assert own[0].prior.scale == pytest.approx(widest, rel=1e-3), "as far as the energy of the start moves it"
    assert own[1].prior.scale == pytest.approx(widest * np.sqrt(STIFFNESS / MASS), rel=1e-3)


@pytest.mark.exact
def test_coordinates_of_effects_start_where_springs_hold_them():
    model = lumps([1.0, 1.0], [[-1.0, 1.0], [0.0, 1.0]], [300.0, 100.0], [0.0, 0.0])
    start = held(model, Start(np.array([0.04]), np.array([2.0])))
    np.testing.assert_allclose([start.displacement, start.velocity], [[0.04, 0.03], [2.0, 1.5]], rtol=1e-12)
    assert start.relaxed is None


def test_taps_of_one_strength_are_one_operating_point_whose_differences_are_no_noise():
    starts = {"a": (0.05, 0.0), "b": (0.0, 1.05), "c": (0.02, 0.4), "d": (-0.051, 0.1)}
    motions = {name: exact(start) for name, start in starts.items()}
    bench, runs, section = rig(motions, "velocity")
    assert {name: run.repeat_of for name, run in started(bench, runs, section).items()} == {
        "a": "", "b": "a", "c": "", "d": "a"}
    whole = problem(motions, "velocity", held_out=("d",), weighed=["coulomb"])
    assert set(operating_points(whole.problem.training)) == {"a", "c"}
    silent = tuple(replace(run, noise_std=None) for run in whole.problem.runs)
    with pytest.raises(ConfigError, match="run a: noise"):
        budget(replace(whole.problem, runs=silent))
    apart = rig(motions, "velocity")[1]
    apart["b"] = replace(apart["b"], run=replace(apart["b"].run, conditions={"bolt force": 2.0}))
    assert started(bench, apart, section)["b"].repeat_of == ""


def test_nothing_moves_freely_where_a_drive_turns_past_contacts():
    bench, runs, _ = rig({"a": exact(START)}, "velocity")
    one, seen = runs["a"], replace(bench.channels[0], source="sensor_0")
    rubbed = replace(bench, model=belt(), law=Hard(), friction=constant(0.3), channels=(seen,))
    still, turning = (replace(one, run=replace(one.run, drive=speed)) for speed in (0.0, 2.0))
    assert moves_freely(rubbed, still) and not moves_freely(rubbed, turning)
