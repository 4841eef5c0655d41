"""Parameters of one run alone, such as its start state, fitted while everything else is held.

A run that was held out has a start too, which no other run tells. It is fitted to the first part of the run under the
values of the model that is judged, and what is judged is the rest of the run.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.problem import Hypothesis

#: samples of the first part for each parameter that is fitted to it, at least
_PER_PARAMETER = 8


@dataclass(frozen=True)
class Held:
    """Forward model of the parameters of one run: ``hypothesis`` with all other ``values`` held, as a problem."""

    whole: Any
    hypothesis: Hypothesis
    values: dict

    def predict(self, _, values, run):
        return self.whole.predict(self.hypothesis, self.hypothesis.in_run(self.values | values, run.name), run)


def first_part(problem, noise, run, share):
    """Number of samples from the begin of ``run`` to which its own parameters are fitted: 0 where none has any.

    The part holds this ``share`` of its usable samples, and a few for each parameter, but no more than half of them
    for these. It is one for all hypotheses of a Problem, so that they are judged by the same samples.
    """
    count = problem.own_parameters(run)
    return noise.horizon(share, min(_PER_PARAMETER * count, noise.length // 2)) if count else 0


def short(problem, budget):
    """A sentence for each held-out run that is too short for as many samples as its own parameters should have."""
    for run in problem.held_out:
        needed, length = _PER_PARAMETER * problem.own_parameters(run), budget[run.name].length
        if needed > length // 2:
            yield (f"the held-out run {run.name} has {length} samples: the {length // 2} to which its unknown start is"
                   f" fitted are few, and the rest judges little; record at least {4 * needed}, or state its start")


def with_own_parameters(problem, noises, hypothesis, latent, runs, share=1.0):
    """Latent coordinates (k,) with the parameters of each of ``runs`` alone fitted to its first ``share``.

    ``noises`` [Noise] belong to ``runs``; all other coordinates stay. Raises what the forward model raises.
    """
    latent, values = np.array(latent, float), hypothesis.values(latent)
    for run, noise in zip(runs, noises, strict=True):
        members = [k for k, p in enumerate(hypothesis.parameters) if p.run == run.name]
        if not members:
            continue
        end = first_part(problem, noise, run, share)
        alone = Hypothesis(f"own parameters of {run.name}", (), tuple(
            replace(hypothesis.parameters[k], of="") for k in members))
        latent[members] = fit(Held(problem, hypothesis, values), (noise.until(end),), alone, latent[members],
                              (run.until(end),)).latent
    return latent


def on_all_runs(problem, budget, fit):
    """Latent coordinates (k,) of a Fit, with the parameters of each held-out run alone fitted to that run."""
    noises = [budget[run.name] for run in problem.held_out]
    return with_own_parameters(problem, noises, fit.hypothesis, fit.latent, problem.held_out)
