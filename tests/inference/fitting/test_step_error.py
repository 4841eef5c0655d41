"""The error of the time step: found by half of it, refined where it matters, left alone where it does not."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import BrakechainError, UnsettledStepError
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import continued, fit
from pipeline.inference.fitting.noise import budget
from pipeline.inference.fitting.step_error import as_stated, changed, halved, longest, refined
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from pipeline.inference.rules import RefitRules

TIME, RATE = np.arange(200) / 100, 100.0


def decays(std, asked=None, steps=2):
    """A run that shows exp(-t), and a model exp(-a t) by the midpoint rule, ``steps`` a time unit of 0.2."""
    def predict(hypothesis, values, run):
        step = 0.2 / steps / 2**hypothesis.halvings
        if asked is not None:
            asked.append(hypothesis.halvings)
        a = values["a"] * step
        return ((1 - a + a**2 / 2) ** (TIME / step))[None]

    noise = std * np.random.default_rng(3).standard_normal(len(TIME))
    run = Observed("a", {}, ("y",), (np.exp(-TIME) + noise)[None], RATE, noise_std=np.array([std]))
    parameters = (Parameter("a", "1/s", 1.2, Normal(1.2, 0.5)),)
    problem = Problem((run,), predict, Hypothesis("nominal", (), parameters))
    start = problem.nominal.nominal
    return problem, fit(problem, [budget(problem)["a"]], problem.nominal, start, problem.runs)


@pytest.mark.exact
def test_half_the_step_changes_three_quarters_of_an_error_of_order_two():
    problem, whole = decays(1e-4, steps=8)
    finer, exact = halved(problem, whole), whole.values["a"]
    error = np.exp(-exact * TIME) - problem.predict(whole.hypothesis, whole.values, problem.runs[0])[0]
    assert changed(whole, finer)[0] == pytest.approx((0.75 * error / 1e-4) @ (0.75 * error / 1e-4), rel=0.05)


def test_a_step_whose_error_matters_is_halved_until_it_does_not():
    problem, whole = decays(1e-4)
    better = refined(problem, RefitRules(), whole)
    assert better.hypothesis.halvings >= 2 and better.converged
    assert better.step_error < changed(whole, halved(problem, whole))[0] / 10
    assert abs(better.values["a"] - 1) < 0.2 * abs(whole.values["a"] - 1)


def test_a_step_whose_error_does_not_matter_costs_one_prediction_more():
    asked = []
    problem, whole = decays(0.1, asked)
    asked.clear()
    same = refined(problem, RefitRules(), whole)
    assert asked == [1] and same.hypothesis is whole.hypothesis and same.latent is whole.latent
    assert 0 < same.step_error < 1e-3 * len(TIME)


def test_steps_are_doubled_only_as_far_as_the_nominal_model_stays_what_it_is():
    noisy, near, fine = (decays(std)[0] for std in (3.0, 0.3, 1e-5))
    doubled = [longest(problem, [budget(problem)["a"]], RefitRules()) for problem in (noisy, near, fine)]
    assert doubled[0] < doubled[1] < doubled[2] == 0 and doubled[0] >= -3


def test_what_was_fitted_with_long_steps_ends_where_stated_ones_lead():
    problem, whole = decays(2e-3, steps=8)
    longer = replace(problem.nominal, halvings=-2)
    rough = fit(problem, whole.noises, longer, whole.latent, problem.runs)
    stated = as_stated(problem, RefitRules(), rough)
    std = np.sqrt(whole.covariance()[0, 0])
    assert abs(rough.latent[0] - whole.latent[0]) > 2 * std > 10 * abs(stated.latent[0] - whole.latent[0])
    assert stated.hypothesis.halvings == 0 and stated.objective == pytest.approx(whole.objective, rel=1e-4)
    assert as_stated(problem, RefitRules(), whole) is whole
    assert refined(problem, RefitRules(), rough).hypothesis.halvings >= 0


def unsettled(problem, settles):
    """The Problem with a forward model whose steps do not settle where ``settles(halvings, values)`` is not true."""
    def predict(hypothesis, values, run):
        if not settles(hypothesis.halvings, values):
            raise UnsettledStepError("time stepping", "a force that settles", "none", "take a shorter step")
        return problem.predict(hypothesis, values, run)

    return replace(problem, predict=predict)


def test_steps_that_do_not_settle_are_halved_where_a_fit_begins():
    problem, whole = decays(0.1)
    begun = linearised(unsettled(problem, lambda halvings, values: halvings >= 1), whole.noises, problem.nominal,
                       whole.latent, problem.runs)
    assert begun.hypothesis.halvings == 1 and begun.objective == pytest.approx(whole.objective, rel=1e-2)
    with pytest.raises(BrakechainError, match="a force that settles"):
        linearised(unsettled(problem, lambda halvings, values: False), whole.noises, problem.nominal, whole.latent,
                   problem.runs)


def test_a_fit_whose_steps_do_not_settle_on_the_way_begins_again_with_shorter_ones():
    problem, whole = decays(1e-4)
    begun = replace(linearised(problem, whole.noises, problem.nominal, problem.nominal.nominal, problem.runs),
                    jacobians=(np.zeros((len(TIME), 1)),), fresh=False)
    ended = continued(unsettled(problem, lambda halvings, values: halvings >= 1), begun)
    assert ended.hypothesis.halvings == 1 and ended.converged and ended.objective < begun.objective
