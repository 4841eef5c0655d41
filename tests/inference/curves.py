"""Small problems without order in time: a curve over a grid, two features of one number, a peak of either of two."""

import numpy as np

from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem


def noises_of(problem, noise):
    return tuple(noise[run.name] for run in problem.training)


def curve_problem(function, parameters, samples, std):
    """One run that shows ``function(values, grid)``; grid of 50 points in [0, 1]."""
    grid = np.linspace(0, 1, 50)
    whole = Problem((Observed("a", {}, ("y",), samples(grid)[None], None, noise_std=np.array([std])),),
                    lambda hypothesis, values, run: function(values, grid)[None], Hypothesis("nominal", (), parameters))
    return whole, (budget(whole)["a"],)


def features(seen, std):
    """Two features that show x and x^2, x ~ N(0, 1)."""
    run = Observed("a", {}, ("one", "two"), np.array([[seen], [seen**2]]), None, noise_std=np.full(2, std))
    whole = Problem((run,), lambda hypothesis, values, run: np.array([[values["x"]], [values["x"] ** 2]]),
                    Hypothesis("nominal", (), (Parameter("x", "1", 0.0, Normal(0.0, 1.0)),)))
    return whole, (budget(whole)["a"],)


def either_of_two(peak, scale, std):
    """Two features: the one of two roots, (10 + 1.5 low) (1 + scale / 10) and (20 + high) (1 + scale / 10), that lies
    nearest the ``peak``, and the ``scale``; all values are N(0, 1)."""
    def predict(hypothesis, values, run):
        whole = 1 + 0.1 * values["scale"]
        roots = whole * np.array([10 + 1.5 * values["low"], 20 + values["high"]])
        return np.array([[roots[np.argmin(abs(roots - peak))]], [values["scale"]]])

    run = Observed("a", {}, ("peak", "scale"), np.array([[peak], [scale]]), None, noise_std=np.full(2, std))
    parameters = tuple(Parameter(name, "1", 0.0, Normal(0.0, 1.0)) for name in ("scale", "low", "high"))
    whole = Problem((run,), predict, Hypothesis("nominal", (), parameters))
    return whole, (budget(whole)["a"],)
