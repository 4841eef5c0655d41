"""The stops of a recording in a schedule: the condition of each run, and the bands in which it was noisy."""

from dataclasses import dataclass

import numpy as np

from pipeline.case_models.noise_matrix.schedule import DRAG, STOP
from pipeline.products.recording import CONDITIONS

#: unit of a speed that is that of the vehicle
_VEHICLE = "m/s"
#: a run is braked where its pressure is above this share of its largest
_BRAKED = 0.5
#: share by which the speed of a drag may vary
_STEADY = 0.2
#: most samples of a channel that are read
_READ = 20000
#: difference of temperatures, K, that counts as one
_WARM = 30.0


@dataclass(frozen=True)
class Stops:
    """Runs that were searched for squeal: ``run`` names, ``condition`` of the schedule of each, -1 where none is near,
    and ``reason`` why; ``noisy`` (n, b) bands in which they squeal."""

    run: tuple
    condition: np.ndarray
    reason: tuple
    noisy: np.ndarray


def recorded_stops(recording, events, conditions, bands, settings):
    """Stops of the products Recording and NoiseEvents in the ``conditions`` of a schedule."""
    runs = tuple(dict.fromkeys(map(str, events.record_run)))
    matched = [_nearest(_course(recording.runs[run], settings.wheel_radius), conditions, settings) for run in runs]
    noisy = np.array([_squeals(events, run, bands) for run in runs]).reshape(len(runs), len(bands.middle))
    return Stops(runs, np.array([m[0] for m in matched], int), tuple(m[1] for m in matched), noisy)


def _squeals(events, run, bands):
    """(b,) bands in which a run squeals: of its microphones, of accelerometers where there are none."""
    records = np.flatnonzero(events.record_run == run)
    sound = records[events.record_kind[records] == "sound"]
    heard = (events.event_kind == "squeal") & np.isin(events.event_record, sound if len(sound) else records)
    return bands.holding(events.event_frequency[heard])


def _course(run, radius):
    """{condition: samples} of a Run: of its one channel of it, else as it states them; None where neither is there.

    The speed is that of the disc, rad/s, on whose wheel the ``radius`` m belongs to a speed of the vehicle.
    """
    course = {name: _samples(run, name, unit) for name, (_, unit) in CONDITIONS.items()}
    vehicle = _samples(run, "speed", _VEHICLE) if course["speed"] is None else None
    return course if vehicle is None else {**course, "speed": vehicle / radius}


def _samples(run, name, unit):
    read = [_read(channel) for channel in run.telling(name, unit).values()]
    read = [samples for samples in read if len(samples) and np.median(abs(samples)) > 0]
    if len(read) == 1:
        return read[0]
    stated = run.conditions.get(name)
    return np.asarray(stated.value, float) if stated is not None and str(stated.unit) == unit else None


def _read(channel):
    """Samples of a Channel, evenly chosen, without those that are missing."""
    count = len(channel.samples)
    index = np.arange(0, count, max(count // _READ, 1))
    for first, after in channel.missing:
        index = index[(index < first) | (index >= after)]
    return np.asarray(channel.samples[index], float)


def _nearest(course, conditions, settings):
    """(row of the nearest of the ``conditions``, "") or (-1, why there is none)."""
    pressure, speed, temperature = (course[name] for name in CONDITIONS)
    if pressure is None or speed is None:
        return -1, f"its {'pressure' if pressure is None else 'speed'} is neither measured nor stated"
    line = float(np.median(pressure[pressure >= _BRAKED * pressure.max()]))
    begin, end = (float(np.percentile(abs(speed), share)) for share in (98, 2))
    kind = DRAG if begin - end <= _STEADY * begin else STOP
    vehicle = np.sign(np.median(speed)) * begin * settings.wheel_radius
    known = temperature is not None
    candidates = {k: abs(np.log(line / c.pressure)) + abs(np.log(vehicle / c.speed))
                  for k, c in enumerate(conditions)
                  if c.kind == kind and np.sign(c.speed) == np.sign(vehicle) and min(line, begin) > 0
                  and abs(np.log(line / c.pressure)) <= np.log1p(settings.within)
                  and abs(np.log(vehicle / c.speed)) <= np.log1p(settings.within)
                  and (not c.temperature or known and abs(temperature[0] - c.temperature) <= _WARM)}
    if candidates:
        return min(candidates, key=lambda k: (candidates[k], _far(temperature, conditions[k]))), ""
    way = "drag at" if kind == DRAG else "stop from"
    return -1, f"no condition is near a {way} {3.6 * vehicle:.3g} km/h and {line / 1e5:.3g} bar"


def _far(temperature, condition):
    return abs(temperature[0] - condition.temperature) if condition.temperature else 0.0
