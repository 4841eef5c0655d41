"""Two runs that show a constant and a tone, of which the nominal model knows the constant alone."""

from dataclasses import replace

import numpy as np

from pipeline.inference.fitting.calibration import calibrate
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter, Uniform
from pipeline.inference.problem import Hypothesis, Observed, Problem

RATE, SAMPLES, STD = 100.0, 500, 0.1
TIME = np.arange(SAMPLES) / RATE
RIPPLE = Hypothesis("ripple", (("ripple", "here"),), (
    Parameter("force", "N", 0.1, HalfNormal(1.0), null=0.0), Parameter("frequency", "Hz", 2.0, LogNormal(2.0, 1.0)),
    Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi))))
DRAG = Hypothesis("drag", (("drag", "here"),), (Parameter("force", "N", 0.1, HalfNormal(1.0), null=0.0),))
TRUE = {"force": 0.7, "frequency": 3.37, "phase": -1.1}


def predict(hypothesis, values, run):
    """A constant and a tone; the second run shows twice of both."""
    tone = values.get("force", 0.0) * np.cos(2 * np.pi * values.get("frequency", 1.0) * TIME - values.get("phase", 0.0))
    return run.conditions["scale"] * (values["level"] + tone)[None]


def null_of(true):
    """(Problem, Fit of the constant alone) of two runs that show what is ``true``."""
    noise = np.random.default_rng(0)
    nominal = Hypothesis("nominal", (), (Parameter("level", "m", 1.0, Normal(1.0, 0.3)),))
    runs = []
    for name, scale in (("one", 1.0), ("two", 2.0)):
        run = Observed(name, {"scale": scale}, ("x",), np.zeros((1, SAMPLES)), RATE, noise_std=np.array([STD]))
        shown = predict(nominal, {"level": 1.2, **true}, run) + STD * noise.standard_normal((1, SAMPLES))
        runs.append(replace(run, samples=shown))
    problem = Problem(tuple(runs), predict, nominal)
    noises = tuple(budget(problem)[run.name] for run in problem.training)
    return problem, calibrate(problem, noises, nominal, [nominal.nominal], problem.training)
