"""Simulated runs as a forward model: completion, effects, the solver's step."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.units import to_si
from pipeline.diagnosis.problem import nominal
from pipeline.diagnosis.signals.forward_model import (
    REFINEMENT,
    SOLVER,
    STEP,
    Simulated,
    candidates,
    completed,
    observed,
    shown,
    solver_candidate,
)
from pipeline.effects import CATALOGUE
from pipeline.inference.priors import LogNormal, Parameter
from pipeline.physics.time_stepping.simulate import Start
from tests.diagnosis.small_rig import FINE, HIDDEN, effects, laid_out, model, recording

SETTINGS = laid_out()
BENCH = benches.built(model(), SETTINGS)
RECORDED = recorded(recording(HIDDEN, noise=0.0), SETTINGS)
RUNS = {name: one.run for name, one in RECORDED.items()}
FOUND = candidates(BENCH, tuple(RUNS.values()), CATALOGUE)
CUBIC = next(c for c in FOUND if c.effects == (("cubic_stiffness", "mount"),))


def test_noise_is_given_of_every_channel_or_of_none():
    one = next(iter(RECORDED.values()))
    assert observed(one).noise_std is None and observed(one, {"x": 1e-3}).noise_std == pytest.approx([1e-3])
    with pytest.raises(ConfigError, match="or of none, found none of x; give it too"):
        observed(one, {"y": 1e-3})


def test_every_place_of_every_effect_is_a_candidate():
    places = {(e.name, place) for e in CATALOGUE for place in e.locations(BENCH)}
    assert {c.effects[0] for c in FOUND} == places and len({c.name for c in FOUND}) == len(FOUND)
    assert [c.effects for c in candidates(BENCH, tuple(RUNS.values()), CATALOGUE, ("nowhere",))] == []


def test_true_values_reproduce_the_recording():
    predict = Simulated(replace(BENCH, step=to_si(FINE, "s", "step")), RUNS)
    run = observed(RECORDED["level_1"])
    found = pickle.loads(pickle.dumps(predict))(CUBIC, {CUBIC.parameters[0].name: 1.5e4}, run)
    np.testing.assert_array_equal(found, run.samples)
    assert abs(predict(nominal([]), {}, run) - run.samples).max() > 1e-3


def test_gains_and_delays_of_channels_move_no_body_anew():
    names = "channels.x.gain", "channels.x.delay", "joints.mount.stiffness"
    hypothesis = nominal([Parameter(n, "1", 1.0, LogNormal(1.0, 0.1)) for n in names])
    run, kept = observed(RECORDED["level_1"]), Simulated(BENCH, RUNS)
    stiffness = float(BENCH.model.joints.stiffness[0])
    for gain, delay, factor, motions in ((1.0, 0.0, 1.0, 1), (1.1, 0.0, 1.0, 1), (1.1, 2e-4, 1.0, 1),
                                           (1.1, 2e-4, 1.2, 2)):
        values = dict(zip(names, (gain, delay, factor * stiffness), strict=True))
        np.testing.assert_array_equal(kept(hypothesis, values, run), Simulated(BENCH, RUNS)(hypothesis, values, run))
        assert len(kept.motions) == motions


def test_corrections_and_effects_go_on_together():
    whole = nominal([Parameter("masses.block", "kg", 1.0, LogNormal(1.0, 0.1))]).joined(CUBIC)
    bench = completed(BENCH, whole, {"masses.block": 1.2, CUBIC.parameters[0].name: 1.5e4})
    direct = with_effects(benches.built(model(), laid_out(corrections={"masses.block": "1.2 kg"})), effects(HIDDEN))
    run = RUNS["level_1"]
    np.testing.assert_array_equal(shown(bench, run, ("x",)), shown(direct, run, ("x",)))


def test_refinement_goes_from_the_step_to_half_of_it():
    run, predict = observed(RECORDED["level_1"]), Simulated(BENCH, RUNS)
    hypothesis, name = solver_candidate(), f"{STEP}@{SOLVER}.{REFINEMENT}"
    half = shown(replace(BENCH, step=BENCH.step / 2), RUNS["level_1"], ("x",))
    np.testing.assert_allclose(predict(hypothesis, {name: 1.0}, run), half, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(predict(hypothesis, {name: 0.0}, run), predict(nominal([]), {}, run))


def test_a_hypothesis_halves_the_step_between_samples():
    """Also where the step of the bench is longer than the distance of samples."""
    whole = with_effects(benches.built(model(), laid_out(step="8 ms")), effects(HIDDEN))
    run, predict = observed(RECORDED["level_3"]), Simulated(whole, RUNS)
    coarse, finer = (predict(replace(nominal([]), halvings=k), {}, run) for k in (0, 2))
    quarter = shown(replace(whole, step=1 / 200 / 4), RUNS["level_3"], ("x",))
    np.testing.assert_array_equal(finer, quarter)
    assert not np.array_equal(coarse, finer)


def test_refinement_is_that_of_the_values_at_hand():
    """At order 2 half the step leaves a fifth of what the step is off by beside a quarter of it, 5/4 of the change
    nothing."""
    cubic = nominal([]).joined(CUBIC)
    values, run = {CUBIC.parameters[0].name: 1.5e4}, observed(RECORDED["level_1"])
    finest = shown(completed(replace(BENCH, step=BENCH.step / 4), cubic, values), RUNS["level_1"], ("x",))
    predict, name = Simulated(BENCH, RUNS), f"{STEP}@{SOLVER}.{REFINEMENT}"
    errors = [abs(predict(cubic.joined(solver_candidate()), values | {name: r}, run) - finest).max()
              for r in (0.0, 1.0, 1.25)]
    assert errors[0] > 3 * errors[1] > 0 and errors[2] < 0.2 * errors[1]


@pytest.mark.parametrize("noise, held_out", [(None, False), ({"x": 1e-4}, True)])
def test_observed_runs_keep_what_is_known(noise, held_out):
    run = observed(RECORDED["level_2"], noise, held_out)
    assert run.held_out == held_out and run.conditions == {"level": 5.0} and run.rate == 200.0
    assert run.noise_std is None if noise is None else run.noise_std == [1e-4]


def test_coordinates_that_an_effect_adds_start_at_rest():
    start = Start(np.array([1e-3]), np.array([0.0]))
    run = replace(RUNS["level_1"], start=start)
    base = next(c for c in FOUND if c.effects == (("moving_base", "mount"),))
    values = {p.name: p.nominal for p in base.parameters} | {"moving_base@mount.compliance": 1e-9}
    moved = shown(completed(BENCH, base, values), run, ("x",))
    np.testing.assert_allclose(moved, shown(BENCH, run, ("x",)), atol=2e-4 * abs(moved).max())
