"""Runs that differ: told where each alone is what the nominal model predicts, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.inference.decision.between_runs import told
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem

TIME, NOISE = np.arange(200) / 100, 1e-2
PARAMETERS = (Parameter("rate", "1/s", 1.0, LogNormal(1.0, 0.5)), Parameter("size", "m", 1.0, LogNormal(1.0, 0.5)))


def predict(hypothesis, values, run):
    return values["size"] * np.exp(-values["rate"] * TIME)[None]


def asked(rates, bent=0.0, parameters=PARAMETERS, held_out=()):
    """(Problem of decays at these ``rates``, {run: Noise}, Fit of the nominal model to those fitted)."""
    random = np.random.default_rng(2)
    runs = tuple(Observed(f"run_{k}", {}, ("y",), (np.exp(-rate * TIME) + bent * np.sin(20 * TIME)
                          + NOISE * random.standard_normal(len(TIME)))[None], 100.0, noise_std=np.array([NOISE]),
                          held_out=k in held_out)
                 for k, rate in enumerate(rates))
    problem = Problem(runs, predict, Hypothesis("nominal", (), parameters))
    noises = budget(problem)
    fitted = problem.training
    return problem, noises, fit(problem, [noises[r.name] for r in fitted], problem.nominal, problem.nominal.nominal,
                                fitted)


def test_what_differs_is_told_with_its_range_and_nothing_else():
    why = told(*asked((1.0, 1.1, 0.9)), 0.05)
    assert "rate from 0." in why and "to 1." in why and "standard deviation 0.1" in why and "size" not in why
    assert "between_runs" in why


def test_a_held_out_run_may_differ_too():
    assert "rate from" in told(*asked((1.0, 1.2), held_out=(1,)), 0.05)
    assert told(*asked((1.0, 1.0), held_out=(1,)), 0.05) == ""


@pytest.mark.parametrize("rates, bent", [((1.0, 1.0, 1.0), 0.0), ((1.0, 1.1, 0.9), 0.1), ((1.2,), 0.0)],
                         ids=["alike", "more than that is missing", "one run"])
def test_nothing_is_told_where_values_agree_or_runs_are_not_explained(rates, bent):
    assert told(*asked(rates, bent), 0.05) == ""


def test_nothing_is_told_where_the_case_lets_runs_differ():
    own = Parameter("own", "1/s", 0.0, Normal(0.0, 0.1), run="run_0", of="rate")
    problem, noises, null = asked((1.0, 1.1, 0.9))
    problem = replace(problem, nominal=replace(problem.nominal, parameters=(*PARAMETERS, own)))
    assert told(problem, noises, null, 0.05) == ""
