"""What a named law leaves along other laws at its place: calibrated whatever the noise, and told as another form."""

from dataclasses import replace
from math import sin, tanh
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from pipeline.inference.decision import other_form
from pipeline.inference.decision.other_form import largest_shifted, left_along, objection
from pipeline.inference.diagnosis import Settings, over_noise
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import continued
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Hypothesis
from pipeline.inference.procedure import diagnose
from pipeline.inference.rules import DEFAULTS
from tests.inference import linear
from tests.inference.oscillator import CATALOGUE, bench

RULES = DEFAULTS.decision


def named(seed, colour=0.0, scale=1.0, rest=0.0, samples=300):
    """(Problem that takes effect_1 as known, its Fit, [effect_2]) with the amount ``rest`` of effect_2 in the truth,
    all columns smooth, in noise whose neighbours have this correlation and which is ``scale`` times what is stated."""
    whole, _, catalogue, tables = linear.problem((2, 1, 1), 3, samples, seed=seed)
    random, runs = np.random.default_rng([seed, 1]), []
    for run in whole.runs:
        for name, column in tables[run.name].items():
            tables[run.name][name] = np.convolve(column, np.hanning(9), "same")
        noise = lfilter([np.sqrt(1 - colour**2)], [1.0, -colour], random.standard_normal(samples))
        clean = 3 * tables[run.name]["effect_1_0"] + rest * tables[run.name]["effect_2_0"]
        runs.append(replace(run, samples=(clean + scale * linear.STD * noise)[None]))
    problem = replace(whole, runs=tuple(runs)).given(catalogue[0])
    noises = tuple(budget(problem)[run.name] for run in problem.runs)
    begin = linearised(problem, noises, problem.nominal, np.zeros(3), problem.runs)
    return problem, continued(problem, begin), catalogue[1:]


@pytest.mark.parametrize("colour", [0.0, 0.6])
@pytest.mark.parametrize("scale", [0.7, 1.5])
def test_chance_is_told_as_chance_whatever_is_stated_of_the_noise(colour, scale):
    """Of 100 draws with nothing left 5 have a p-value below .05 (14 at most: binomial, 4 standard deviations)."""
    told = [left_along(*named(seed, colour, scale)).p_value for seed in range(100)]
    assert np.sum(np.array(told) < 0.05) <= 14


def test_the_score_is_that_of_the_closed_form():
    problem, fit, others = named(0, rest=0.3)
    names = [p.name for h in (problem.nominal, *others) for p in h.parameters]
    design = np.concatenate([np.array([problem.predict.args[0][run.name][n] for n in names]).T for run in problem.runs])
    *values, other = (design / linear.STD).T
    values = np.array(values).T
    cleaned = other - values @ np.linalg.lstsq(values, other, rcond=None)[0]
    left = left_along(problem, fit, others)
    expected = abs(cleaned @ np.concatenate(fit.residuals)) / np.linalg.norm(cleaned)
    assert left.score == pytest.approx(expected, rel=1e-9) and left.name == "effect_2" and left.p_value <= 1e-3
    assert left.energy == pytest.approx(expected**2, rel=0.2)


def test_what_only_repeats_the_values_is_not_asked():
    problem, fit, others = named(1)
    for columns in problem.predict.args[0].values():
        columns["effect_2_0"] = columns["nominal_0"] - 2 * columns["effect_1_0"]
    assert left_along(problem, fit, others) is None


def test_residuals_shifted_round_keep_their_size():
    _, fit, _ = named(2, colour=0.6)
    whole = np.ones((1, fit.counts.sum()))
    assert np.allclose(largest_shifted(whole, fit, draws=20), abs(np.concatenate(fit.residuals).sum()))


def asked(rest, adapts=False, stated=1.0):
    """What ``objection`` says of effect_1 where the amount ``rest`` of effect_2 is left, noise ``stated`` times itself.
    """
    problem, fit, others = named(3, rest=rest)
    first = Hypothesis("effect_1", (("effect_1", "here"),))
    alone = replace(problem, nominal=replace(problem.nominal, effects=(), parameters=problem.nominal.parameters[:2]))
    null = linearised(alone, fit.noises, alone.nominal, fit.latent[:2], fit.runs)
    diagnosis = SimpleNamespace(calibration=SimpleNamespace(problem=replace(problem, nominal=replace(
        problem.nominal, effects=()))), recalibrated=null.at_noise(stated))
    weighed = SimpleNamespace(fit=fit.at_noise(stated), refined=first, statistics=SimpleNamespace(adapts=adapts))
    return objection(diagnosis, weighed, (first, *others), RULES)


@pytest.mark.parametrize("stated", [0.8, 1.25])
def test_a_law_that_leaves_more_than_it_may_is_of_another_form(stated):
    """Effect_1 is three, of which a twentieth of its square may be left, of a law that adapts a four-hundredth."""
    assert "moves as effect_2 would" in asked(1.0, stated=stated)
    assert not asked(0.3, stated=stated) and "another form" in asked(0.3, adapts=True, stated=stated)
    assert not asked(0.0, adapts=True, stated=stated)


def test_features_and_laws_of_other_places_are_not_asked():
    problem, fit, others = named(3, rest=1.0)
    weighed = SimpleNamespace(fit=replace(fit, noises=tuple(replace(n, ordered=False) for n in fit.noises)))
    assert objection(None, weighed, others, RULES) == ""


def dry(t, x, v):
    return 0.6 * tanh(v / 0.005)


@pytest.mark.parametrize("seed", range(4))
def test_the_right_law_is_named_all_the_same(seed):
    problem = bench(seed, 0.03, stiffness=430.0, extra=dry)
    told = diagnose(problem, budget(problem), CATALOGUE)
    assert [w.candidate.name for w in told.named] == ["coulomb"] and not told.objected


def test_a_law_of_another_form_is_not_named_but_leads(monkeypatch):
    monkeypatch.setattr(other_form, "objection", lambda _, law, *rest: f"{law.candidate.name} is of another form")
    problem, settings = bench(5, 0.03, stiffness=430.0, extra=dry), Settings()
    told = diagnose(problem, budget(problem), CATALOGUE, settings)
    assert (told.decision.verdict, told.decision.leading.name) == ("unknown", "coulomb")
    assert "coulomb: coulomb is of another form" in told.decision.reasons and not told.named
    assert over_noise(told, settings, (1.0,))[0].verdict == "unknown"


def test_noise_of_another_colour_is_told_from_a_force_that_no_law_has():
    """Samples correlated by .9 where white noise is stated; a spring that pulsates."""
    problem = bench(5, 0.02, stiffness=430.0)
    random, runs = np.random.default_rng(7), []
    for run in problem.runs:
        noise = random.standard_normal(run.samples.shape)
        for k in range(1, noise.shape[1]):
            noise[:, k] = 0.9 * noise[:, k - 1] + np.sqrt(1 - 0.9**2) * noise[:, k]
        runs.append(replace(run, samples=run.samples + run.noise_std[:, None] * noise))
    coloured = replace(problem, runs=tuple(runs))
    told = diagnose(coloured, budget(coloured), CATALOGUE)
    assert told.decision.verdict == "unknown" and "noise of another colour" in told.decision.reasons[-1]
    missing = bench(5, 0.02, stiffness=430.0, extra=lambda t, x, v: 25.0 * sin(9.0 * t) * x)
    told = diagnose(missing, budget(missing), CATALOGUE)
    assert told.decision.verdict == "unknown" and not any("colour" in r for r in told.decision.reasons)
