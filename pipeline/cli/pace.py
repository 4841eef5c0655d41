"""How long a run will take, and the memory it needs, by what earlier runs took on this machine.

Times of stages are kept in a folder of the user, each with a measure of its work, to which it is proportional.
"""

import json
import os
import resource
import time
from contextlib import suppress
from pathlib import Path
from statistics import median
from typing import NamedTuple

from pipeline.case_models.early.work import elements, work
from pipeline.environment import user_folder

#: notes of a stage that are kept; shorter times are not (s)
_KEPT, _SHORTEST = 5, 0.5
#: measures within this factor are those of the same case: their notes count before all others
_SAME = 1.1
#: measures that differ by more say nothing of each other
_NEAR = 10.0
#: shorter runs are not forecast (s); memory grows with the number of elements by this power
_WORTH_TELLING, _POWER = 20.0, 1.1
#: stages that take most of a run, and the name under which memory is noted
_LONG = ("micro_friction", "structure", "complex_modes", "convergence", "limit_cycle", "probability", "multibody")
_MEMORY = "memory"


class Note(NamedTuple):
    """What something took: its measure of work, seconds or bytes, stages of variants that were computed for it."""

    work: float
    amount: float
    variants: float


class Pace:
    """Forecast of a run, and notes of what it takes."""

    def __init__(self, job, workers, folder=None):
        """``job``: a ChainRun; ``workers``: its processes; ``folder``: where notes are kept; None: that of the user."""
        self._workers, self._path = workers, (folder or user_folder()) / "pace.json"
        self._work, self._notes = work(job.case.sections), _read(self._path)
        brake = job.case.sections.get("structure")
        self._elements = elements(brake) if brake else 0.0
        self.begin()

    def begin(self):
        """Time runs from here on."""
        self._since, self._variants = time.monotonic(), 0

    def forecast(self, states, available):
        """A sentence on the run of the planned ``states``; '' of a short one.

        ``available``: bytes of memory that the machine has left; None: not known.
        """
        expected = {state.stage.name: self._seconds(state.stage.name) for state in states if state.reasons}
        total = sum(filter(None, expected.values()))
        unknown = [name.replace("_", " ") for name, seconds in expected.items() if seconds is None and name in _LONG]
        if total < _WORTH_TELLING and not unknown:
            return ""
        if total < _WORTH_TELLING:
            return f"how long this takes is not known: no run of {', '.join(unknown)} on this machine yet"
        told = f"this will take about {_duration(total)} by the times of earlier runs on this machine"
        beside = f", and what {' and '.join(unknown)} will take, no run of which is known" * bool(unknown)
        return told + beside + self._memory(available)

    def note(self, state, seconds):
        """Keep the time since the stage before if ``state`` is of one that was computed, with its variants."""
        if state.variant:
            self._variants += seconds is not None
            return
        name, taken = state.stage.name, time.monotonic() - self._since
        if seconds is not None and taken >= _SHORTEST:
            self._keep(name, Note(self._work[name], taken, self._variants))
        self.begin()

    def note_memory(self):
        """Keep the largest memory of this process and, once they have ended, of its workers together."""
        here, each = (1024 * resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF,
                                                                           resource.RUSAGE_CHILDREN))
        if self._elements:
            self._keep(_MEMORY, Note(self._elements, here + self._workers * each, 0))

    def _key(self, name):
        return f"{name} with {self._workers}"

    def _keep(self, name, note):
        """Add a note to the file, which other runs may have changed since."""
        notes, key = _read(self._path), self._key(name)
        notes[key] = [*notes.get(key, []), note][-_KEPT:]
        self._notes, partial = notes, self._path.with_name(f".pace.{os.getpid()}")
        with suppress(OSError):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            partial.write_text(json.dumps(notes))
            os.replace(partial, self._path)

    def _seconds(self, name):
        """Seconds of a stage by its notes, or None; those with fewer variants went on from an interrupted run."""
        notes = self._notes.get(self._key(name), [])
        whole = max((note.variants for note in notes), default=0)
        return _scaled([note for note in notes if note.variants == whole], self._work[name])

    def _memory(self, available):
        notes = self._notes.get(self._key(_MEMORY), []) if self._elements else []
        needed = _scaled(notes, self._elements, _POWER)
        if needed is None:
            return ""
        scarce = available is not None and needed > available
        return f"; it needs about {needed / 1e9:.2g} GB of memory" + (
            f", but {available / 1e9:.2g} GB are available: use fewer workers or a coarser mesh" if scarce else "")


def _scaled(notes, size, power=1.0):
    """The amount for a ``size`` of work: median of the notes of this size, or of near ones in proportion."""
    notes = [note for note in notes if 1 / _NEAR < note.work / size < _NEAR]
    same = [note for note in notes if 1 / _SAME < note.work / size < _SAME]
    amounts = [note.amount * (size / note.work) ** power for note in same or notes]
    return median(amounts) if amounts else None


def _read(path):
    """{key: [Note]} of the file at ``path``; {} of none, or of one that holds anything else."""
    with suppress(OSError, ValueError, TypeError, AttributeError):
        stored = json.loads(Path(path).read_text())
        notes = {key: [Note(*map(float, each)) for each in entries] for key, entries in stored.items()}
        if all(note.work > 0 and note.amount > 0 for entries in notes.values() for note in entries):
            return notes
    return {}


def _duration(seconds):
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
