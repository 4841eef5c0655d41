"""Runs that a diagnosis can use: those that it cannot are left out, with a sentence for each, as long as some are left.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract import BrakechainError, ConfigError


def usable(runs, make=lambda record: record):
    """({name: what ``make`` makes of a Recorded run}, {name: why a run is left out}) of {name: Recorded}.

    Runs are left out of which no sample counts, or of which ``make`` says that it cannot use them. Raises what the
    first of these says where none is left.
    """
    made, refused = {}, {}
    for name, record in runs.items():
        try:
            made[name] = make(_counting(record))
        except BrakechainError as error:
            refused[name] = error
    if runs and not made:
        raise next(iter(refused.values()))
    for name in made:
        if runs[name].repeat_of and runs[name].repeat_of not in made:       # what it repeats is left out
            made[name] = make(replace(runs[name], repeat_of=""))
    return made, {name: f"left out, {error}" for name, error in refused.items()}


def without(settings, refused):
    """The section ``diagnosis`` with no run held out that was ``refused`` {name: why}. ConfigError where all that is
    left is held out."""
    return settings.model_copy(update={"held_out": tuple(r for r in settings.held_out if r not in refused)})


def doubts(runs, inputs=()):
    """Sentences on channels of {name: Recorded} that measured nothing, or the same as another, and on ``inputs`` that
    do nothing in any run."""
    for name, record in runs.items():
        for k, (samples, valid) in enumerate(zip(record.samples, record.valid, strict=True)):
            twin = next((j for j in range(k) if np.array_equal(valid, record.valid[j])
                         and np.array_equal(samples[valid], record.samples[j][valid])), None)
            if twin is not None and valid.any():
                yield (f"channels {record.channels[twin]} and {record.channels[k]} of run {name} are copies of one"
                       " another: they count twice as much as was measured, and tell nothing of two places; leave one"
                       " out of bench.channels")
            elif valid.sum() > 1 and not np.ptp(samples[valid]):
                yield (f"channel {record.channels[k]} of run {name} holds one value throughout: a sensor that was off"
                       " or not moved; leave it out where it was off")
    for fed in inputs:
        histories = [record.run.inputs[fed] for record in runs.values() if fed in record.run.inputs]
        if histories and not any(np.any(history) for history in histories):
            yield (f"input {fed} is zero in all runs, and so tells nothing: name the channel that recorded what was"
                   f" applied in bench.inputs.{fed}.channel")


def _counting(record):
    """A Recorded run of which some sample counts. ConfigError for others."""
    if not record.valid.any():
        raise ConfigError(f"run {record.run.name}", "samples that count", "none",
                          "record longer than bench.settle, or leave the run out")
    return record
