"""'make bench': wall and CPU seconds of the kernels, their peers, every stage and the diagnoses, each in one table.

Kernels: median of repeated calls in this process, one thread, after a first call, which compiles;
         "1st CPU": its CPU seconds and those of making its data.
Peers: the same work done by other programs, where they are installed.
Stages: the quick case from nothing, seconds as its products record them.
Diagnoses: the public recordings (where BRAKECHAIN_DATA names them) and one practice file, from nothing to the verdict.

Writes data/runs/bench/COMMIT.json; --compare sets an earlier file beside it. Fails where a kernel or a case fails.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

from pipeline.environment import ONE_THREAD

os.environ.update(ONE_THREAD)       # before anything loads linear algebra

ROOT = Path(__file__).parents[2]
#: cases that diagnose public recordings
MEASURED = ("emps", "silverbox", "tribometer")


def main():
    """Parse the command line, print the tables and record them."""
    from tests.benchmarks import results

    parser = argparse.ArgumentParser(prog="make bench", description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5, help="counted calls of each kernel")
    parser.add_argument("--case", type=Path, default=ROOT / "configs" / "disc_brake_quick.yaml", help="case to time")
    parser.add_argument("--only", nargs="+", choices=results.TABLES, default=results.TABLES, help="some of the tables")
    parser.add_argument("--kernels", nargs="+", metavar="NAME", help="some of the kernels, and their peers")
    parser.add_argument("--compare", nargs="+", metavar="COMMIT",
                        help="an earlier results file or the beginning of its commit; with two, nothing is run")
    options = parser.parse_args()
    earlier = [results.load(name) for name in options.compare or ()]
    if len(earlier) > 1:
        print("\n".join(results.comparison(*earlier[:2])))
        return 0
    tables, failures = run_tables(options)
    file = results.save(tables)
    print(f"\nwritten: {file}")
    if earlier:
        print("\n" + "\n".join(results.comparison(earlier[0], results.load(file))))
    if failures:
        print(f"\nfailed: {', '.join(failures)}")
    return 1 if failures else 0


def run_tables(options):
    """({table: {name: row}}, names that failed); prints as it goes."""
    tables, failures = {}, []
    if {"kernels", "peers"} & set(options.only):
        tables, failures = kernel_tables(options)
    for name, rows in (("stages", lambda: stage_rows(options.case)), ("diagnoses", diagnosis_rows)):
        if name in options.only:
            try:
                tables[name] = rows()
            except subprocess.CalledProcessError as error:
                print(f"{name}: {' '.join(map(str, error.cmd[3:]))} failed with code {error.returncode}")
                failures.append(name)
    return tables, failures


def kernel_tables(options):
    """({"kernels": rows, "peers": rows}, names that failed)."""
    from tests.benchmarks.kernels import KERNELS, PAIRS
    from tests.benchmarks.peers import PEERS

    chosen = [k for k in KERNELS if not options.kernels or k.__name__ in options.kernels]
    rows, failures, peers = {"kernels": {}, "peers": {}}, [], []
    if "peers" in options.only:
        peers = [peer for peer, kernel, _ in PEERS if kernel in chosen]
    print(f"{'kernel':<58} {'1st CPU':>8} {'wall s':>9} {'CPU s':>9} {'CPU min':>9}   rate per CPU second")
    for table, calls in (("kernels", chosen if "kernels" in options.only else []), ("peers", peers)):
        for make in calls:
            row = _kernel_row(make, options.runs)
            if row is not None:
                rows[table][make.__name__] = row
            if row == {}:
                failures.append(make.__name__)
                del rows[table][make.__name__]
    compared = [*((a.__name__, b.__name__) for a, b in PAIRS), *((b.__name__, a.__name__) for a, b, _ in PEERS)]
    every = {**rows["kernels"], **rows["peers"]}
    for first, second in compared:
        if first in every and second in every:
            print(f"{first} over {second}: {every[first]['rate'] / every[second]['rate']:.2f} times the rate")
    return rows, failures


def _kernel_row(make, runs):
    """Row of a kernel or a peer, which is printed; None where its program is not installed, {} where it fails."""
    from tests.benchmarks.measuring import cpu_seconds, measured
    from tests.benchmarks.peers import NotInstalled

    title = make.__doc__.splitlines()[0]
    try:
        begin = cpu_seconds()
        call, amount, unit = make()
        timing = measured(call, runs, cpu_seconds() - begin)
    except NotInstalled as missing:
        print(f"{title:<58} not installed: {missing}", flush=True)
        return None
    except Exception:   # the others are to be printed all the same
        print(f"{title:<58} failed:\n{traceback.format_exc()}", flush=True)
        return {}
    wall, cpu = timing.median
    rate = f"{amount / cpu:,.0f}" if amount > 100 * cpu else f"{amount / cpu:.3g}"
    print(f"{title:<58} {timing.first:8.2f} {wall:9.4f} {cpu:9.4f} {min(timing.cpu):9.4f}   {rate} {unit}", flush=True)
    return {"work": f"{amount} {unit}", "rate": amount / cpu, "first_cpu_seconds": timing.first, "wall_seconds": wall,
            "cpu_seconds": cpu, "wall_each": timing.wall, "cpu_each": timing.cpu}


def _run(case, folder, *more):
    """(wall, CPU seconds) of the whole command."""
    from tests.benchmarks.measuring import timed

    command = [sys.executable, "-m", "pipeline", "run", case, "--run", folder, *more]
    return timed(lambda: subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL))


def stage_rows(case):
    """Rows of the stages of ``case``, run in an empty folder, which are printed."""
    from pipeline.contract import store
    from stages import NAMES

    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        wall, cpu = _run(case, folder)
        print(f"\n{'stage of ' + case.stem:<24} {'wall s':>8} {'CPU s':>8} {'file MB':>8}")
        for name in NAMES:
            path = Path(folder) / f"{name}.h5"
            if path.exists():
                rows[name] = {"work": case.stem, **_seconds(path)}
                print(f"{name:<24} {rows[name]['wall_seconds']:8.2f} {rows[name]['cpu_seconds']:8.2f}"
                      f" {path.stat().st_size / 1e6:8.1f}")
                packages = json.loads(store.provenance(path)["packages"])
    rows["whole command"] = {"work": case.stem, "wall_seconds": wall, "cpu_seconds": cpu}
    print(f"{'whole command':<24} {wall:8.2f} {cpu:8.2f}    {', '.join(f'{k} {v}' for k, v in packages.items())}",
          flush=True)
    return rows


def _seconds(path):
    from pipeline.contract import store

    recorded = store.provenance(path)
    return {name: float(recorded[name]) for name in ("wall_seconds", "cpu_seconds")}


def diagnosis_rows():
    """Rows of the diagnoses: seconds of the stage and of the whole command, and the verdict."""
    from tests.studies import self_excited

    rows = {}
    print(f"\n{'diagnosis of':<24} {'stage s':>8} {'CPU s':>8} {'whole s':>8} {'CPU s':>8}   verdict")
    with tempfile.TemporaryDirectory() as folder:
        for name in MEASURED if os.environ.get("BRAKECHAIN_DATA") else ():
            rows[name] = _diagnosis_row(name, Path(folder) / name)
        self_excited.practice(Path(folder) / "practice")
        bench = Path(folder) / "practice" / "bench_0.h5"
        rows["pin_on_disc_bench"] = _diagnosis_row("pin_on_disc_bench", Path(folder) / "pin", "--set",
                                                   f"recording.files.0.file={bench}")
    return rows


def _diagnosis_row(name, folder, *more):
    wall, cpu = _run(ROOT / "configs" / f"{name}.yaml", folder, *more)
    row = {"work": name, **_seconds(folder / "diagnosis.h5"), "whole_wall_seconds": wall, "whole_cpu_seconds": cpu,
           "verdict": json.loads((folder / "diagnosis.json").read_text())["verdict"]}
    print(f"{name:<24} {row['wall_seconds']:8.2f} {row['cpu_seconds']:8.2f} {wall:8.2f} {cpu:8.2f}   {row['verdict']}",
          flush=True)
    return row


if __name__ == "__main__":
    sys.exit(main())
