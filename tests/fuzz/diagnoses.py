"""'make fuzz_diagnosis CASES=2000 SEED=1': random benches through 'brakechain run', each in a process of its own.

A diagnosis ends with an answer, or with a sentence about the case: an internal error, a traceback, a run without a
verdict and a verdict that hides an internal error fail.
"""

import argparse
import json
import os
import re
import resource
import sys
import tempfile
import time
import traceback
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from pipeline.environment import ONE_THREAD

os.environ.update(ONE_THREAD)       # before anything loads linear algebra

#: CPU seconds that one case may take before it is given up as slow
_LONGEST = 300
#: every so many cases have their page made too
_WITH_PAGE = 10
BAD = ("internal", "lost")


@dataclass(frozen=True)
class Outcome:
    """What became of a case: ``kind`` is answered, refused, slow, internal or lost; ``said``: verdict or message."""

    number: int
    kind: str
    said: str
    seconds: float


def ran(seed, number, folder):
    """(kind, said) of random bench ``number``, run in this process in an empty ``folder``."""
    from tests.commands import brakechain
    from tests.fuzz.random_benches import Bench
    from tests.readers import in_this_process

    Bench([seed, number]).write(folder)
    last = [] if number % _WITH_PAGE == 0 else ["--until", "diagnosis"]
    with in_this_process():
        done = brakechain("run", folder / "case.yaml", "--run", folder / "run", "--workers", 1, *last,
                          code=None)
    printed = done.stdout + done.stderr
    if "internal error" in printed or "Traceback" in printed:
        return "internal", printed[-1500:]
    if done.returncode in (2, 3, 4) and re.search(r"^error: .+: ", printed, re.M):
        return "refused", printed.strip().splitlines()[-1]
    verdict = folder / "run" / "diagnosis.json"
    if done.returncode or not verdict.exists() or not (last or (folder / "run" / "report.html").exists()):
        return "lost", printed[-1500:]
    text = verdict.read_text()
    if "internal error" in text:
        return "internal", "; ".join(set(re.findall(r"internal error [^;]*", text)))[:1500]
    answer = json.loads(text)
    return "answered" if answer["reasons"] else "lost", answer["verdict"]


def apart(seed, number, longest=_LONGEST):
    """Outcome of a case in a process of its own, which is stopped after ``longest`` CPU seconds."""
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="brakechain-diagnosis-") as folder:
        answer = Path(folder) / "answer.json"
        child = os.fork()
        if not child:
            resource.setrlimit(resource.RLIMIT_CPU, (longest, longest + 5))
            try:
                kind, said = ran(seed, number, Path(folder))
            except BaseException:
                kind, said = "internal", traceback.format_exc()[-1500:]
            answer.write_text(json.dumps([kind, said]))
            os._exit(0)
        _, status, usage = os.wait4(child, 0)
        kind, said = json.loads(answer.read_text()) if answer.exists() else (
            ("slow", f"more than {longest} CPU s") if os.WIFSIGNALED(status) and usage.ru_utime > 0.9 * longest
            else ("lost", f"status {status} after {usage.ru_utime:.0f} CPU s"))
    return Outcome(number, kind, said, usage.ru_utime if usage else time.monotonic() - begin)


def main():
    """Parse the command line, run cases, print what failed and a table."""
    parser = argparse.ArgumentParser(prog="make fuzz_diagnosis", description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--longest", type=int, default=_LONGEST, help="CPU seconds after which a case is given up")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:       # what all need is loaded once, for all children
        ran(0, 0, Path(folder))
    counts, slowest = Counter(), 0.0
    for number in range(options.first, options.first + options.cases):
        outcome = apart(options.seed, number, options.longest)
        counts[outcome.kind if outcome.kind != "answered" else f"answered: {outcome.said}"] += 1
        slowest = max(slowest, outcome.seconds)
        if outcome.kind != "answered":
            print(f"{outcome.kind} {options.seed} {number} ({outcome.seconds:.0f} s): {outcome.said}", flush=True)
    for kind, count in sorted(counts.items()):
        print(f"{kind:<22} {count:>6}")
    print(f"slowest: {slowest:.0f} CPU s")
    return 1 if any(counts[kind] for kind in BAD) else 0


if __name__ == "__main__":
    sys.exit(main())
