"""Tests in which lines were heard, or none, and the operating points of each: from a recording.

Either one run lists what a whole cycle of changing load let one hear, and a test at constant load was silent; or each
run is a test of its own at the pressure and speed among its conditions, and has a list of its lines, empty if silent;
or its lines are the squeal that was found in its records (product NoiseEvents).
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError
from pipeline.diagnosis.published.frequency_lists import lines_of
from pipeline.inference.decision.line_evidence import Heard

CYCLE, CONSTANT = "cycle", "constant load"
#: pressures of runs are those of the model within this share
_EQUAL = 0.01
#: share by which a condition that holds over a run may vary
_STEADY = 0.2


@dataclass(frozen=True)
class BenchTests:
    """t tests by ``name`` over o operating points, and what was ``heard`` in them.

    ``state`` (o,) row of the pressure, ``speed`` (o,) rad/s, ``test`` (o,) row of the name, ``changing`` (o,) 1 where
    the load changes; ``reading`` Hz standard deviation of reading a line.
    """

    name: tuple
    state: np.ndarray
    speed: np.ndarray
    test: np.ndarray
    changing: np.ndarray
    heard: Heard
    reading: float

    @property
    def silent(self):
        """(t,): True for tests in which nothing was heard."""
        return ~(self.heard.tests > 0).any(axis=0)


def cycle_tests(recording, settings, pressure):
    """BenchTests of a cycle and of silence at constant load, over the states of ``pressure`` (p,) Pa of the model.

    ``settings``: the section ``line_evidence``. ConfigError for lines or pressures that do not fit.
    """
    stated = lines_of(recording, settings.run, settings.list, "line_evidence.list")
    lines = np.sort(stated.frequency)
    _within(lines, settings)
    if not len(lines):
        raise ConfigError("line_evidence.list", "at least one line", f"none in {settings.list}")
    silent = pressure <= settings.silent_up_to
    if silent.all() or not silent.any():
        raise ConfigError("structure.pressures", "some up to line_evidence.silent_up_to and some above it",
                          ", ".join(f"{p:g} Pa" for p in pressure))
    speed = np.where(silent, settings.constant_speed, settings.cycle_speed * pressure.max() / pressure)
    return BenchTests((CYCLE, CONSTANT), np.arange(len(pressure)), speed, silent.astype(int), ~silent,
                 Heard(lines, np.tile([1, 0], (len(lines), 1))), _reading([stated]))


def run_tests(recording, settings, pressure):
    """BenchTests of the runs ``settings.runs``, one operating point each; as ``cycle_tests``.

    Lines of several runs closer than ``settings.model_error`` are one, at their mean.
    """
    lists = [lines_of(recording, run, settings.list, "line_evidence.runs") for run in settings.runs]
    return _runs(settings.runs, lists, recording, settings, pressure, _EQUAL)


def record_tests(recording, events, settings, pressure):
    """BenchTests of the runs ``settings.runs``, none = all that a NoiseEvents has searched; as ``run_tests``.

    Lines are the squeal of their microphones, of accelerometers where there is none; harmonics of it are none.
    """
    searched = list(dict.fromkeys(map(str, events.record_run)))
    runs = settings.runs or tuple(searched)
    strange = [run for run in runs if run not in searched]
    if strange or not runs:
        raise ConfigError("line_evidence.runs", f"runs with a microphone or an accelerometer: {', '.join(searched)}",
                          ", ".join(strange) or "none")
    if settings.low < events.band[0]:
        raise ConfigError("line_evidence.low", f"at least {events.band[0]:g} Hz, from where squeal was looked for",
                          f"{settings.low:g} Hz", "raise it, or lower noise_events.lowest_frequency")
    lists = [_heard(events, run) for run in runs]
    return _runs(runs, lists, recording, settings, pressure, settings.pressure_within)


@dataclass(frozen=True)
class _List:
    """Lines (n,) Hz and how far each wanders."""

    frequency: np.ndarray
    frequency_tolerance: np.ndarray


def _heard(events, run):
    """_List of the squeal of a run."""
    records = np.flatnonzero(events.record_run == run)
    sound = records[events.record_kind[records] == "sound"]
    own = (np.isin(events.event_record, sound if len(sound) else records) & (events.event_kind == "squeal"))
    return _List(events.event_frequency[own], (events.event_highest - events.event_lowest)[own] / 2)


def _runs(runs, lists, recording, settings, pressure, within):
    """BenchTests of ``runs`` with their ``lists`` of lines, at pressures of the model ``within`` a share."""
    points = [[_condition(recording, run, name, unit) for name, unit in (("pressure", "Pa"), ("speed", "rad/s"))]
              for run in runs]
    state = np.array([_state(run, settings.pressure_factor * point[0], pressure, within)
                      for run, point in zip(runs, points, strict=True)])
    frequency = np.concatenate([stated.frequency for stated in lists])
    owner = np.repeat(np.arange(len(lists)), [len(stated.frequency) for stated in lists])
    if not len(frequency):
        raise ConfigError("line_evidence.runs", "at least one run with a line", "silence in all of them")
    _within(np.sort(frequency), settings)
    groups = grouped(frequency, settings.model_error)
    lines = [frequency[group].mean() for group in groups]
    marks = [np.isin(np.arange(len(lists)), owner[group]).astype(int) for group in groups]
    return BenchTests(tuple(runs), state, np.array([point[1] for point in points]), np.arange(len(lists)),
                 np.zeros(len(lists), bool), Heard(np.array(lines), np.array(marks)), _reading(lists))


def grouped(frequency, apart):
    """[indices] of ``frequency`` (n,) by ascending frequency, cut where neighbours differ by more than the share
    ``apart``."""
    order = np.argsort(frequency, kind="stable")
    ascending = frequency[order]
    return [g for g in np.split(order, np.flatnonzero(np.diff(ascending) > apart * ascending[1:]) + 1) if len(g)]


def _within(lines, settings):
    if len(lines) and (lines[0] < settings.low or lines[-1] > settings.high):
        raise ConfigError("line_evidence.low", "a band that holds all lines", f"{settings.low:g} to"
                          f" {settings.high:g} Hz, lines at {', '.join(f'{f:g}' for f in lines)}")


def _reading(lists):
    return float(max(max(stated.frequency_tolerance, default=0.0) for stated in lists)) / np.sqrt(3)


def _condition(recording, run, name, unit):
    """The value of a condition of a run: as it is stated, else the median of the channel that measures it, which must
    not vary."""
    given = recording.runs[run].conditions.get(name)
    measured = None if given is not None else _measured(recording.runs[run], name, unit)
    if measured is not None:
        low, middle, high = np.percentile(measured, (10, 50, 90))
        if high - low > _STEADY * middle:
            raise ConfigError(f"recording: runs.{run}", f"one {name}, as a test at one operating point",
                              f"{low:g} to {high:g} {unit}", "cut the record into runs by begin and end")
        return float(middle)
    if given is None or len(given.value) != 1 or str(given.unit) != unit:
        raise ConfigError(f"recording: runs.{run}.conditions", f"one {name} in {unit}", "none" if given is None else
                          f"{len(given.value)} values in {given.unit}", "state it, or leave the run out of"
                          " line_evidence.runs")
    return float(given.value[0])


def _measured(run, name, unit):
    """Samples of the one channel of a run that measures a condition, or None."""
    found = [channel.samples for channel in run.telling(name, unit).values() if np.median(channel.samples) > 0]
    return found[0] if len(found) == 1 else None


def _state(run, stated, pressure, within):
    state = int(np.argmin(abs(pressure - stated)))
    if abs(pressure[state] - stated) > within * stated:
        raise ConfigError(f"recording: runs.{run}.conditions.pressure", "a pressure that the model was computed at, of"
                          f" {', '.join(f'{p:g} Pa' for p in pressure)}", f"{stated:g} Pa", "add it to the pressures"
                          " of structure, or to the load factors of lumped")
    return state
