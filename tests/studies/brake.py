"""'make study_brake': hidden physics on the practice disc brake, diagnosed and scored.

Each of eleven effects is hidden in two draws, beside controls with other values only and physics that the catalogue
lacks; rules were tried on other draws (seeds below 100). 'make brake_bench' writes practice files. One folder a case; a
case that has its answer is not solved again. Cases are shared out over processes.
"""

import json
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.brake import brake, brake_files
from pipeline.blind_trial.generators.brake.brake_parts import NOMINAL, PAD, SHAPES, built
from pipeline.blind_trial.generators.brake.pad_joints import FURTHER
from pipeline.blind_trial.generators.systems import Draw
from pipeline.blind_trial.metrics.criteria import judged
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.contract import documents
from pipeline.contract.errors import ConvergenceError
from tests.studies import brake_stops
from tests.studies.forced import answered, by_stages, recorded
from tests.studies.self_excited import commanded

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "configs" / "disc_brake_bench.yaml"
CONTROLS = 6
EFFECTS = (*brake.HIDDEN, *FURTHER)
#: (class, what is hidden) of the practice files, in the order of their names; the last is of another brake
ANOTHER = "another_brake"
PRACTICE = (*(("effect", name) for name in EFFECTS), ("control", ""), ("wrong_value", ""),
            ("foreign", "resonant_clip"), (ANOTHER, ""))
#: the disc of another brake as SHAPES has them, and its values over those of NOMINAL
OTHER_SHAPE = (0.070, 0.100, 0.205, 0.0080, 0.0105)
OTHER = {"young": 1.3, "density": 0.75, "contact": 2.0, "shear": 0.5, "abutment_outer": 0.5, "abutment_inner": 2.0,
         "fingers": 2.0, "pad": 1.5}
#: seeds that a draw is tried with, as some brakes squeal, and how far apart they lie
_TRIES, _APART = 12, 100_000


@dataclass(frozen=True)
class Plan:
    """A draw: its seed, its class and what it hides, '' for nothing."""

    seed: int
    kind: str
    hidden: str


def plans(first=7000):
    """A draw of each effect, controls and what no catalogue has, then another draw of each effect."""
    rounds = [("effect", name) for name in EFFECTS]
    empty = [*[("control", "")] * CONTROLS, *(("foreign", name) for name in brake.FOREIGN)]
    return [Plan(first + k, *one) for k, one in enumerate([*rounds, *empty, *rounds])]


def write(plan, folder):
    """recordings.h5 and truth.json of a Plan in a folder; returns the truth."""
    truth = _another(plan.seed, folder) if plan.kind == ANOTHER else _drawn(plan, folder)
    (folder / "nominal.yaml").unlink()      # the workshop's model is that of CONFIG
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    return truth


def _drawn(plan, folder):
    """The truth of a brake of the shape of CONFIG, of a seed further on where that of the Plan squeals."""
    for attempt in range(_TRIES):
        seed, hidden = plan.seed + attempt * _APART, (plan.hidden,) * bool(plan.hidden)
        try:
            return brake_files.write(Draw(seed, "disc_brake", plan.kind, hidden, 0.0, 0.0), folder, SHAPES[0])
        except ConvergenceError as error:
            told = error
    raise told


def _another(seed, folder):
    """The truth of another brake, that of no drawing."""
    values = {name: factor * {**NOMINAL, "pad": PAD}[name] for name, factor in OTHER.items()}
    case_files.leave(folder, {}, brake.record(built({**NOMINAL, **values}, OTHER_SHAPE), seed))
    return {"class": ANOTHER, "seed": seed, "effects": [], "disc": OTHER_SHAPE, "values": values}


def solved(path, **asked):
    """diagnosis.json of a file of recordings under the case disc_brake_bench."""
    return by_stages(documents.read_yaml(CONFIG), recorded(path), **asked)


def table(results):
    """Lines of rates with their 95 % intervals from [(truth, answer)]."""
    effects = [(t["effects"][0]["name"], judged(t, a)["right"]) for t, a in results if t["class"] == "effect"]
    other = {kind: [judged(t, a) for t, a in results if t["class"] == kind] for kind in ("control", "foreign")}
    rows = [(name, [hit for n, hit in effects if n == name]) for name in dict(effects)]
    rows += [("all effects", [hit for _, hit in effects]),
             ("false alarms on controls", [s["false_alarm"] for s in other["control"]]),
             ("controls told right", [s["right"] for s in other["control"]]),
             ("out of the catalogue: unknown", [s["right"] for s in other["foreign"]])]
    return [line(name, rate(hits)) for name, hits in rows if hits]


def run(plan, folder, **asked):
    """(truth, answer) of one Plan, from its files where they are there."""
    if not (folder / "truth.json").exists():
        write(plan, folder)
    truth = json.loads((folder / "truth.json").read_text())
    return truth, answered(folder, partial(solved, folder / "recordings.h5", **asked))


def solve(folder, plan):
    """(truth, answer) of one Plan in its folder; prints its line."""
    truth, answer = run(plan, folder / f"{plan.seed}")
    hidden = ", ".join(f"{e['name']} at {e['place']}" for e in truth["effects"]) or plan.kind
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    print(f"{plan.seed} {hidden:<40} -> {answer['verdict']:<10} {named}   {answer['cpu_seconds']:.0f} s", flush=True)
    return truth, answer


def practice(folder):
    """brake_0.h5 ... of PRACTICE, each with its truth beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, (kind, hidden) in enumerate(PRACTICE):
        with TemporaryDirectory(dir=folder) as made:
            write(Plan(number, kind, hidden), Path(made))
            (Path(made) / "recordings.h5").replace(folder / f"brake_{number}.h5")
            (Path(made) / "truth.json").replace(folder / f"brake_{number}_truth.json")


def all_practice(folder):
    """The practice files of taps alone, and those of stops that squeal."""
    practice(folder)
    brake_stops.practice(folder)


def main():
    """Write the practice files, or solve what is chosen and print the table."""
    commanded("study_brake", __doc__, 7000, all_practice, plans, solve, table)


if __name__ == "__main__":
    main()
