"""'make fuzz SECONDS=600': mutated files to every reader, cases, quantities and products, in turn within the time.

Each input has a target, a seed and a number, and is the same whenever it is made. A run goes on where the last one of
the ledger ended. What fails is kept in tests/fuzz/seeds.yaml, which the tests replay. Fails where an input failed.
"""

import argparse
import os
import sys
import tempfile
import time

from pipeline.environment import ONE_THREAD, SAFE

os.environ.update(ONE_THREAD | SAFE)       # before anything loads linear algebra

#: failures shown of each target
_SHOWN = 10
#: seconds that each target has at least, also after one that took more than its share
_LEAST = 1.0


def main():
    """Parse the command line, try inputs, print the table and record it."""
    from tests.fuzz import ledger
    from tests.fuzz.targets import all_targets

    targets = all_targets()
    parser = argparse.ArgumentParser(prog="make fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=600.0, help="of the wall clock, for all targets")
    parser.add_argument("--only", nargs="+", choices=targets, metavar="TARGET", default=list(targets),
                        help=f"some of {', '.join(targets)}")
    parser.add_argument("--seed", type=int, default=1, help="another seed gives other inputs")
    options = parser.parse_args()
    end, rows, failures = time.monotonic() + options.seconds, [], []
    with tempfile.TemporaryDirectory(prefix="brakechain-fuzz-") as folder:
        tempfile.tempdir = folder
        for left, name in zip(range(len(options.only), 0, -1), options.only, strict=True):
            until = time.monotonic() + max((end - time.monotonic()) / left, _LEAST)
            row, failed = _tried(targets[name], options.seed, ledger.next_number(name, options.seed), until)
            rows, failures = [*rows, row], [*failures, *failed]
            print(f"{name:<14} {row.tried:>7} tried, {row.failed} failed", flush=True)
        tempfile.tempdir = None
    print("\n" + "\n".join(ledger.table(rows)))
    ledger.append(rows)
    ledger.keep(failures)
    return 1 if failures else 0


def _tried(target, seed, first, until):
    """(Row, failures) of the inputs from number ``first`` on, until this time of time.monotonic()."""
    from tests.fuzz.ledger import Row
    from tests.fuzz.trial import BAD
    from tests.fuzz.worker import tried

    row, failures, begin = Row(target.name, seed, first), [], time.monotonic()
    for number, result in tried(target, seed, range(first, first + 10_000_000), until):
        row.counts[result.kind] += 1
        row.known += result.known
        row.slowest = max(row.slowest, result.seconds)
        if result.kind in BAD:
            failures.append({"target": target.name, "seed": seed, "number": number, "kind": result.kind,
                             "said": f"{result.how}: {result.said}"[:200]})
            if len(failures) <= _SHOWN:
                print(f"  {failures[-1]}", flush=True)
    row.seconds = time.monotonic() - begin
    return row, failures


if __name__ == "__main__":
    sys.exit(main())
