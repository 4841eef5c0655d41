"""Stages whose work is one long task: in another process, beside the stages after them that do not read its product."""

import time
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field

from pipeline.contract.context import CaseSummary, Context
from pipeline.contract.executors.local import killed
from pipeline.contract.executors.unfinished import Unfinished


@dataclass(frozen=True)
class Work:
    """What a ``stage`` is called with, and by which solver for which case."""

    stage: object       # Stage
    arguments: dict     # argument -> product, settings or sections
    solver: str
    case: CaseSummary


@dataclass(frozen=True)
class Made:
    """The product of a stage, what it told, and the seconds that it took by the clock."""

    output: object
    told: tuple
    wall: float


class LongTasks:
    """Those of one ChainRun that are under way; ``report(state, seconds)`` is called when one is done."""

    def __init__(self, run: object, context: Context, report: Callable, unfinished: Unfinished):
        self._run, self._context, self._report, self._begun = run, context, report, []
        self._unfinished = unfinished

    def begin(self, state: object) -> bool:
        """Begin with the stage of a ``state`` if it must run, in a context that spares a process; whether it does."""
        if not state.reasons:
            return False
        arguments, current = self._run.arguments(state.stage, self._context)
        work = Work(state.stage, arguments, self._run.solver, self._context.case)
        self._begun.append((state, current, self._context.begin(made, work)))
        return True

    def gather(self, stage: object = None) -> int:
        """Write the products of those that are done or that ``stage`` may read, of all for None; their number.

        Raises what such a stage raised unless the run goes on without it, and BrakechainError where its process was
        killed.
        """
        chosen = [each for each in self._begun if stage is None or each[2].done() or self._needed(stage, each[0].stage)]
        for each in chosen:
            self._begun.remove(each)
            with self._unfinished.noted(each[0].stage):
                self._write(*each)
        return len([each for each in chosen if each[0].stage.name not in self._unfinished.errors])

    def _needed(self, stage, begun):
        read = {product.name for product in self._run.filled(stage).values() if product}
        return begun.output.name in read or bool(self._run.variants(stage, set()))

    def _write(self, state, current, future):
        try:
            done, cpu = future.result()
        except BrokenProcessPool:
            raise killed() from None
        for hear, line in done.told:
            getattr(self._context, hear)(line)
        self._run.publish(state.stage, done.output, current, done.wall, cpu)
        self._report(state, done.wall)


@dataclass(frozen=True)
class _Telling(Context):
    """Keeps what it is told."""

    lines: list = field(default_factory=list)

    def log(self, message):
        self.lines.append(("log", message))

    def remark(self, message):
        self.lines.append(("remark", message))


def made(work: Work) -> Made:
    """The Work done, in whatever process this is."""
    context, begin = _Telling(work.solver, work.case), time.perf_counter()
    output = work.stage(**work.arguments, context=context)
    return Made(output, tuple(context.lines), time.perf_counter() - begin)
