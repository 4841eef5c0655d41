"""What a running stage may use besides its inputs: fan-out, progress, log. Never hashed."""

from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from operator import call


class Progress:
    """Counts steps of one piece of work; this base class is silent."""

    def advance(self, steps=1):
        """Count ``steps`` more of the announced total as done."""


@dataclass(frozen=True)
class CaseSummary:
    """What the report may say about its case: title, settings with origins, method sentences."""

    name: str = "case"
    title: str = ""
    description: str = ""
    settings: dict = field(default_factory=dict)    # stage -> {dotted key: SI value}
    origins: dict = field(default_factory=dict)     # stage -> {dotted key: {origin, source}}
    units: dict = field(default_factory=dict)       # stage -> {dotted key: SI unit}
    meanings: dict = field(default_factory=dict)    # stage -> {dotted key: meaning}
    methods: dict = field(default_factory=dict)     # stage -> sentence with {setting} in it
    version: str = ""
    idle: dict = field(default_factory=dict)        # stage -> {dotted key: what would give it an effect, or ""}


@dataclass(frozen=True)
class Context:
    """The default context runs in this process, silently: for tests and notebooks."""

    solver: str = "superlu"
    case: CaseSummary = CaseSummary()
    kept: object = None     # integrity.kept.Kept of the stage that runs, or None

    def map(self, function, items, label=""):
        """``[function(item) for item in items]``, in order; ``function`` must be picklable."""
        fan_out, items = partial(self.fan_out, label=label), list(items)
        return fan_out(function, items) if self.kept is None else self.kept.completed(fan_out, function, items)

    def side_by_side(self, *groups, label=""):
        """What the functions of each of some lists ``groups`` return, a list for each; they take nothing, are picklable
        and run in one round, in which those of one group fill the gaps that those of another leave."""
        found = iter(self.map(call, [task for group in groups for task in group], label))
        return [list(islice(found, len(group))) for group in groups]

    def fan_out(self, function, items, label=""):
        """What ``map`` computes; ``items`` is a list."""
        with self.progress(label, len(items)) as progress:
            results = []
            for item in items:
                results.append(function(item))
                progress.advance()
        return results

    @property
    def spares(self):
        """Whether a process can be spared for one long task; then ``begin(function, item)`` gives the Future of it and
        of its CPU seconds."""
        return False

    @property
    def sees_files(self):
        """Whether tasks of ``map`` run on this machine, so that they read and write the files that are seen here."""
        return True

    def spent_elsewhere(self):
        """CPU seconds that tasks of ``map`` have used in other processes so far."""
        return 0.0

    @contextmanager
    def progress(self, label, total):
        """A Progress for ``total`` steps of the work called ``label``."""
        yield Progress()

    @contextmanager
    def stage(self, stage):
        """Announces that ``stage`` runs inside; silent here."""
        yield

    def log(self, message):
        """One line for the user; silent here."""

    def remark(self, message):
        """One sentence on what was left out or taken for granted, for every user; silent here."""
