"""Before a diagnosis: what recorded runs can tell, from one linearisation about the nominal values, and what it costs.

In latent coordinates every prior has standard deviation 1, so that the posterior standard deviation of a value,
sqrt((J'J + I)^-1), is what the runs leave of what the case says of it.
"""

import time
from dataclasses import dataclass

import numpy as np

from pipeline.contract import BrakechainError
from pipeline.diagnosis.campaign_planning import change
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.planning import campaign
from pipeline.inference.regular import inverse

#: share of its prior that a value keeps where runs say next to nothing; correlation of two that only go together
_KEPT, _TOGETHER = 0.9, 0.97
#: share of its prior below which a value is known well enough beside another
_WORTH = 0.1
#: CPU s of a diagnosis whatever the model; predictions of all runs per parameter of the calibration, per candidate, per
#: value of a refit: fitted to the synthetic benches, where it holds within a factor of about two
_ALWAYS, _CALIBRATION, _SCREENED, _REFITTED = 15.0, 48, 8, 48


@dataclass(frozen=True)
class Telling:
    """What runs tell: ``kept`` {parameter: posterior over prior standard deviation}, ``silent`` ones that move next to
    nothing, ``pairs`` [(a, b, correlation)] that only go together; ``power`` {candidate: d}, ``untried`` candidates;
    ``seconds`` of a prediction of all runs, ``cost`` in CPU s of a diagnosis; ``sensors``: candidates that are of a
    sensor; ``alike`` {run: {channel: correlation of predicted and recorded}}, ``size`` {the same: rms predicted over
    recorded}."""

    kept: dict
    silent: tuple
    pairs: list
    power: dict
    untried: tuple
    seconds: float
    cost: float
    sensors: frozenset
    alike: dict
    size: dict


def telling(posed, kept, budget):
    """Telling of a DiagnosisProblem; candidates are tried for ``budget`` s; ``kept``: candidates that it would refit.

    Raises what the forward model raises at the nominal values.
    """
    problem, runs = posed.problem, posed.problem.training
    hypothesis, begun = problem.nominal, time.process_time()
    nulls = [linearised(problem, [posed.budget[run.name]], hypothesis, hypothesis.nominal, [run]) for run in runs]
    evaluations = sum(null.evaluations for null in nulls) / max(len(nulls), 1)
    seconds = (time.process_time() - begun) / max(evaluations, 1)
    of_values = _of_values(hypothesis, np.concatenate([null.jacobians[0] for null in nulls]))
    power = _of_effects(posed, nulls, begun + budget)
    values, count = len(hypothesis.parameters), len(posed.candidates)
    cost = _ALWAYS + seconds * (_CALIBRATION * (values + 1) + _SCREENED * count
                                + _REFITTED * (kept + count / 4) * (values + 2))
    beside = {run.name: _beside(problem, run) for run in runs}
    alike, size = ({name: {c: pair[k] for c, pair in each.items()} for name, each in beside.items()} for k in (0, 1))
    return Telling(*of_values, power, tuple(c.name for c in posed.candidates if c.name not in power), seconds,
                   float(cost), frozenset(c.name for c in posed.candidates if c.kind == "sensor"), alike, size)


def _of_values(hypothesis, jacobian):
    """(kept, silent, pairs) of a Telling, of the values that runs share."""
    covariance = inverse(jacobian.T @ jacobian + np.eye(jacobian.shape[1]))
    std = np.sqrt(np.diag(covariance))
    correlation, names = covariance / np.outer(std, std), [p.name for p in hypothesis.parameters]
    shared = [k for k, p in enumerate(hypothesis.parameters) if not p.run]
    alone = 1 / np.sqrt(1 + np.sum(jacobian**2, axis=0))
    return ({names[k]: float(std[k]) for k in shared}, tuple(names[k] for k in shared if alone[k] > _KEPT),
            [(names[i], names[j], float(correlation[i, j])) for i in shared for j in shared
             if i < j and abs(correlation[i, j]) > _TOGETHER and max(std[i], std[j]) > _WORTH])


def _of_effects(posed, nulls, until):
    """{candidate: d} of those that can be tried before the instant ``until``."""
    directions, tried = [[] for _ in nulls], []
    for candidate in posed.candidates:
        if time.process_time() > until:
            break
        try:
            changes = [change(posed.problem, null, candidate) for null in nulls]
        except BrakechainError:
            continue
        tried.append(candidate.name)
        for each, moved in zip(directions, changes, strict=True):
            each.append(moved)
    power = campaign.combined_power(directions, [null.jacobians[0] for null in nulls], range(len(nulls)))
    return dict(zip(tried, map(float, power), strict=True))


def _beside(problem, run):
    """{channel: (correlation, ratio of sizes)} of what the nominal values predict of a run and what was recorded."""
    nominal = problem.nominal
    predicted = np.asarray(problem.predict(nominal, nominal.values(nominal.nominal), run), float)
    both = {c: (predicted[k, run.valid[k]], run.samples[k, run.valid[k]]) for k, c in enumerate(run.channels)}
    return {c: (_correlation(p, s), float(_rms(p) / _rms(s)) if _rms(s) else 1.0) for c, (p, s) in both.items()}


def _rms(values):
    return np.sqrt(np.mean((values - values.mean())**2)) if len(values) else 0.0


def _correlation(one, other):
    return float(np.corrcoef(one, other)[0, 1]) if len(one) > 2 and np.ptp(one) > 0 and np.ptp(other) > 0 else 0.0
