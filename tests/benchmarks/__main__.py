"""'make bench': seconds of the kernels, of every stage and of the diagnoses, each in one table. Asserts nothing.

Kernels: median of repeated calls in this process, one thread, after one warm-up call.
Stages: the quick case from nothing, wall and CPU seconds as its products tell them.
Diagnoses: the public recordings (where BRAKECHAIN_DATA names them) and one practice file, from nothing to the verdict.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pipeline.contract import store
from stages import NAMES
from tests.benchmarks.kernels import KERNELS, PAIRS
from tests.studies import self_excited

ROOT = Path(__file__).parents[2]
#: cases that diagnose public recordings
MEASURED = ("emps", "silverbox", "tribometer")


def main():
    """Parse the command line and print the tables."""
    parser = argparse.ArgumentParser(prog="make bench", description=__doc__)
    parser.add_argument("--runs", type=int, default=5, help="counted calls of each kernel")
    parser.add_argument("--case", type=Path, default=ROOT / "configs" / "disc_brake_quick.yaml", help="case to time")
    parser.add_argument("--only", choices=("kernels", "stages", "diagnoses"), help="one of the tables")
    chosen = parser.parse_args()
    if chosen.only in (None, "kernels"):
        print_kernels(chosen.runs)
    if chosen.only in (None, "stages"):
        print_stages(chosen.case)
    if chosen.only in (None, "diagnoses"):
        print_diagnoses()


def print_kernels(runs):
    """One line a kernel: median seconds, spread, and the rate that its work amounts to; then ratios of rates."""
    rates = {}
    print(f"{'kernel':<58} {'median s':>9} {'min':>9} {'max':>9}   rate")
    for kernel in KERNELS:
        call, amount, unit = kernel()
        call()
        seconds = [_timed(call) for _ in range(runs)]
        middle = statistics.median(seconds)
        rates[kernel] = amount / middle
        rate = f"{rates[kernel]:,.0f} {unit}/s"
        print(f"{kernel.__doc__.splitlines()[0]:<58} {middle:9.4f} {min(seconds):9.4f} {max(seconds):9.4f}   {rate}")
    for first, second in PAIRS:
        print(f"{first.__name__} over {second.__name__}: {rates[first] / rates[second]:.2f} times the rate")


def _timed(call):
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def _run(case, folder, *more):
    subprocess.run([sys.executable, "-m", "pipeline", "run", case, "--run", folder, *more], check=True, cwd=ROOT,
                   stdout=subprocess.DEVNULL)


def print_stages(case):
    """One line a stage of ``case``, run in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        whole = _timed(lambda: _run(case, folder))
        print(f"\n{'stage of ' + case.stem:<24} {'wall s':>8} {'CPU s':>8} {'file MB':>8}")
        for name in NAMES:
            path = Path(folder) / f"{name}.h5"
            if not path.exists():       # a stage of another chain
                continue
            told = store.provenance(path)
            size = path.stat().st_size / 1e6
            print(f"{name:<24} {told['wall_seconds']:8.2f} {told['cpu_seconds']:8.2f} {size:8.1f}")
        packages = json.loads(told["packages"])
    print(f"{'whole command':<24} {whole:8.2f}    {', '.join(f'{k} {v}' for k, v in packages.items())}")


def print_diagnoses():
    """One line a diagnosis: seconds of the stage and of the whole command, its verdict."""
    print(f"\n{'diagnosis of':<24} {'stage s':>8} {'CPU s':>8} {'whole s':>8}   verdict")
    with tempfile.TemporaryDirectory() as folder:
        for name in MEASURED if os.environ.get("BRAKECHAIN_DATA") else ():
            _diagnosed(name, Path(folder) / name)
        self_excited.practice(Path(folder) / "practice")
        bench = Path(folder) / "practice" / "bench_0.h5"
        _diagnosed("pin_on_disc_bench", Path(folder) / "pin", "--set", f"recording.files.0.file={bench}")


def _diagnosed(name, folder, *more):
    whole = _timed(lambda: _run(ROOT / "configs" / f"{name}.yaml", folder, *more))
    told = store.provenance(folder / "diagnosis.h5")
    verdict = json.loads((folder / "diagnosis.json").read_text())["verdict"]
    print(f"{name:<24} {told['wall_seconds']:8.2f} {told['cpu_seconds']:8.2f} {whole:8.2f}   {verdict}", flush=True)


if __name__ == "__main__":
    main()
