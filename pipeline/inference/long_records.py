"""Long records: what they show is found on their beginnings, then fitted to and judged by the whole of them.

A prediction costs as much as a run is long, and most of them are made where it hardly matters how long it is: to rank
candidates, and on the way to their optima. So all is tried on the beginnings of long runs, long enough to move as the
whole of them does; what led there is fitted to all samples from where it ended, beside what the whole record's screen
finds overlooked, and only that is decided by.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.inference.diagnosis import decided
from pipeline.inference.fitting.begins import begun_as
from pipeline.inference.fitting.calibration import Calibration
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import continued
from pipeline.inference.fitting.refitting import brought_on
from pipeline.inference.search.score_screen import screen_catalogue
from pipeline.inference.time_budget import share, spent, within

#: samples of all fitted runs together that are taken for the beginnings, where there are twice as many, and of each
MANY, _FEWEST = 6_000, 500
#: part of the time that goes to the beginnings at most
_BEGINNINGS = 0.6
#: the motion of a beginning must be this large a share of what its part of the whole would have
_LIVELY = 0.5


def beginnings(problem, budget):
    """(Problem, {run: Noise}) of the beginnings of a Problem's runs, or None where these are not long or have no order
    in time."""
    noises = [budget[run.name] for run in problem.training]
    many = sum(noise.length for noise in noises)
    if many < 2 * MANY or not all(budget[run.name].ordered for run in problem.runs):
        return None
    ends = {run.name: _end(run, budget[run.name], MANY / many) for run in problem.runs}
    return (replace(problem, runs=tuple(run.until(ends[run.name]) for run in problem.runs)),
            {name: noise.until(ends[name]) if name in ends else noise for name, noise in budget.items()})


def _end(run, noise, share):
    """Number of samples of the beginning of an Observed run: a ``share`` of the usable ones, or as many more as it
    takes until it moves as the whole does."""
    first, usable = noise.horizon(share, _FEWEST), noise.usable
    values = np.where(usable, run.samples, 0.0)
    mean = values.sum(axis=1, keepdims=True) / np.maximum(usable.sum(axis=1, keepdims=True), 1)
    power = usable * (values - mean) ** 2
    moved = np.cumsum((power / np.maximum(power.sum(axis=1, keepdims=True), 1e-300)).mean(axis=0))
    lively = int(np.searchsorted(moved, _LIVELY * share * moved[-1])) + 1
    return max(first, lively)


def on_the_whole(asked, shorter, motions):
    """Diagnosis of what the beginnings of the runs, asked ``shorter``, came to; None where these mislead: what they
    found consistent, or named, the whole of the runs calls unknown, and something else leads there, or their values
    cannot predict it."""
    with share(_BEGINNINGS):
        first = shorter.diagnosed(motions)
    try:
        told = replace(_as_found(asked, first), combinations=first.combinations)
    except BrakechainError:
        return None
    names = {c.name for c in first.decision.named}
    lead = next((w.candidate.name for w in told.weighed), None)
    misled = told.decision.verdict == "unknown" != first.decision.verdict and lead not in names
    if misled and not spent():
        return None
    with within(np.inf):
        return asked.of_its_form(told.ended() if first.cut_short else told)


def _as_found(asked, first):
    """Diagnosis, by the runs of what was ``asked``, of the hypotheses that a Diagnosis ``first`` of parts of them has
    fitted, begun at its values, and of what it overlooks."""
    base, settings = first.base and _as_found(asked, first.base), asked.settings
    problem, catalogue = replace(asked.problem, nominal=first.nominal), first.refits.refitter.catalogue
    noises = tuple(asked.budget[run.name] for run in problem.training)
    fits = {i: r.fit for i, r in first.refits.results.items() if r.fit}
    best = sorted(fits, key=lambda i: fits[i].objective)[:settings.kept]
    with within(np.inf):        # as they are, in any case
        null = linearised(problem, noises, first.nominal, first.null.latent, problem.training)
        begins = {i: begun_as(problem, noises, fits[i]) for i in best}
    null = continued(problem, null, patient=False)
    screening = screen_catalogue(Calibration(problem, asked.budget, null), catalogue, settings, asked.fan_out,
                                 base is not None)
    refits = brought_on(screening, catalogue, begins, settings, asked.fan_out)
    return decided(refits, settings, base, first.laws)
