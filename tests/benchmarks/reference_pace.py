"""Write the table of reference of the forecast from runs on this machine, best otherwise idle, with two processes:

    python -m tests.benchmarks.reference_pace CASE=FOLDER [CASE=FOLDER ...]

Times are those that the products record; a case is read for its measures of work. Prints forecast and time taken."""

import json
import os
import sys
from pathlib import Path

from pipeline.environment import ONE_THREAD

os.environ.update(ONE_THREAD)       # before anything loads linear algebra

import h5py  # noqa: E402

import stages  # noqa: E402
from pipeline.case_models.early.reference_pace import TABLE, Reference, Row, measured  # noqa: E402
from pipeline.case_models.early.work import work  # noqa: E402
from pipeline.contract import case  # noqa: E402
from pipeline.recordings import registry  # noqa: E402

#: shorter stages are left out (s), and those whose work has no measure
_SHORTEST, _UNMEASURED = 0.5, ("multibody", "response", "squeal")


def rows_of(config, folder):
    """{stage: Row} of a run of the case ``config`` in its ``folder``."""
    measures = work(case.load(config, stages.CHAINS, stages.load, measured=registry.path).sections)
    rows = {}
    for name, size in measures.items():
        file = folder / f"{name}.h5"
        if file.exists():
            with h5py.File(file) as product:
                cpu, wall = (float(product["provenance"].attrs[f"{kind}_seconds"]) for kind in ("cpu", "wall"))
            if cpu >= _SHORTEST and name not in _UNMEASURED:
                beside = 0.0 if stages.load(name).alone else min(max(2 * (1 - wall / cpu), 0.0), 1.0)
                rows[name] = Row(size, round(cpu, 2), round(beside, 2))
    return rows


def main(pairs):
    """Write the table, and print what it says of the runs that it is made of."""
    runs = {pair: rows_of(*map(Path, pair.split("="))) for pair in pairs}
    table = {}
    for rows in runs.values():
        for name, row in rows.items():
            table.setdefault(name, []).append(row)
    TABLE.write_text(json.dumps({"processor": measured(), "stages": table}, indent=1) + "\n")
    reference = Reference()
    for pair, rows in runs.items():
        told = sum(reference.seconds(name, row.work, 2) for name, row in rows.items())
        taken = sum(row.cpu * (1 - row.beside / 2) for row in rows.values())
        print(f"{pair}: {told:.0f} s forecast, {taken:.0f} s taken, {told / taken:.2f}")


if __name__ == "__main__":
    main(sys.argv[1:])
