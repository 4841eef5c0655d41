"""'make study_kills': runs that die at random moments, and workers of a Dask cluster that do; what follows is whole.

A case is run undisturbed once. Then the same case is killed (SIGKILL) again and again at moments drawn over its length:
with one worker and with two the whole run, which is then begun again in the folder as it was left; with a cluster one
of its two workers, beside which a new one joins, while the run must end by itself. After every death each product in
the folder is absent or that of the undisturbed run, and at the end all products and pages are. Rows are added to
data/studies/kills.csv; a case that stands there is not killed again.
"""

import argparse
import csv
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.contract.integrity.origin import git_commit
from tests.chain.run_contents import everything
from tests.contract.executors.dask_processes import address_of, kill, scheduler, worker
from tests.studies.ledger import FOLDER

ROOT = Path(__file__).parents[2]
#: one case of every chain that needs no recording and takes at most a minute
CASES = ("two_mode_flutter", "wobbling_disc", "belt", "pin_on_disc", "beam_on_beam", "beam_geometry", "disc_table1",
         "bimaterial_rupture_quick", "disc_brake_quick")
#: settings of a case that would take longer
_SHORTER = {"beam_geometry": {"rigid_generations": 2, "generations": 2, "population": 2, "joint_population": 5,
                              "joint_generations": 2, "walkers": 24, "sweeps": 4, "duration": "50 ms"}}
EXECUTORS = ("1", "2", "dask")
KILLS = 12
#: seconds that a command may take
_LONGEST = 1200
COLUMNS = ("case", "executor", "kills", "struck", "damaged", "recovered", "seconds", "commit")


@dataclass(frozen=True)
class Undisturbed:
    """What a run without disturbance leaves: ``content`` {file: digest}, after so many ``seconds``."""

    content: dict
    seconds: float


def begun(case, folder, options):
    """A run of a case in a process group of its own."""
    command = [sys.executable, "-m", "pipeline", "run", str(ROOT / "configs" / f"{case}.yaml"), "--run", str(folder)]
    for name, value in _SHORTER.get(case, {}).items():
        command += ["--set", f"{case}.{name}={value}"]
    return subprocess.Popen([*command, *options], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                            env={**os.environ, "PYTHONPATH": str(ROOT)}, start_new_session=True)


def undisturbed(case, folder, options=("--workers", "1")):
    """Undisturbed of a case."""
    begin = time.monotonic()
    if begun(case, folder, options).wait(_LONGEST):
        raise RuntimeError(f"{case}: the undisturbed run fails")
    return Undisturbed(everything(folder), time.monotonic() - begin)


def damaged(folder, whole):
    """Number of files in a folder that are not those of the undisturbed run."""
    held = everything(folder) if folder.exists() else {}
    return sum(whole.content.get(name) != digest for name, digest in held.items())


def killed(case, workers, folder, whole, moments):
    """(deaths that struck a run, damaged files) of a case whose run dies at each of ``moments`` [s]."""
    struck = wrong = 0
    for moment in moments:
        run = begun(case, folder, ("--workers", workers))
        try:
            run.wait(moment)
            shutil.rmtree(folder)       # done before its time came: from the start again
        except subprocess.TimeoutExpired:
            run.send_signal(signal.SIGKILL)
            run.wait()
            struck += 1
            wrong += damaged(folder, whole)
    return struck, wrong


def without_workers(case, folder, whole, moments):
    """The same where at each moment after the last one of two Dask workers dies, and another one joins; a run that has
    been given up is begun again."""
    struck = wrong = 0
    with ExitStack() as stack:
        address = address_of(stack.enter_context(scheduler()))
        spare = [stack.enter_context(worker(address, 1, folder.parent / "a")),
                 stack.enter_context(worker(address, 1, folder.parent / "b"))]
        run = begun(case, folder, ("--scheduler", address))
        for k, moment in enumerate(moments):
            try:
                if run.wait(moment) == 0:
                    shutil.rmtree(folder)       # else given up: Dask tries a task on four workers at most
                run = begun(case, folder, ("--scheduler", address))
            except subprocess.TimeoutExpired:
                kill(spare.pop(0))
                spare.append(stack.enter_context(worker(address, 1, folder.parent / f"w{k}")))
                struck += 1
        run.wait(_LONGEST)
        return struck, wrong + damaged(folder, whole)


def solved(case, executor, folder, whole, kills, seed):
    """Row of a case and an executor."""
    begin, random = time.monotonic(), np.random.default_rng([seed, CASES.index(case), EXECUTORS.index(executor)])
    if executor == "dask":
        moments = random.uniform(0.2, 1.0, kills) * whole.seconds / 3
        struck, wrong = without_workers(case, folder, whole, moments)
    else:
        struck, wrong = killed(case, executor, folder, whole, random.uniform(0.3, 0.95 * whole.seconds, kills))
    ended = begun(case, folder, ("--workers", "1")).wait(_LONGEST) == 0
    recovered = ended and everything(folder) == whole.content
    return (case, executor, kills, struck, wrong, "yes" if recovered else "no", f"{time.monotonic() - begin:.0f}",
            git_commit()[:10])


def rows(path):
    """[row] that stand in a CSV file."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def add(path, row):
    """Append a row, at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, row] if file.tell() == 0 else [row])


def main():
    """Kill what is chosen, print the sums."""
    parser = argparse.ArgumentParser(prog="make study_kills", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_kills")
    parser.add_argument("--ledger", type=Path, default=FOLDER / "kills.csv")
    parser.add_argument("--only", nargs="*", default=list(CASES), choices=CASES, help="cases; default all")
    parser.add_argument("--executors", nargs="*", default=list(EXECUTORS), choices=EXECUTORS, help="default all")
    parser.add_argument("--kills", type=int, default=KILLS, help="deaths of each case and executor")
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    for case in chosen.only:
        there = {(row["case"], row["executor"]) for row in rows(chosen.ledger)}
        left = [executor for executor in chosen.executors if (case, executor) not in there]
        shutil.rmtree(chosen.folder / case, ignore_errors=True)
        whole = undisturbed(case, chosen.folder / case / "whole") if left else None
        for executor in left:
            row = solved(case, executor, chosen.folder / case / executor, whole, chosen.kills, chosen.seed)
            print(*row, flush=True)
            add(chosen.ledger, row)
    every = rows(chosen.ledger)
    print(f"{sum(int(r['struck']) for r in every)} deaths, {sum(int(r['damaged']) for r in every)} files damaged,"
          f" {sum(r['recovered'] == 'yes' for r in every)} of {len(every)} cases recovered to the same content")


if __name__ == "__main__":
    main()
