"""Parameters of one run alone: linear problems in closed form, their cost, and the part of a run that judges."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.run_parameters import first_part, on_all_runs, with_own_parameters
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis
from tests.inference import linear
from tests.inference.curves import noises_of


class Counting:
    """A forward model that counts its predictions by run, or fails of its own."""

    def __init__(self, predict):
        self.predict, self.count, self.fails = predict, {}, False

    def __call__(self, hypothesis, values, run):
        if self.fails:
            raise ConvergenceError("prediction", "a motion", "none")
        self.count[run.name] = self.count.get(run.name, 0) + 1
        return self.predict(hypothesis, values, run)


def own(problem, per_run=2):
    """The problem with parameters of each run alone, whose columns in its tables move no other run."""
    tables = {name: dict(columns) for name, columns in problem.predict.args[0].items()}
    random, added = np.random.default_rng(5), []
    for run in problem.runs:
        for k in range(per_run):
            name = f"start@{run.name}.{k}"
            added.append(Parameter(name, "1", 0.0, Normal(0.0, 3.0), run=run.name))
            for other, columns in tables.items():
                columns[name] = random.standard_normal(run.samples.shape[1]) if other == run.name else np.zeros(
                    run.samples.shape[1])
    nominal = Hypothesis("nominal", (), problem.nominal.parameters + tuple(added))
    return replace(problem, predict=Counting(lambda h, v, run: linear.predict(tables, h, v, run)),
                   nominal=nominal), tables


def made(runs=3, held_out=0):
    whole, noise, _, _ = linear.problem((2,), runs=runs, truth={"nominal_0": 0.7, "nominal_1": -1.2}, held_out=held_out)
    problem, tables = own(whole)
    return problem, noise, tables


@pytest.mark.exact
def test_the_joint_fit_has_the_closed_form_of_its_posterior():
    problem, noise, tables = made()
    found = fit(problem, noises_of(problem, noise), problem.nominal, np.zeros(8), problem.training)
    data, design = linear.dense(problem, problem.nominal, tables)
    size = np.array([p.prior.scale for p in problem.nominal.parameters])
    covariance = np.linalg.inv(design.T @ design + np.diag(1 / size**2))
    np.testing.assert_allclose(list(found.values.values()), covariance @ design.T @ data, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(list(found.spread().values()), np.sqrt(np.diag(covariance)), rtol=1e-6)
    for run, jacobian in zip(found.runs, found.jacobians, strict=True):
        assert not jacobian[:, ~problem.nominal.moves(run.name)].any(), "starts of other runs"


@pytest.mark.parametrize("runs", [2, 8])
def test_jacobians_cost_as_many_predictions_of_each_run_however_many_runs_there_are(runs):
    problem, noise, _ = made(runs)
    found = linearised(problem, noises_of(problem, noise), problem.nominal, np.zeros(2 + 2 * runs), problem.training)
    assert set(problem.predict.count.values()) == {1 + 2 + 2} and found.evaluations == 5


@pytest.mark.exact
def test_a_held_out_run_gives_its_own_parameters_from_its_first_part():
    problem, noise, tables = made(held_out=1)
    run, = problem.held_out
    found = fit(problem, noises_of(problem, noise), problem.nominal, np.zeros(8), problem.training)
    assert not found.latent[6:].any(), "the fitted runs say nothing of it"
    end = first_part(problem, noise[run.name], run, 0.5)
    latent = with_own_parameters(problem, [noise[run.name]], problem.nominal, found.latent, [run], 0.5)
    columns = np.array([tables[run.name][p.name][:end] for p in problem.nominal.parameters]).T / linear.STD
    left = run.samples[0, :end] / linear.STD - columns[:, :2] @ found.latent[:2]
    alone = 3 * columns[:, 6:]
    np.testing.assert_allclose(latent[6:], np.linalg.solve(alone.T @ alone + np.eye(2), alone.T @ left), atol=1e-3)
    np.testing.assert_array_equal(latent[:6], found.latent[:6])
    assert end == 30 and first_part(problem, noise[run.name], run, 0.01) == 16, "eight samples for each"
    whole = on_all_runs(problem, noise, found)
    assert not np.array_equal(whole[6:], latent[6:]) and np.array_equal(whole[:6], found.latent[:6])


def test_runs_without_parameters_of_their_own_are_judged_as_a_whole():
    whole, noise, _, _ = linear.problem((2,), held_out=1)
    run, = whole.held_out
    assert first_part(whole, noise[run.name], run, 0.5) == 0
    np.testing.assert_array_equal(with_own_parameters(whole, [noise[run.name]], whole.nominal, [0.3, 0.4], [run]),
                                  [0.3, 0.4])


def test_what_the_forward_model_raises_is_raised():
    problem, noise, _ = made(held_out=1)
    problem.predict.fails = True
    with pytest.raises(ConvergenceError, match="a motion"):
        with_own_parameters(problem, [noise["run_2"]], problem.nominal, np.zeros(8), problem.held_out)
