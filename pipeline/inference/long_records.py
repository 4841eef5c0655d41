"""Long records: what they show is found on their beginnings, then fitted to and judged by the whole of them.

A prediction costs as much as a run is long, and most of them are made where it hardly matters how long it is: to rank
candidates, and on the way to their optima. So all is tried on the beginnings of long runs, long enough to move as the
whole of them does; what led there is fitted to all samples from where it ended, beside what the whole record's screen
finds overlooked, and only that is decided by.
"""

from dataclasses import replace

import numpy as np

#: samples of all fitted runs together that are taken for the beginnings, where there are twice as many, and of each
MANY, _FEWEST = 6_000, 500
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
