"""Hidden values that a case declares as nuisances: fitted beside every hypothesis where the data ask for them.

A weight that nobody stated, a zero that is off, the cogging of a motor are no missing physics, but hide it or look like
it. Each declared one is a Hypothesis of parameters that vanish at their nulls. Those join the nominal ones whose log
evidence beside the recalibrated model pays for their prior, one after the other. What a law hides shows beside the
best one, where that leaves more than noise: then all is asked once more.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.contract.errors import BrakechainError, first_of
from pipeline.inference.decision.evidence import screened
from pipeline.inference.fitting.calibration import recalibrate
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.long_records import beginnings
from pipeline.inference.search.score_screen import directions, screen
from pipeline.inference.time_budget import spent


def told_beside(asked, declared, motions):
    """(what was Asked with those of the ``declared`` Hypotheses among its nominal values that the data ask for, its
    Diagnosis)."""
    if not declared:
        return asked, asked.told(motions)
    taken = _asked_for(asked, declared)
    beside = replace(asked, problem=with_those(asked.problem, taken))
    told = beside.told(motions)
    rest = tuple(one for one in declared if one not in taken)
    more = () if told.cut_short else _beside_the_best(beside, told, rest)
    if more:
        taken, rest = (*taken, *more), tuple(one for one in rest if one not in more)
        beside = replace(asked, problem=with_those(asked.problem, taken))
        told = beside.told(motions)
    return beside, told.remarked(*_said(taken, rest))


def with_those(problem, nuisances):
    """The Problem with the parameters of these Hypotheses among its nominal ones."""
    nominal = problem.nominal
    parameters = (*nominal.parameters, *(p for one in nuisances for p in one.parameters))
    return replace(problem, nominal=replace(nominal, parameters=parameters))


def _asked_for(asked, declared):
    """Those of the ``declared`` that the data ask for beside the recalibrated nominal model, the most telling first."""
    problem, budget = beginnings(asked.problem, asked.budget) or (asked.problem, asked.budget)
    rules, left, taken = asked.settings.rules.calibration, list(declared), []
    try:
        null = recalibrate(problem, budget, rules).null
        while left and not spent():
            best = _most_telling(asked, problem, null, left)
            if best is None:
                break
            taken.append(left.pop(left.index(best)))
            problem = with_those(problem, (best,))
            start = linearised(problem, null.noises, problem.nominal, np.concatenate((null.latent, best.nominal)),
                               null.runs)
            null = recalibrate(problem, budget, rules, start).null
    except BrakechainError:         # the diagnosis itself tells what cannot be fitted
        pass
    return tuple(taken)


def _beside_the_best(asked, told, left):
    """Those ``left`` that the data ask for beside the best law of a Diagnosis, if it leaves more than noise."""
    best = min((w.fit for w in told.weighed), key=lambda fit: fit.objective, default=told.null)
    if not left or best is told.null or best.reaches_noise(asked.settings.rules.decision.noise_uncertainty):
        return ()
    problem = replace(asked.problem, nominal=best.hypothesis)
    gains = _gains(asked, problem, best, left)
    return tuple(one for one, gain in zip(left, gains, strict=True) if gain > _enough(asked))


def _most_telling(asked, problem, null, left):
    gains = _gains(asked, problem, null, left)
    best = int(np.argmax(gains))
    return left[best] if gains[best] > _enough(asked) else None


def _gains(asked, problem, null, left):
    """Log evidence (n,) that each of the Hypotheses ``left`` is worth beside a Fit, linearised there."""
    every = list(asked.fan_out(partial(directions, problem, null), left))
    seen = screen(null, every, null.weights, draws=0, rules=asked.settings.rules.screening)
    return np.where(np.isfinite(seen.score), screened(0.0, seen.score, seen.power), -np.inf)


def _enough(asked):
    return asked.settings.rules.decision.evidence_gain


def _said(taken, rest):
    """Sentences on which of the declared nuisances count."""
    def names(each):
        return first_of([p.name for one in each for p in one.parameters], 6)

    if taken:
        yield f"hidden values that the data ask for are fitted beside every hypothesis: {names(taken)}"
    if rest:
        yield f"declared as nuisances, and not asked for by the data: {names(rest)}"
