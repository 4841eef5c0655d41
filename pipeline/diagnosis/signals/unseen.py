"""Samples that show what nobody states, and that do not count: they are marked as not valid.

- The filter and the delay of a channel carry over motion from before a record whose start is fitted.
- While a hammer is in contact an accelerometer shows the course of its force, over a mass, which is unknown, and a
  velocity how far its impulse has got.
- Behind a jump of an input that is held, and acts on a mass, an accelerometer shows how its filter answers to a step:
  its corner is stated, and its order is not. Where such jumps follow each other too fast, all samples count.
"""

from dataclasses import replace

import numpy as np

from pipeline.physics.virtual_rig.sensor import ACCELERATION, VELOCITY

#: share of the samples of a run up to which those behind jumps are left out
_FEW = 0.25


def without_past(bench, recorded):
    """The Recorded run of a Bench without the samples that filters and delays fill with motion from before it."""
    return _without(bench, recorded, lambda sensor, time: time < sensor.lag)


def without_course(bench, recorded, begin, width):
    """The same without what accelerations and velocities show of a blow from ``begin`` on, ``width`` s long."""
    return _without(bench, recorded, lambda sensor, time: sensor.measurand in (ACCELERATION, VELOCITY)
                    and (time >= begin) & (time <= begin + width + sensor.lag))


def without_jumps(bench, recorded):
    """The same without what accelerometers with a filter show of jumps of held inputs, if these are few."""
    run = recorded.run
    jumps = [np.flatnonzero(np.diff(run.inputs[name])) + 1 for name in run.held if np.ndim(run.inputs.get(name))]
    instants = np.unique(np.concatenate([[], *jumps])) / run.sample_rate
    if not len(instants):
        return recorded

    def behind(sensor, time):
        if sensor.measurand is not ACCELERATION or not np.isfinite(sensor.corner):
            return False
        since = time - instants[np.maximum(np.searchsorted(instants, time, side="right") - 1, 0)]
        return (since >= 0) & (since <= sensor.lag)

    fewer = _without(bench, recorded, behind)
    return fewer if fewer.valid.sum() >= (1 - _FEW) * recorded.valid.sum() else recorded


def _without(bench, recorded, unseen):
    """The Recorded run without the samples of which ``unseen(sensor, time (n,))`` says so."""
    sensors, time = {c.name: c for c in bench.channels}, np.arange(recorded.samples.shape[1]) / recorded.run.sample_rate
    hidden = [np.broadcast_to(unseen(sensors[name], time), time.shape) for name in recorded.channels]
    return replace(recorded, valid=recorded.valid & ~np.array(hidden))
