"""Stops that squeal as records of poles: the mode that grows between noise floor and saturation.

Every stop at one operating point (a run and its repeats) is read by itself; their mean is the pole, whose error holds
the errors of the single stops and their spread. A stop that tells no growth is left out, with the reason.
"""

from dataclasses import dataclass
from fnmatch import fnmatch

import numpy as np

from pipeline.contract import ConfigError
from pipeline.physics.signals.onsets.growth_rate import Growth, growth, mean, spread_of
from pipeline.physics.signals.pole_identification import Poles
from pipeline.physics.signals.squeal_features import SATURATED, state
from pipeline.physics.virtual_rig.modes import motions
from pipeline.physics.virtual_rig.response import at_begin
from pipeline.physics.virtual_rig.sensor import VELOCITY

#: stretches in s by which a record is told to grow until it saturates
_STRETCH = 20e-3


def squeals(bench, record, onset):
    """Whether a Recorded run is a stop that squeals, under a section Onset: it is named, or its motions saturate."""
    if onset is None:
        return False
    if onset.runs:
        return any(fnmatch(record.run.name, pattern) for pattern in onset.runs)
    there = [record.channels.index(c.name) for c in motions(bench) if c.name in record.channels]
    turning = bool(there) and at_begin(bench, record.run)[0] != 0
    return turning and state(record.samples[there], round(_STRETCH * record.run.sample_rate)) == SATURATED


@dataclass(frozen=True)
class Stop:
    """What the stops at one operating point show: ``seen`` Poles, of the motion ``channels`` (indices), ``stops`` {run:
    Growth or the reason why it tells none}."""

    seen: Poles
    channels: tuple
    stops: dict


def stops_of(bench, recorded, settings):
    """{run: Stop} of {name: Recorded}, repeats with the run that they repeat; ``settings`` the section ``bench.poles``.

    How far single stops spread is estimated from all operating points together.
    """
    points = {name: [record, *(other for other in recorded.values() if other.repeat_of == name)]
              for name, record in recorded.items() if not record.repeat_of and squeals(bench, record, settings.onset)}
    told = {name: {record.run.name: _read(bench, record, settings) for record in records}
            for name, records in points.items()}
    growths = {name: [stop for stop in stops.values() if isinstance(stop, Growth)] for name, stops in told.items()}
    spread = spread_of(growths.values())
    return {name: Stop(_mean(bench, channels_of(bench, records[0]), growths[name], spread),
                       channels_of(bench, records[0]), told[name]) for name, records in points.items()}


def _mean(bench, channels, growths, spread):
    """Poles of [Growth] at one operating point: one, or none."""
    if not growths:
        return Poles(np.zeros(0, complex), np.zeros(0), np.zeros((0, len(channels)), complex))
    result = mean(growths, spread)
    power = np.array([VELOCITY.order - motions(bench)[k].measurand.order for k in channels])
    return Poles(np.array([result.root]), np.array([result.std]), (result.shape * result.root**power)[None])


def channels_of(bench, record):
    """Indices of the motion channels of a bench that a Recorded run holds."""
    return tuple(k for k, c in enumerate(motions(bench)) if c.name in record.channels)


def _read(bench, record, settings):
    """Growth of a Recorded stop, or the reason why it tells none."""
    names = [motions(bench)[k].name for k in channels_of(bench, record)]
    samples = record.samples[[record.channels.index(name) for name in names]]
    lost = int((~record.valid).any(axis=0).sum())
    if lost:
        return f"{lost} lost samples"
    try:
        result = growth(samples, record.run.sample_rate, settings.low, settings.high, settings.onset.share)
    except ConfigError as error:
        return f"expected {error.expected}, found {error.found}"
    return _changed(record, result, settings.onset.held) or result


def _changed(record, result, held):
    """'pressure changes by 12% in the window', of the first channel that does not hold; '' where all do."""
    first, last = (round(t * record.run.sample_rate) for t in (result.begin, result.end))
    for name, most in held.items():
        if name not in record.channels:
            raise ConfigError(f"run {record.run.name}: bench.poles.onset.held", f"one of {', '.join(record.channels)}",
                              repr(name), "declare the channel in bench.channels")
        part = record.samples[record.channels.index(name), first:last + 1]
        ends = np.array([p.mean() for p in np.array_split(part, 4)])    # of quarters: noise is no change
        if np.ptp(ends) > most * abs(ends.mean()):
            return f"{name} changes by {np.ptp(ends) / abs(ends.mean()):.0%} while it grows"
    return ""
