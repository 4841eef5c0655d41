"""Hidden values beside laws, on falling balls that SciPy integrated."""

from dataclasses import replace

import pytest

from pipeline.inference.fitting.noise import budget
from pipeline.inference.nuisances import with_those
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis
from pipeline.inference.procedure import diagnose
from tests.inference import falling_ball
from tests.inference.falling_ball import CATALOGUE

ZERO = Hypothesis("zero", (), (Parameter("zero", "m", 0.0, Normal(0.0, 20.0), null=0.0),))
PULL = Hypothesis("pull", (), (Parameter("pull", "m/s^2", 0.0, Normal(0.0, 10.0), null=0.0),))
DECLARED = (ZERO, PULL)


def _predict(hypothesis, values, run):
    """Ways of balls that something pulls on, seen from another height."""
    pulled = {**values, "gravity": values["gravity"] - values.get("pull", 0.0)}
    return falling_ball.predict(hypothesis, pulled, run) + values.get("zero", 0.0)


def _bench(drag, zero=0.0):
    problem = falling_ball.bench(drag)[0]
    runs = tuple(replace(run, samples=run.samples + zero) for run in problem.runs)
    problem = replace(problem, runs=runs, predict=_predict)
    return problem, budget(problem)


def _quadratic(speed):
    return 0.05 * speed * abs(speed)


def _told(bench, declared=DECLARED):
    return diagnose(*bench, CATALOGUE, declared=declared)


def _within(fit, name, true):
    return abs(fit.values[name] - true) < 4 * fit.spread()[name]


@pytest.mark.parametrize("zero, pull", [(0.6, 0.0), (0.0, 1.5), (-0.3, 1.0)])
def test_a_law_is_named_beside_hidden_values_that_the_data_ask_for(zero, pull):
    told = _told(_bench(lambda speed: _quadratic(speed) + pull, zero))
    assert (told.decision.verdict, [c.name for c in told.decision.named]) == ("missing", ["quadratic"])
    fit = told.named[0].fit
    assert _within(fit, "quadratic", 0.05)
    for name, true in (("zero", zero), ("pull", pull)):
        assert _within(fit, name, true) if name in fit.values else not true
    assert any("hidden values that the data ask for" in why for why in told.decision.reasons)


def test_without_being_declared_they_hide_the_law():
    told = _told(_bench(lambda speed: _quadratic(speed) + 1.0, -0.3), ())
    assert (told.decision.verdict, [c.name for c in told.decision.named]) != ("missing", ["quadratic"])


def test_a_hidden_value_is_no_missing_physics():
    told = _told(_bench(lambda speed: 1.5))
    assert told.decision.verdict in ("consistent", "parameters"), told.decision.reasons
    assert _within(told.null, "pull", 1.5)


def test_what_a_law_alone_asked_for_vanishes_beside_it():
    told = _told(_bench(_quadratic))
    assert (told.decision.verdict, [c.name for c in told.decision.named]) == ("missing", ["quadratic"])
    assert _within(told.completed, "pull", 0.0)


def test_what_the_data_do_not_ask_for_changes_nothing():
    bench = _bench(lambda speed: 0.0)
    told, plain = _told(bench), _told(bench, ())
    assert told.decision.verdict == plain.decision.verdict == "consistent"
    assert told.completed.values == plain.completed.values
    assert told.decision.reasons[-1] == "declared as nuisances, and not asked for by the data: zero, pull"


def test_they_join_the_nominal_values():
    problem = _bench(_quadratic)[0]
    joined = with_those(problem, DECLARED).nominal
    assert [p.name for p in joined.parameters] == ["gravity", "zero", "pull"]
    assert joined.name == problem.nominal.name and not joined.effects
