"""Start states of what effects add: where a free motion begins, a hidden mass on a spring moves as well.

Candidates that add coordinates get two parameters of each for every run whose start is unknown, of its displacement and
velocity at the first sample: how far, or how fast, the others would have to be for their springs to move it as much
beyond where they hold it. The prior is as wide as the energy of the start would move these: a part that rings several
times as far as what it hangs on is a rare one, and one that may go anywhere makes up for any decay.
"""

from dataclasses import replace

from pipeline.case_models.force_balance import body_names
from pipeline.diagnosis.signals.forward_model import completed
from pipeline.diagnosis.signals.start_states import StartSpread, own_start
from pipeline.inference.priors import Normal, Parameter


def with_added_starts(bench, candidates, recorded):
    """The ``candidates`` (Hypothesis, ...) for a Bench, with starts of their own coordinates in {name: Recorded}."""
    unknown = [record for record in recorded.values() if isinstance(record.unknown, StartSpread)]
    return tuple(_with_own_starts(bench, candidate, unknown) for candidate in candidates) if unknown else candidates


def _with_own_starts(bench, candidate, records):
    changed = completed(bench, candidate, {p.name: p.nominal for p in candidate.parameters})
    added = body_names(changed)[bench.model.size:]
    own = [Parameter(own_start(record.run.name, field, name), unit, 0.0,
                     Normal(0.0, float(getattr(record.unknown, field).max())), run=record.run.name)
           for record in records for field, unit in (("displacement", "m"), ("velocity", "m/s"))
           for name in added]
    return replace(candidate, parameters=(*candidate.parameters, *own)) if own else candidate
