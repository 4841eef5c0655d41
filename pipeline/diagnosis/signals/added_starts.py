"""Start states of what effects add: where a free motion begins, a hidden mass on a spring moves as well.

Candidates that add coordinates get two parameters of each for every run whose start is unknown, its displacement and
velocity at the first sample. They begin from where the springs of the others hold it; the prior is as wide as the
energy of the start would move it alone.
"""

from dataclasses import replace

import numpy as np

from pipeline.diagnosis.signals.forward_model import completed
from pipeline.diagnosis.signals.start_states import StartSpread, energy_reach, held, vibrations


def with_added_starts(bench, candidates, recorded):
    """The ``candidates`` (Hypothesis, ...) for a Bench, with starts of their own coordinates in {name: Recorded}."""
    unknown = [record.run for record in recorded.values() if isinstance(record.unknown, StartSpread)]
    return tuple(_with_own_starts(bench, candidate, unknown) for candidate in candidates) if unknown else candidates


def _with_own_starts(bench, candidate, runs):
    changed = completed(bench, candidate, {p.name: p.nominal for p in candidate.parameters})
    if changed.model.size <= bench.model.size:
        return candidate
    own = [p for run in runs for p in _own_starts(bench.model.size, changed, run)]
    return replace(candidate, parameters=(*candidate.parameters, *own))


def _own_starts(known, changed, run):
    """Parameters of the coordinates of a ``changed`` bench beyond the ``known`` first ones, in one Run."""
    start = held(changed.model, run.start)
    spread = energy_reach(changed.model, np.append(start.displacement, start.velocity), *vibrations(changed, run))
    every = StartSpread(*spread, spread[0]).parameters(changed, replace(run, start=start), False)
    size = changed.model.size
    return (*every[known:size], *every[size + known:])
