"""What a linearisation about the nominal values says: against the closed form of a linear problem."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.diagnosis.experiment_design.what_runs_tell import telling
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem

TIME = np.linspace(0, 1, 400)


def posed(columns):
    """A problem that is linear in as many values as ``columns`` {name: (n,)}, and a candidate ramp."""
    def predict(hypothesis, values, run):
        shapes = columns | {"ramp": TIME}
        return sum((values[p.name] * shapes[p.name] for p in hypothesis.parameters), np.zeros(400))[None]

    def parameter(name, null=None):
        return Parameter(name, "1", 0.0, Normal(0.0, 1.0), null)

    run = Observed("a", {}, ("x",), np.sin(20 * TIME)[None], 400.0, noise_std=np.array([0.1]))
    problem = Problem((run,), predict, Hypothesis("nominal", (), tuple(map(parameter, columns))))
    ramp = Hypothesis("ramp at x", (("ramp", "x"),), (parameter("ramp", 0.0),), "physics")
    return SimpleNamespace(problem=problem, budget=budget(problem), candidates=(ramp,))


@pytest.mark.exact
def test_values_and_power_are_those_of_linear_algebra():
    wave = np.cos(30 * TIME)
    found = telling(posed({"wave": wave}), 1, 10.0)
    assert found.kept["wave"] == pytest.approx(1 / np.sqrt(1 + wave @ wave / 0.01), rel=1e-3)
    assert found.power["ramp at x"] == pytest.approx(
        np.sqrt(100 * (TIME @ TIME - 100 * (wave @ TIME)**2 / (1 + 100 * wave @ wave))), rel=0.01)
    assert not found.silent and not found.pairs and not found.untried


def test_a_value_without_effect_is_silent_and_twins_go_together():
    wave = np.cos(30 * TIME)
    found = telling(posed({"none": 0 * TIME, "one": wave, "other": wave}), 1, 10.0)
    assert found.silent == ("none",) and [pair[:2] for pair in found.pairs] == [("one", "other")]


def test_candidates_beyond_the_budget_are_told():
    assert telling(posed({"wave": TIME**2}), 1, -1.0).untried == ("ramp at x",)
