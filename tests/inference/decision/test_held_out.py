"""Verification: gains and their standard errors in closed form, errors against the floor."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.decision.candidate_statistics import held_out_gains
from pipeline.inference.decision.held_out import errors, gain, held_out_residuals, judged
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.noise import budget, whitening
from pipeline.inference.fitting.run_parameters import first_part, short
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis
from pipeline.inference.rules import DEFAULTS
from tests.inference import oscillator
from tests.inference.curves import noises_of
from tests.inference.fitting.test_noise import run
from tests.inference.fitting.test_run_parameters import made

SIZE = 3000
WHITE = (whitening(run(np.zeros(SIZE)), np.ones((1, 1))),)


def gains(size, draws=300):
    """Gains from a model that lacks a signal of squared norm ``size`` to the true one."""
    signal = np.sin(np.arange(SIZE) / 9)
    signal *= np.sqrt(size) / np.linalg.norm(signal)
    noise = [np.random.default_rng(k).standard_normal(SIZE) for k in range(draws)]
    return [gain(WHITE, [n + signal], [n]) for n in noise]


@pytest.mark.exact
def test_the_gain_of_the_true_model_and_its_standard_error():
    found = gains(100.0)
    value = np.array([g.value for g in found])
    assert value.mean() == pytest.approx(100.0, abs=4 * 20 / np.sqrt(300))
    assert value.std() == pytest.approx(20.0, rel=4 / np.sqrt(600))
    assert np.mean([g.std for g in found]) == pytest.approx(20.0, rel=0.02)
    assert np.mean([g.errors > 3 for g in found]) > 0.95


def test_a_model_that_fits_noise_gains_nothing_on_new_data():
    worse = gains(4.0)
    assert not any(gain(WHITE, [n], [n + 0.05]).errors > 3 for n in
                   (np.random.default_rng(k).standard_normal(SIZE) for k in range(100)))
    assert np.mean([g.errors > 3 for g in worse]) < 0.05


@pytest.mark.exact
def test_the_share_is_of_the_excess_error():
    signal, noise = np.full(SIZE, 3.0), np.random.default_rng(0).standard_normal(SIZE)
    found = gain(WHITE, [noise + signal], [noise + 0.5 * signal])
    first, second = noise + signal, noise + 0.5 * signal
    assert found.share == pytest.approx((first @ first - second @ second) / (first @ first - SIZE))
    assert gain(WHITE, [noise], [noise + signal]).share == 0.0


@pytest.mark.exact
def test_what_is_left_counts_beyond_the_doubt_about_noise():
    signal, noise = np.full(SIZE, 3.0), np.random.default_rng(0).standard_normal(SIZE)
    first, second = noise + signal, noise + 0.5 * signal
    left = second @ second - 1.05 * SIZE - 2 * np.sqrt(2 * SIZE)
    assert gain(WHITE, [first], [second]).left(0.05) == pytest.approx(left / (first @ first - SIZE))
    assert gain(WHITE, [first], [noise]).left(0.05) == 0.0 and gain(WHITE, [first], [first]).left(0.0) > 0.9
    assert gain(WHITE, [first], [second]).growth(2.0, 0.05) == pytest.approx((1 + left / SIZE) / 2)
    assert gain(WHITE, [first], [noise]).growth(0.9, 0.05) == 1.0


def test_errors_fall_from_nominal_to_completed_and_end_at_the_floor():
    problem = oscillator.bench(2, stiffness=430.0, extra=lambda t, x, v: 0.6 * np.tanh(v / 0.005))
    noise = budget(problem)
    noises = tuple(noise[r.name] for r in problem.training)
    null = fit(problem, noises, problem.nominal, np.zeros(2), problem.training)
    whole = problem.nominal.joined(oscillator.CATALOGUE[2])
    best = fit(problem, noises, whole, np.append(null.latent, 0.0), problem.training)
    told = errors(problem, noise, problem.nominal, null, best, problem.held_out)
    assert told.before > told.recalibrated > 5 * told.after and told.runs == ("run_4",)
    assert told.after == pytest.approx(told.noise_floor, rel=0.05) and told.noise_floor == pytest.approx(0.01, rel=0.01)


def test_a_model_that_fails_on_a_held_out_run_says_so():
    problem = oscillator.bench(2)
    noises = tuple(budget(problem)[r.name] for r in problem.training)
    null = fit(problem, noises, problem.nominal, np.zeros(2), problem.training)
    broken = type(problem)(problem.runs, lambda h, v, r: np.full((2, oscillator.SAMPLES), np.nan), problem.nominal)
    with pytest.raises(ConvergenceError, match="prediction of run run_1"):
        held_out_residuals(broken, noises, null, problem.training)


@pytest.mark.exact
def test_of_a_run_whose_start_is_fitted_only_the_rest_is_judged():
    """The start is fitted to the first part, and what is left of the first part counts nowhere."""
    problem, noise, _ = made(held_out=1)
    run, = problem.held_out
    null = fit(problem, noises_of(problem, noise), problem.nominal, np.zeros(8), problem.training)
    residual, = held_out_residuals(problem, [noise[run.name]], null, [run], 0.5)
    assert len(residual) == 30 == judged(problem, [noise[run.name]], [run], 0.5)[0].count
    spoiled = run.samples.copy()
    spoiled[0, 30:] += 100.0                    # after the part that the start is fitted to
    elsewhere = replace(problem, runs=(*problem.training, replace(run, samples=spoiled)))
    shifted, = held_out_residuals(elsewhere, [noise[run.name]], null, list(elsewhere.held_out), 0.5)
    np.testing.assert_allclose(shifted - residual, 100.0 / noise[run.name].std[0], rtol=1e-9)
    told = errors(problem, noise, problem.nominal, null, null, problem.held_out, 0.5)
    rest = run.samples[0, 30:]
    assert told.noise_floor == pytest.approx(noise[run.name].std[0] / rest.std(), rel=1e-9)
    assert told.recalibrated == pytest.approx(np.sqrt(np.mean(residual**2)) * told.noise_floor, rel=1e-9)


def test_hypotheses_of_unlike_numbers_of_start_states_are_judged_by_the_same_samples():
    """A body that an effect adds has a start of its own; nothing is subtracted of unequal length, also of a pair."""
    problem, noise, tables = made(held_out=1)
    run, = problem.held_out
    added = tuple(Parameter(f"body@{run.name}.{k}", "1", 0.0, Normal(0.0, 1.0), run=run.name) for k in range(2))
    candidate = Hypothesis("body", (("body", "joint"),), (
        *added, Parameter("body.size", "1", 0.0, Normal(0.0, 1.0), 0.0)))
    for name, columns in tables.items():
        columns |= {p.name: np.cos(k + np.arange(60.0)) * (p.run in ("", name))
                    for k, p in enumerate(candidate.parameters)}
    alike = problem.for_all((candidate,))
    null, whole = (fit(problem, noises_of(problem, noise), h, np.zeros(len(h.parameters)), problem.training)
                   for h in (problem.nominal, problem.nominal.joined(candidate)))
    for posed in (alike, alike.given(candidate), alike.given(candidate).for_all(())):
        lengths = {len(held_out_residuals(posed, [noise[run.name]], f, [run], 0.01)[0]) for f in (null, whole)}
        assert lengths == {30}, "eight samples for each of four are more than half of the run"
        gained, _ = held_out_gains(posed, noise, null, {0: whole}, np.ones(1), DEFAULTS)[0]
        assert gained.count == 60 - first_part(posed, noise[run.name], run, DEFAULTS.decision.start_share)
    told, = short(alike, noise)
    assert told.startswith(f"the held-out run {run.name} has 60 samples: the 30 to which its unknown start is fitted")
    assert not list(short(problem, noise))
