"""Progress of a running chain: bars with the remaining time on a terminal, plain lines elsewhere. Door of rich."""

from contextlib import contextmanager
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    SpinnerColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

from pipeline.contract import context


def table(title, head, rows, note=""):
    """Print rows of text under a header, the first column left-aligned, and a note below."""
    shown = Table(title=title, title_justify="left", box=SIMPLE_HEAD)
    for index, name in enumerate(head):
        shown.add_column(name, justify="right" if index else "left")
    for row in rows:
        shown.add_row(*row)
    console = Console(highlight=False)
    if not console.is_terminal:
        needed = 1 + sum(max(map(len, column)) + 3 for column in zip(head, *rows, strict=True))
        console.width = max(console.width, needed)
    console.print(shown)
    console.print(note, markup=False)


class _TimeLeft(TimeRemainingColumn):
    """'0:01:20 left', or nothing while it is unknown."""

    def render(self, task):
        known = task.total is not None and task.time_remaining is not None and not task.finished
        return Text.assemble(super().render(task), " left") if known else Text("")


class _Advance(context.Progress):
    """Moves one bar."""

    def __init__(self, bars, task):
        self._bars, self._task = bars, task

    def advance(self, steps=1):
        self._bars.advance(self._task, steps)


class Bars:
    """Progress bars of one run; lines alone if ``console`` is not a terminal."""

    def __init__(self, console=None):
        self.console = console or Console(stderr=True)
        self._live = None

    @contextmanager
    def stage(self, name):
        """A line for the stage, and below it the bars of its work."""
        if not self.console.is_terminal:
            yield
            return
        columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(30), MofNCompleteColumn(),
                   TimeElapsedColumn(), _TimeLeft())
        with Progress(*columns, console=self.console, transient=True) as self._live:
            self._live.add_task(name, total=None)
            try:
                yield
            finally:
                live, self._live = self._live, None
                live.refresh()

    @contextmanager
    def work(self, label, total):
        """A bar for ``total`` steps."""
        if self._live is None or not label:
            yield context.Progress()
            return
        task = self._live.add_task(f"  {label}", total=total)
        try:
            yield _Advance(self._live, task)
        finally:
            self._live.remove_task(task)

    def log(self, message):
        """One line above the bars; the same in a pipe or a file, which have none."""
        (self._live.console if self._live else self.console).print(message, highlight=False, markup=False,
                                                                   soft_wrap=not self.console.is_terminal)

    def remark(self, message):
        """The same of what was left out or taken for granted."""
        self.log(f"note: {message}")


@dataclass(frozen=True)
class RunContext(context.Context):
    """The context of a run from the command line."""

    executor: object = None
    bars: object = None

    def fan_out(self, function, items, label=""):
        with self.bars.work(label, len(items)) as progress:
            return self.executor.map(function, items, progress.advance)

    @property
    def spares(self):
        return self.executor.spares

    def begin(self, function, item):
        return self.executor.begin(function, item)

    @property
    def sees_files(self):
        return self.executor.sees_files

    def spent_elsewhere(self):
        return self.executor.spent_elsewhere

    @contextmanager
    def progress(self, label, total):
        with self.bars.work(label, total) as progress:
            yield progress

    @contextmanager
    def stage(self, stage):
        with self.bars.stage(stage.name):
            yield

    def log(self, message):
        self.bars.log(message)

    def remark(self, message):
        self.bars.remark(message)
