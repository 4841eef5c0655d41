"""Wall and CPU seconds of repeated calls."""

import statistics
import time
from dataclasses import dataclass

from pipeline.contract.executors.cpu_time import cpu_seconds


@dataclass(frozen=True)
class Timing:
    """Wall and CPU seconds of calls, which count child processes.

    ``first``: CPU seconds of the call before them, which compiles where nothing is cached, and of preparing it.
    """

    first: float
    wall: tuple
    cpu: tuple

    @property
    def median(self):
        """Median wall and CPU seconds of a call."""
        return statistics.median(self.wall), statistics.median(self.cpu)


def timed(call):
    """(wall seconds, CPU seconds) of one call."""
    wall, cpu = time.perf_counter(), cpu_seconds()
    call()
    return time.perf_counter() - wall, cpu_seconds() - cpu


def measured(call, runs, preparation=0.0):
    """Timing of one first call, which took ``preparation`` CPU seconds to prepare, and ``runs`` more."""
    _, first = timed(call)
    wall, cpu = zip(*(timed(call) for _ in range(runs)), strict=True)
    return Timing(preparation + first, wall, cpu)
