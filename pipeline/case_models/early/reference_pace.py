"""What stages took on a machine of reference, and how fast the processor of this one is beside it.

The table lies beside this file; ``python -m tests.benchmarks.reference_pace`` writes it anew from folders of runs.
"""

import json
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

TABLE = Path(__file__).with_name("reference_pace.json")
#: work that differs by more from that of all rows of a stage says nothing of it
NEAR = 10.0
#: sizes of what is measured, repetitions
_SIZE, _GRID, _TIMES = 700, 512, 10


class Row(NamedTuple):
    """A stage of a run: its measure of work, CPU seconds, the share of them that two processes did side by side."""

    work: float
    cpu: float
    beside: float


class Reference:
    """Times of the stages on the machine of reference."""

    def __init__(self, path=TABLE):
        stored = json.loads(Path(path).read_text())
        self.processor = stored["processor"]
        self._rows = {name: sorted(Row(*row) for row in rows) for name, rows in stored["stages"].items()}

    def seconds(self, name, work, workers):
        """Seconds there of a stage with so much ``work`` by ``workers`` processes; None of work unlike any."""
        rows = self._rows.get(name, [])
        if not rows or not rows[0].work / NEAR < work < NEAR * rows[-1].work:
            return None
        sizes = sorted({row.work for row in rows})
        alike = [[row for row in rows if row.work == size] for size in sizes]
        cpu = [np.mean(np.log([row.cpu for row in same])) for same in alike]
        beside = [np.mean([row.beside for row in same]) for same in alike]
        least, most = sizes[0], sizes[-1]
        inside = np.log(min(max(work, least), most))
        taken = np.exp(np.interp(inside, np.log(sizes), cpu)) * work / np.exp(inside)
        share = np.interp(inside, np.log(sizes), beside)
        return float(taken * (1 - share + share / workers))


def measured():
    """CPU seconds of this processor for a small dense factor and some transforms: the least of a few."""
    generator = np.random.default_rng(0)
    matrix, grid = generator.standard_normal((_SIZE, _SIZE)), generator.standard_normal((_GRID, _GRID))
    return min(_once(matrix, grid) for _ in range(_TIMES))


def _once(matrix, grid):
    begin = time.process_time()
    np.linalg.solve(matrix, matrix)
    np.fft.rfft2(grid)
    np.sort(grid, axis=None)
    return time.process_time() - begin
