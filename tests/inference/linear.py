"""Linear-Gaussian problems for the tests of a diagnosis: every answer has a closed form."""

from functools import partial

import numpy as np

from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem

STD = 0.5


def hypotheses(sizes, prior=1.0):
    """Nominal hypothesis of sizes[0] parameters, then one effect for each further size."""
    names = ("nominal", *(f"effect_{k}" for k in range(1, len(sizes))))
    return [Hypothesis(name, ((name, "here"),) * (k > 0), tuple(
        Parameter(f"{name}_{i}", "1", 0.0, Normal(0.0, prior), 0.0 if k else None) for i in range(size)))
        for k, (name, size) in enumerate(zip(names, sizes, strict=True))]


def predict(tables, hypothesis, values, run):
    """Sum over parameters of value times the run's column, (1, n)."""
    return sum(value * tables[run.name][name] for name, value in values.items())[None, :run.samples.shape[1]]


def problem(sizes=(2, 1), runs=3, samples=60, truth=None, seed=0, held_out=0, prior=1.0):
    """(Problem, its {run: Noise}, catalogue, tables); ``truth`` {name: value}, random columns, noise STD."""
    generator, nominal_and = np.random.default_rng(seed), hypotheses(sizes, prior)
    names = [p.name for h in nominal_and for p in h.parameters]
    tables = {f"run_{r}": {n: generator.standard_normal(samples) for n in names} for r in range(runs)}
    observed = []
    for r, (name, columns) in enumerate(tables.items()):
        clean = sum((value * columns[n] for n, value in (truth or {}).items()), np.zeros(samples))
        noisy = clean + STD * generator.standard_normal(samples)
        observed.append(Observed(name, {"load": float(r)}, ("signal",), noisy[None], 1.0, noise_std=np.array([STD]),
                                 held_out=r >= runs - held_out))
    whole = Problem(tuple(observed), partial(predict, tables), nominal_and[0])
    return whole, budget(whole), nominal_and[1:], tables


def dense(whole, hypothesis, tables):
    """(samples (m,), design (m, k)) in units of the noise."""
    names = [p.name for p in hypothesis.parameters]
    design = np.concatenate([np.array([tables[run.name][n] for n in names]).T for run in whole.training])
    return np.concatenate([run.samples[0] for run in whole.training]) / STD, design / STD
