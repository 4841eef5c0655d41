"""'make study_lines': does the tool name a disc that is flexible in the loop, and only where it is?

Benches recorded by the independent brake of ``squealing_brake``: twelve with a flexible disc, six whose disc does not
move and six whose lines nothing explains. The tool is given the folder ``public`` of a case alone; the truth lies
beside it and is opened for the score. One folder a case; a case that has its answer is not solved again.
"""

import argparse
import json
import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from pipeline.blind_trial.generators.brake import squealing_files
from pipeline.blind_trial.generators.brake.squealing_brake import FOREIGN, ONE_WAY, TWO_WAY
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.contract import documents
from pipeline.contract.errors import BrakechainError
from pipeline.products import Recording
from pipeline.recordings.neutral import read_neutral
from stages.complex_modes import complex_modes
from stages.line_evidence import line_evidence
from stages.lumped import lumped
from stages.reduced_model import reduced_model
from tests.studies.forced import answered, filled, shared_out

ROOT = Path(__file__).parents[2]
COUNTS = {TWO_WAY: 12, ONE_WAY: 6, FOREIGN: 6}
#: verdict that is right for a kind; a control is wrong only where the flexible disc is named
RIGHT = {TWO_WAY: "flexible", ONE_WAY: "rigid", FOREIGN: "none"}
#: seeds that a case is tried with, and how far apart they lie
_TRIES, _APART = 12, 100_000


@dataclass(frozen=True)
class Plan:
    """A bench: its seed and its kind."""

    seed: int
    kind: str


def plans(first=1000):
    """Benches of all kinds, in the order of COUNTS."""
    kinds = [kind for kind, count in COUNTS.items() for _ in range(count)]
    return [Plan(first + k, kind) for k, kind in enumerate(kinds)]


def write(plan, folder):
    """The files of a Plan: ``public`` for the tool, truth.json beside it. A brake without a line is drawn again."""
    for attempt in range(_TRIES):
        try:
            truth = squealing_files.write(plan.seed + attempt * _APART, plan.kind, folder / "public")
        except BrakechainError as error:
            last = error
            continue
        if any(len(run.lines["microphone"].frequency)
               for run in read_neutral(folder / "public" / "recordings.h5").values()):
            (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
            return
        last = BrakechainError(f"seed {plan.seed}: no line in any test")
    raise last


def modes_of(document):
    """(ReducedModel, ComplexModes) of the document of a case."""
    section = partial(filled, document)
    model = reduced_model(lumped(settings=section(lumped)), settings=section(reduced_model))
    return model, complex_modes(model, None, None, None, settings=section(complex_modes))


def weighed(public, **asked):
    """LineEvidence by the files in a folder alone."""
    document, path = documents.read_yaml(public / "nominal.yaml"), public / "recordings.h5"
    model, modes = modes_of(document)
    recording = Recording(source=[path.name], runs=read_neutral(path))
    return line_evidence(model, None, modes, recording, settings=filled(document, line_evidence, **asked))


def solved(public, **asked):
    """{verdict, ln Bayes factor and its error, ln evidence by hypothesis, lines} of a folder."""
    made = weighed(public, **asked)
    return {"verdict": str(made.verdict), "flexible": float(made.flexible), "error": float(made.flexible_error),
            "evidence": {str(n): float(e) for n, e in zip(made.hypothesis, made.evidence, strict=True)},
            "lines": [float(f) for f in made.line]}


def scored(kind, answer):
    """right, undecided or wrong."""
    if answer["verdict"] == RIGHT[kind]:
        return "right"
    return "undecided" if answer["verdict"] in ("undecided", "refused") else "wrong"


def table(results):
    """Lines of counts and rates with their 95 % intervals from [(kind, answer)]."""
    rows = []
    for kind in COUNTS:
        scores = [scored(k, a) for k, a in results if k == kind]
        rows.append(f"{kind}: " + ", ".join(f"{scores.count(s)} {s}" for s in ("right", "undecided", "wrong")))
    named = {two_way: [a["verdict"] == "flexible" for k, a in results if (k == TWO_WAY) == two_way]
             for two_way in (True, False)}
    words = {True: "flexible disc named where it is", False: "flexible disc named in controls"}
    return rows + [line(words[key], rate(hits)) for key, hits in named.items() if hits]


def solve(folder, plan):
    """(kind, answer) of one Plan in its folder; prints its line."""
    case = folder / f"{plan.seed}"
    if not (case / "truth.json").exists():
        write(plan, case)
    answer = answered(case, partial(solved, case / "public"))
    print(f"{plan.seed} {plan.kind:<8} -> {answer['verdict']:<10} ln B {answer.get('flexible', 0):+.1f} +-"
          f" {answer.get('error', 0):.1f}   {answer['cpu_seconds']:.0f} s", flush=True)
    return plan.kind, answer


def main():
    """Solve what is chosen, print the table."""
    parser = argparse.ArgumentParser(prog="make study_lines", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_lines")
    parser.add_argument("--only", nargs="*", help="kinds of bench; default all")
    parser.add_argument("--first", type=int, default=1000, help="seed of the first bench")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes; default all processors")
    chosen = parser.parse_args()
    wanted = [p for p in plans(chosen.first) if not chosen.only or p.kind in chosen.only]
    print("\n".join(table(shared_out(partial(solve, chosen.folder), wanted, chosen.workers))))


if __name__ == "__main__":
    main()
