"""How long a run will take, by what earlier runs took on this machine, else by those of a machine of reference.

Times of stages are kept in a folder of the user, each with a measure of its work, to which it is proportional. The
table of reference comes with the program; its CPU seconds are those of another processor, to which this one is related
by what has run here or, before anything has, by a short measurement.
"""

import json
import os
import time
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from statistics import median
from typing import NamedTuple

import numpy as np

from pipeline.case_models.early.memory import peak_memory
from pipeline.case_models.early.reference_pace import NEAR, Reference, measured
from pipeline.case_models.early.work import work
from pipeline.environment import user_folder
from pipeline.physics.numerics.memory import available_memory

#: notes of a stage that are kept, of one size and in all; shorter times are not (s)
_KEPT, _MOST, _SHORTEST = 5, 40, 0.5
#: measures within this factor are those of the same case: their notes count before all others
_SAME = 1.1
#: shorter runs are not forecast (s)
_WORTH_TELLING = 20.0
#: stages that take most of a run
_LONG = ("micro_friction", "structure", "complex_modes", "convergence", "limit_cycle", "probability", "multibody")
#: stages that hold whole finite-element models
_LARGE = ("structure", "reduced_model", "complex_modes", "convergence")
#: the measurement of this processor among the notes, and the power of it that its stages go by: one that is 2.14 times
#: as slow by dense algebra took 1.3 times as long for them, whose matrices are sparse
_PROCESSOR, _TOLD = "processor", 0.5


class Note(NamedTuple):
    """What a stage took: its measure of work, seconds, stages of variants that were computed for it."""

    work: float
    seconds: float
    variants: float


class Pace:
    """Forecast of a run, and notes of what it takes."""

    def __init__(self, job, workers, folder=None):
        """``job``: a ChainRun; ``workers``: its processes; ``folder``: where notes are kept; None: that of the user."""
        self._workers, self._path = workers, (folder or user_folder()) / "pace.json"
        self._sections, self._notes = job.case.sections, _read(self._path)
        self.begin()

    @cached_property
    def _work(self):
        return work(self._sections)

    @cached_property
    def _reference(self):
        return Reference()

    def short_of_memory(self, states):
        """A sentence where the planned ``states`` may need more memory than is available; else ''."""
        available = available_memory()
        if available is None or not any(state.reasons for state in states if state.stage.name in _LARGE):
            return ""
        expected = peak_memory(self._sections)
        if expected <= available:
            return ""
        return (f"warning: expected {expected / 1e9:.2g} GB of memory for this model, found"
                f" {available / 1e9:.2g} GB available; use a coarser mesh or state fewer convergence.refinements: a"
                " stage that does not fit ends before its factors are made")

    def begin(self):
        """Time runs from here on."""
        self._since, self._variants = time.monotonic(), 0

    def forecast(self, states):
        """A sentence on the run of the planned ``states``; '' of a short one."""
        planned = [state.stage for state in states if state.reasons]
        expected = {stage.name: self._seconds(stage.name) for stage in planned}
        total = sum(filter(None, expected.values())) - self._side_by_side(planned)
        unknown = [name.replace("_", " ") for name, seconds in expected.items() if seconds is None and name in _LONG]
        if total < _WORTH_TELLING and not unknown:
            return ""
        if total < _WORTH_TELLING:
            return f"how long this takes is not known: no run of {', '.join(unknown)} on this machine yet"
        known = all(self._noted(name) for name, seconds in expected.items() if seconds and name in _LONG)
        source = "earlier runs on this machine" if known else "another machine, scaled to this one"
        told = f"this will take about {_duration(total)} by the times of {source}"
        beside = f", and what {' and '.join(unknown)} will take, no run of which is known" * bool(unknown)
        return told + beside

    def note(self, state, seconds):
        """Keep the time since the stage before if ``state`` is of one that was computed, with its variants."""
        if state.variant:
            self._variants += seconds is not None
            return
        name, taken = state.stage.name, time.monotonic() - self._since
        if seconds is not None and taken >= _SHORTEST:
            self._keep(self._key(name), Note(self._work[name], taken, self._variants))
        self.begin()

    def _key(self, name):
        return f"{name} with {self._workers}"

    def _keep(self, key, note):
        """Add a note to the file, which other runs may have changed since."""
        notes = _read(self._path)
        alike = [each for each in notes.get(key, []) if 1 / _SAME < each.work / note.work < _SAME]
        others = [each for each in notes.get(key, []) if each not in alike]
        notes[key] = [*others, *alike[1 - _KEPT:], note][-_MOST:]
        self._notes, partial = notes, self._path.with_name(f".pace.{os.getpid()}")
        with suppress(OSError):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            partial.write_text(json.dumps(notes))
            os.replace(partial, self._path)

    def _seconds(self, name, workers=None):
        """Seconds of a stage by its notes, else by the reference with so many ``workers`` (None: all), or None."""
        noted = self._noted(name)
        if noted is not None:
            return noted
        there = self._reference.seconds(name, self._work[name], workers or self._workers)
        return None if there is None else there * self._slower()

    def _side_by_side(self, planned):
        """Seconds that the sum of those of ``planned`` stages counts twice: those that go on beside one long task, by a
        process less. Notes do not count them, being times since the stage before."""
        longest = next((stage for stage in planned if stage.alone), None)
        if self._workers == 1 or longest is None or self._noted(longest.name) is not None:
            return 0.0
        beside = [stage.name for stage in planned[planned.index(longest) + 1:] if not stage.reads_all
                  and longest.output not in (product for products in stage.inputs.values() for product in products)]
        with_all, without = (sum(filter(None, (self._seconds(name, workers) for name in beside)))
                             for workers in (self._workers, self._workers - 1))
        return with_all * min(1.0, (self._seconds(longest.name) or 0.0) / without) if without else 0.0

    def _noted(self, name):
        """Seconds of a stage by its notes, or None; those with fewer variants went on from an interrupted run."""
        notes = self._notes.get(self._key(name), [])
        whole = max((note.variants for note in notes), default=0)
        return self._scaled(name, [note for note in notes if note.variants == whole])

    def _scaled(self, name, notes):
        """Seconds of a stage by its ``notes``: median of those of this size, or of near ones as the reference grows
        with the size, in proportion where it says nothing."""
        size = self._work[name]
        notes = [note for note in notes if 1 / NEAR < note.work / size < NEAR]
        same = [note for note in notes if 1 / _SAME < note.work / size < _SAME]
        seconds = [note.seconds * self._grown(name, note.work, size) for note in same or notes]
        return median(seconds) if seconds else None

    def _grown(self, name, work, size):
        there, here = (self._reference.seconds(name, each, self._workers) for each in (work, size))
        return here / there if there and here else size / work

    def _slower(self):
        """Time that this machine takes over that of the reference: that of half of all seconds that stages have taken
        here, or by a measurement of the processor, which is kept."""
        ratios = []
        for stage in _LONG:
            for note in self._notes.get(self._key(stage), []):
                there = self._reference.seconds(stage, note.work, self._workers)
                ratios += [(note.seconds / there, note.seconds)] if there else []
        if ratios:
            ratio, seconds = np.array(sorted(ratios)).T     # what takes two seconds is mostly starting
            return float(ratio[np.searchsorted(np.cumsum(seconds), sum(seconds) / 2)])
        if _PROCESSOR not in self._notes:
            self._keep(_PROCESSOR, Note(1.0, measured(), 0.0))
        return (self._notes[_PROCESSOR][-1].seconds / self._reference.processor) ** _TOLD


def _read(path):
    """{key: [Note]} of the file at ``path``; {} of none, or of one that holds anything else."""
    with suppress(OSError, ValueError, TypeError, AttributeError):
        stored = json.loads(Path(path).read_text())
        notes = {key: [Note(*map(float, each)) for each in entries] for key, entries in stored.items()}
        if all(note.work > 0 and note.seconds > 0 for entries in notes.values() for note in entries):
            return notes
    return {}


def _duration(seconds):
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
