"""'make study_squeal': hidden physics on the practice pin-on-disc bench, diagnosed and scored.

Each of nine effects is hidden in four draws, beside controls with other values only; thresholds were set on other draws
(seeds below 100). 'make pin_bench' writes practice files. One folder a case; a case that has its answer is not solved
again. Cases are shared out over processes.
"""

import argparse
import json
import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from pipeline.blind_trial.generators.benches.pin_bench import DECOYS, HIDDEN, make, record
from pipeline.blind_trial.metrics.criteria import judged
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.contract import documents
from pipeline.recordings.neutral import write_neutral
from tests.studies.forced import answered, by_stages, recorded, shared_out

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "configs" / "pin_on_disc_bench.yaml"
DRAWS, CONTROLS = 4, 60
#: effects of the practice files, in the order of their names; '' is the control
PRACTICE = ("falling_friction", "contact_memory", "contact_stiffness_law", "doublet_split", "moving_base", "runout", "")


@dataclass(frozen=True)
class Plan:
    """A draw: its seed and what it hides, '' for nothing but other values."""

    seed: int
    hidden: str


def plans(first=1000):
    """Four draws of each effect, one after the other through all effects, then the controls."""
    names = [name for _ in range(DRAWS) for name in HIDDEN] + [""] * CONTROLS
    return [Plan(first + k, name) for k, name in enumerate(names)]


def write(plan, folder):
    """recordings.h5 and truth.json of a Plan in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    made, truth = _made(plan)
    write_neutral(folder / "recordings.h5", record(made, plan.seed))
    (folder / "truth.json").write_text(json.dumps({"effect": plan.hidden, **truth}, indent=1) + "\n")


def _made(plan):
    decoy = plan.hidden in DECOYS
    return make(plan.seed, () if decoy or not plan.hidden else (plan.hidden,), (plan.hidden,) if decoy else ())


def solved(path, **asked):
    """diagnosis.json of a file of recordings under the case pin_on_disc_bench."""
    return by_stages(documents.read_yaml(CONFIG), recorded(path), **asked)


def scored(hidden, answer):
    """{right, false_alarm} of one case; a decoy is right where the verdict is that of a sensor."""
    kind = "sensor" if hidden in DECOYS else "effect" if hidden else "control"
    found = judged({"class": kind, "effects": [{"name": hidden, "place": ""}] if hidden else []}, answer)
    return {"right": found["called" if kind == "sensor" else "right"], "false_alarm": found.get("false_alarm", False)}


def table(results):
    """Lines of rates with their 95 % intervals from [(hidden, answer)]."""
    rows = [(name or "controls told right", [scored(h, a)["right"] for h, a in results if h == name])
            for name in dict.fromkeys(h for h, _ in results)]
    rows += [("all effects", [scored(h, a)["right"] for h, a in results if h]),
             ("false alarms on controls", [scored(h, a)["false_alarm"] for h, a in results if not h])]
    return [line(name, rate(hits)) for name, hits in rows if hits]


def run(plan, folder, **asked):
    """Answer of one Plan, from its files where they are there."""
    if not (folder / "answer.json").exists():
        write(plan, folder)
    return answered(folder, partial(solved, folder / "recordings.h5", **asked))


def solve(folder, plan):
    """(what it hides, answer) of one Plan in its folder; prints its line."""
    answer = run(plan, folder / f"{plan.seed}")
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    print(f"{plan.seed} {plan.hidden or 'control':<28} -> {answer['verdict']:<10} {named}"
          f"   {answer['cpu_seconds']:.0f} s", flush=True)
    return plan.hidden, answer


def practice(folder):
    """bench_0.h5 ... of PRACTICE, each with its truth beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, hidden in enumerate(PRACTICE):
        made, truth = _made(Plan(number, hidden))
        write_neutral(folder / f"bench_{number}.h5", record(made, number))
        (folder / f"bench_{number}_truth.json").write_text(json.dumps({"effect": hidden, **truth}, indent=1) + "\n")


def main():
    """Write the practice files, or solve what is chosen and print the table."""
    commanded("study_squeal", __doc__, 1000, practice, plans, solve, table)


def commanded(name, description, first, practice, plans, solve, table):
    """Run the study ``name`` as the command line asks: ``practice(folder)``, or ``solve(folder, plan)`` of what is
    chosen of ``plans(first)`` and its ``table(results)``."""
    parser = argparse.ArgumentParser(prog=f"make {name}", description=description)
    parser.add_argument("--practice", action="store_true", help="write the practice files and stop")
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs")
    parser.add_argument("--only", nargs="*", help="hidden physics; 'control' for none; default all")
    parser.add_argument("--most", type=int, default=None, help="so many cases at most")
    parser.add_argument("--first", type=int, default=first, help="seed of the first draw")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes; default all processors")
    chosen = parser.parse_args()
    if chosen.practice:
        practice(chosen.folder / "practice")
        return
    wanted = [p for p in plans(chosen.first) if not chosen.only or (p.hidden or "control") in chosen.only]
    results = shared_out(partial(solve, chosen.folder / name), wanted[:chosen.most], chosen.workers)
    print("\n".join(table(results)))


if __name__ == "__main__":
    main()
