"""Solver error as a nuisance: every prediction may be off by about what halving step and mesh changes in it.

With e the change (Richardson: the error of the coarse solution is e times 1 / (1 - 2^-order)), the prediction becomes
y + a e with a ~ N(0, 1) shared by all runs, and a is marginalised with the nominal parameters. Unlike a power added to
the noise this holds for errors that are as regular as the signal itself (a phase lag, a numerical damping).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.inference.priors import Normal, Parameter

NAME = "solver_error"


@dataclass(frozen=True)
class _Corrected:
    """Picklable prediction with the nuisance, which the model itself never sees."""

    predict: Callable
    change: dict

    def __call__(self, hypothesis, values, run):
        own = replace(hypothesis, parameters=tuple(p for p in hypothesis.parameters if p.name != NAME))
        inner = {name: value for name, value in values.items() if name != NAME}
        change = self.change[run.name][:, :run.samples.shape[1]]
        return np.asarray(self.predict(own, inner, run)) + values[NAME] * change


def allow(problem, change):
    """Problem with the nuisance: ``change`` {run name: (c, n)}, finer less coarser prediction of every run.

    Raises ConfigError where a run lacks its change or has it in another shape.
    """
    for run in problem.runs:
        if np.shape(change.get(run.name)) != run.samples.shape:
            raise ConfigError(f"solver error of run {run.name}", f"an array of shape {run.samples.shape}",
                              str(np.shape(change.get(run.name))), "predict every run with halved step and mesh")
    nuisance = Parameter(NAME, "1", 0.0, Normal(0.0, 1.0))
    nominal = replace(problem.nominal, parameters=(*problem.nominal.parameters, nuisance))
    return replace(problem, predict=_Corrected(problem.predict, dict(change)), nominal=nominal)
