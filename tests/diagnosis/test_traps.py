"""Traps that real recordings set, on toy benches: plausible ways to name physics that go wrong, and that ours does not.

Silverbox (a hardening circuit), EMPS (a carriage with dry friction) and the reciprocating tribometer, each with its
truth integrated apart.
"""

from dataclasses import replace
from functools import cache
from math import tanh

import numpy as np
import pytest

from pipeline.inference.fitting.calibration import calibrate
from pipeline.inference.fitting.fit_state import whitened
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from pipeline.inference.procedure import diagnose
from tests.inference import linear, oscillator
from tests.inference.oscillator import CATALOGUE, DAMPING, SOLVER, predict_with_lag

COULOMB = next(c for c in CATALOGUE if c.name == "coulomb")
OFFSET = next(c for c in CATALOGUE if c.name == "offset")


def hardening(t, x, v):
    return 1.5e4 * x**3


def friction(t, x, v):
    return 0.6 * tanh(v / 0.005)


@cache
def recorded(law, noise=0.01, **of_truth):
    return oscillator.bench(5, noise, extra=law, **of_truth)


def null_of(problem):
    noises = [budget(problem)[run.name] for run in problem.training]
    return calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training)


def with_more(problem, null, *candidates):
    """Fit of the nominal hypothesis and ``candidates`` from their nominal values."""
    hypothesis, latent = problem.nominal, null.latent
    for one in candidates:
        hypothesis, latent = hypothesis.joined(one), np.append(latent, one.nominal)
    return fit(problem, null.noises, hypothesis, latent, null.runs)


def square(problem, found, runs):
    """Sum of squared whitened residuals of a Fit on ``runs``."""
    noises = [budget(problem)[run.name] for run in runs]
    white = np.concatenate(whitened(problem, noises, found.hypothesis, found.latent, runs)[0])
    return white @ white


def bayes_gain(null, found):
    """Decrease of -2 ln L + k ln n, noise of unknown size: G. Schwarz, Ann. Stat. 6 (1978) 461."""
    count = null.counts.sum()
    more = len(found.latent) - len(null.latent)
    return count * np.log(null.chi_square.sum() / found.chi_square.sum()) - more * np.log(count)


def told(found):
    return found.decision.verdict, [c.name for c in found.decision.named]


def test_on_a_hardening_spring_friction_that_pushes_beats_the_linear_model():
    """As on Silverbox: by the criterion of Bayes alone, "linear + Coulomb" wins with a negative force."""
    problem = recorded(hardening, stiffness=380.0)
    force = Parameter("friction_force", "N", 0.0, Normal(0.0, 1.0))
    either = Hypothesis("friction", (("friction", "mount"),), (force,))
    null = null_of(problem)
    found = with_more(problem, null, either)
    assert bayes_gain(null, found) > 10 and found.values["friction_force"] < 0


def test_on_a_hardening_spring_friction_is_not_named_even_where_nothing_else_is_offered():
    """Where the whole catalogue is, the spring is: a truth of tests/inference/test_procedure.py."""
    problem = recorded(hardening, stiffness=380.0)
    assert told(diagnose(problem, budget(problem), [COULOMB])) == ("unknown", [])


def test_an_output_error_refit_lets_viscous_damping_absorb_friction_and_breaks_over_amplitude():
    problem = recorded(friction)
    null = null_of(problem)
    given = replace(null, latent=problem.nominal.nominal)
    before, after = (square(problem, f, problem.training) for f in (given, null))
    assert null.values["damping"] > 1.2 * DAMPING and after < 0.5 * before
    found = diagnose(problem, budget(problem), CATALOGUE)
    assert found.weighing.drift.p_value < 0.001, "every amplitude asks for its own damping"
    assert told(found) == ("missing", ["coulomb"])


def test_a_direction_of_friction_improves_training_and_worsens_what_was_held_out():
    """Friction of two sizes is friction of one size and an offset: here a zero of the amplifier that day."""
    training = recorded(lambda t, x, v: friction(t, x, v) + 0.03).training
    problem = replace(recorded(friction), runs=(*training, *recorded(friction).held_out))
    null = null_of(problem)
    one, two = with_more(problem, null, COULOMB), with_more(problem, null, COULOMB, OFFSET)
    assert bayes_gain(one, two) > 10
    assert square(problem, two, problem.held_out) > 1.01 * square(problem, one, problem.held_out)
    assert told(diagnose(problem, budget(problem), CATALOGUE)) == ("missing", ["coulomb"])


def test_a_solver_half_a_sample_late_makes_bayes_name_an_effect_and_us_the_solver():
    problem = replace(recorded(None, stiffness=420.0), predict=predict_with_lag)
    null = null_of(problem)
    gains = [bayes_gain(null, with_more(problem, null, c)) for c in CATALOGUE]
    assert max(gains) > 10, "nothing is missing, and something wins"
    found = diagnose(problem, budget(problem), (*CATALOGUE, SOLVER))
    assert told(found) == ("numerics", ["time_step"])
    assert found.named[0].fit.values["refinement"] == pytest.approx(1.0, abs=0.02)


def test_the_best_held_out_model_names_something_in_most_controls_and_the_rules_in_none():
    controls, chosen, named = 10, 0, 0
    for seed in range(controls):
        problem, noise, catalogue, _ = linear.problem((2, *[1] * 12), runs=4, seed=seed, held_out=1,
                                                      truth={"nominal_0": 1.0, "nominal_1": -0.5})
        noises, held = ([noise[run.name] for run in runs] for runs in (problem.training, problem.held_out))
        left = []
        for hypothesis in [problem.nominal, *(problem.nominal.joined(c) for c in catalogue)]:
            found = fit(problem, noises, hypothesis, hypothesis.nominal, problem.training)
            white = np.concatenate(whitened(problem, held, hypothesis, found.latent, problem.held_out)[0])
            left.append(white @ white)
        chosen += int(np.argmin(left) > 0)
        named += bool(diagnose(problem, noise, catalogue).decision.named)
    assert chosen >= 0.8 * controls and named == 0


# A reciprocating tribometer: a slider on an arm, dragged by u(t); the load cell shows the force of the arm

ARM, LOAD, MU, SAMPLES = 2e4, 10.0, 0.3, 400
TRIBOMETER = Hypothesis("nominal", (), (Parameter("friction", "1", MU, LogNormal(MU, 0.2)),))
COMPLIANCES = tuple(Hypothesis(name, ((name, place),), (
    Parameter(name, "m/N", 0.0, HalfNormal(1e-4), 0.0),)) for name, place in (("micro_slip", "contact"),
                                                                            ("compliant_arm", "arm")))


def dragged(hypothesis, values, run):
    """F = clip(F + k du, -mu N, mu N), 1 / k = 1 / k_a + s + c N_0 / N: a contact gives way less under load."""
    load, reach = run.conditions["load"], run.conditions["reach"]
    give = 1 / ARM + values.get("compliant_arm", 0.0) + values.get("micro_slip", 0.0) * LOAD / load
    limit, force, shown = values["friction"] * load, 0.0, np.empty(SAMPLES)
    way = np.diff(reach * np.sin(2 * np.pi * np.arange(SAMPLES + 1) / 160)) / give
    for k in range(SAMPLES):
        force = min(max(force + way[k], -limit), limit)
        shown[k] = force
    return shown[None]


def tribometer(*loads):
    """Problem of four reaches, under these loads in turn; the contact gives way, the last run is held out."""
    random, runs = np.random.default_rng(3), []
    for k, reach in enumerate((4e-4, 1e-3, 2e-3, 1.5e-3)):
        conditions = {"load": loads[k % len(loads)], "reach": reach}
        run = Observed(f"run_{k}", conditions, ("force",), np.zeros((1, SAMPLES)), 160.0)
        clean = dragged(TRIBOMETER, {"friction": 0.28, "micro_slip": 8e-5}, run)
        runs.append(replace(run, samples=clean + 0.03 * random.standard_normal(clean.shape), noise_std=np.array([0.03]),
                            held_out=k == 3))
    return Problem(tuple(runs), dragged, TRIBOMETER)


def test_at_one_load_slip_of_the_contact_and_compliance_of_the_arm_are_tied():
    problem = tribometer(LOAD)
    verdict, named = told(diagnose(problem, budget(problem), COMPLIANCES))
    assert verdict == "tie" and set(named) == {"micro_slip", "compliant_arm"}


def test_a_second_load_tells_them_apart():
    problem = tribometer(LOAD, 2 * LOAD)
    assert told(diagnose(problem, budget(problem), COMPLIANCES)) == ("missing", ["micro_slip"])
