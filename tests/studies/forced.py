"""'make study_diagnosis': hidden physics on forced rigs, recorded by a generator of its own, diagnosed and scored.

One folder a case; a case that has its answer is not solved again. Cases are shared out over processes. Prints one line
a case, then the table of rates. A case that the diagnosis refuses (``refused``) counts as not right.
"""

import argparse
import json
import os
import time
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.placement import places
from pipeline.blind_trial.generators.spring_mass.rig_case import made
from pipeline.blind_trial.metrics.criteria import class_of, judged
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.contract import documents
from pipeline.contract.errors import BrakechainError
from pipeline.contract.executors import LocalProcesses
from pipeline.contract.settings import fill
from pipeline.diagnosis.output.files import as_json
from pipeline.products import Recording
from pipeline.recordings.neutral import read_neutral
from stages.bench import bench
from stages.diagnosis import diagnosis
from stages.lumped import lumped
from stages.reduced_model import reduced_model

LEVELS, PLACES, CONTROLS = (0.01, 0.1), 2, 130
#: share of the cases whose noise is coloured, by its correlation over a sample
COLOURS = (0.0, 0.0, 0.0, 0.2)
#: seeds that a draw is tried with, and how far apart they lie
_TRIES, _APART = 12, 100_000
ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Plan:
    """What to make: see ``pipeline.blind_trial.generators.spring_mass.rig_case.made``."""

    seed: int
    hidden: str
    place: int
    level: float
    masses: int
    colour: float


def plans(controls=CONTROLS, first=1000):
    """Every piece of hidden physics x places x noise levels, then controls of 1 to 4 masses."""
    found = []
    for name, piece in HIDDEN.items():
        masses = 3 if piece.place == "wall link" else 2
        for place in range(min(PLACES, len(places(piece, masses)))):
            found += [(name, place, level, masses) for level in LEVELS]
    found += [("", 0, LEVELS[k % 2], 1 + k % 4 if k % 8 > 5 else 1 + k % 2) for k in range(controls)]
    return [Plan(first + k, *one, COLOURS[k % len(COLOURS)]) for k, one in enumerate(found)]


def solved(folder, **asked):
    """diagnosis.json of a case's folder; sees nominal.yaml and recordings.h5 alone."""
    return by_stages(documents.read_yaml(folder / "nominal.yaml"), recorded(folder / "recordings.h5"), **asked)


def recorded(path):
    """Recording of a file in the neutral layout."""
    return Recording(source=[path.name], runs=read_neutral(path))


def filled(document, stage, **more):
    """The settings of a stage in a case's ``document``, with ``more``."""
    return fill(stage.settings, {**document.get(stage.name, {}), **more}, stage.name)


def by_stages(document, recording, **asked):
    """diagnosis.json of a case's ``document`` with its Recording, by the stages themselves."""
    section = partial(filled, document)
    model = reduced_model(lumped(settings=section(lumped)), settings=section(reduced_model))
    shown = bench(model, None, recording, settings=section(bench))
    return as_json(diagnosis(model, None, recording, shown, settings=section(diagnosis, **asked)))


def table(results):
    """Lines of rates with their intervals from [(truth, answer)]; what leaves too little to be told counts apart."""
    rows = []
    for level in LEVELS:
        own = [judged(t, a) for t, a in results if t["noise"] == level and class_of(t) in ("effect", "sensor")]
        rows.append((f"type and place at {level:.0%} noise", [s["right"] for s in own]))
        rows.append((f"type alone at {level:.0%} noise", [s["type"] for s in own]))
        rows.append((f"truth among the tied at {level:.0%} noise", [s["among_tied"] for s in own]))
    controls = [judged(t, a) for t, a in results if t["class"] == "control"]
    rows.append(("false alarms on controls", [s["false_alarm"] for s in controls]))
    rows.append(("controls told right", [s["right"] for s in controls]))
    foreign = [judged(t, a) for t, a in results if class_of(t) == "foreign"]
    rows.append(("out of the catalogue: unknown", [s["right"] for s in foreign]))
    faint = [judged(t, a) for t, a in results if class_of(t) == "below"]
    rows.append(("below the threshold: nothing wrong named", [s["right"] for s in faint]))
    return [line(name, rate(hits)) for name, hits in rows if hits]


def drawn(plan):
    """Case of a Plan, of a seed further on where none can be made of its own."""
    for attempt in range(_TRIES):
        try:
            return made(plan.seed + attempt * _APART, plan.hidden, plan.place, plan.level, plan.masses, plan.colour)
        except BrakechainError as error:
            told = error
    raise told


def run(plan, folder, **asked):
    """(truth, answer) of one Plan, from its files where they are there."""
    case = cache(partial(drawn, plan))
    if not (folder / "recordings.h5").exists():
        case_files.write(case(), folder)
    answer = answered(folder, partial(solved, folder, **asked))
    if not (folder / "truth.json").exists():
        (folder / "truth.json").write_text(json.dumps(score_of(case(), answer), indent=1) + "\n")
    return json.loads((folder / "truth.json").read_text()), answer


def score_of(case, answer):
    """What the ``answer`` is judged by: laws like the effect that is hidden, which take minutes to be found, only where
    it names something else."""
    told = case_files.truth(case, looked_for=("foreign",))
    return told if case.kind != "effect" or judged(told, answer)["right"] else case_files.truth(case)


def answered(folder, solve):
    """The answer kept in a case's folder, else that of ``solve()``, with its CPU seconds; a refusal is one, too."""
    return kept_answer(folder / "answer.json", lambda: None, lambda case: solve())


def kept_answer(kept, make, solve, told=lambda case, answer: {}):
    """The answer in the file ``kept``, else that of ``solve(make())``, with the CPU seconds of solving and what
    ``told(case, answer)`` adds; a refusal is one, too."""
    if not kept.exists():
        case, begun = make(), time.process_time()
        try:
            answer = solve(case)
        except BrakechainError as error:
            answer = {"verdict": "refused", "effects": [], "reasons": [str(error)]}
        answer = {**answer, "cpu_seconds": time.process_time() - begun}
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps({**answer, **told(case, answer)}, indent=1) + "\n")
    return json.loads(kept.read_text())


def solve(folder, kept, plan):
    """(truth, answer) of one Plan in its folder, or None where its case cannot be made; prints its line."""
    try:
        truth, answer = run(plan, folder / f"{plan.seed}", kept=kept)
    except BrakechainError as error:
        print(f"{plan.seed} {plan.hidden}: not made: {error}", flush=True)
        return None
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    hidden = ", ".join(f"{e['name']} at {e['place']}" for e in truth["effects"])
    print(f"{plan.seed} {truth['class']:<8} {hidden:<31} {truth['noise']:>4.0%}  ->"
          f" {answer['verdict']:<10} {named}   {answer['cpu_seconds']:.0f} s", flush=True)
    return truth, answer


def shared_out(solve, plans, workers):
    """[solve(plan)] in the order of ``plans``, over so many processes."""
    pool = LocalProcesses(workers)
    try:
        return pool.map(solve, plans, lambda: None)
    finally:
        pool.close()


def main():
    """Solve what is chosen, print the table."""
    parser = argparse.ArgumentParser(prog="make study_diagnosis", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_diagnosis")
    parser.add_argument("--only", nargs="*", help="hidden physics; 'control' for none; default all")
    parser.add_argument("--every", type=int, default=1, help="one case in so many")
    parser.add_argument("--kept", type=int, default=4, help="candidates that are refitted")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes; default all processors")
    chosen = parser.parse_args()
    wanted = [p for p in plans() if not chosen.only or (p.hidden or "control") in chosen.only][::chosen.every]
    results = shared_out(partial(solve, chosen.folder, chosen.kept), wanted, chosen.workers)
    print("\n".join(table([r for r in results if r])))


if __name__ == "__main__":
    main()
