"""'make study_second_family SEED=1': rigs that truly switch, coarse samples, unknown starts, diagnosed and scored.

A set has 30 effects, 15 controls, 10 laws that no catalogue holds, 5 faulty sensors, and then 20 pairs of laws, half
of them at one spring. It is drawn from SEED alone; seeds from 103 on are for measures and are not solved before. One
folder a case; what is there is not made or solved again.
"""

import argparse
import json
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

import numpy as np

from pipeline.blind_trial.generators.switching import hidden, switching_files
from pipeline.blind_trial.generators.systems import SYSTEMS, Draw
from pipeline.blind_trial.metrics.criteria import EMPTY, NAMING, VISIBLE, judged
from pipeline.blind_trial.metrics.failure_reasons import why
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.contract.errors import BrakechainError
from tests.studies.forced import ROOT, answered, shared_out, solved

#: cases of each class; controls with one value far off count among the controls
COUNTS = {"effect": 30, "control": 10, "wrong_value": 5, "foreign": 10, "sensor": 5}
NOISES = (0.01, 0.05)
#: pairs of laws, which follow the others; every other one at one spring
PAIRS, _WHERE = 20, (switching_files.BESIDE, switching_files.APART)
#: cases of a set from whose number on blocks are pulled instead of rigs, in the classes that a pulled block can make
_PULLED = 49
_TRIES = 12


def plans(seed):
    """[Draw] of the set of a seed: each form in turn in random order, both levels of noise, all in random order."""
    random = np.random.default_rng([seed, 60])
    draws, forms, pulled = [], SYSTEMS["switching_rig"].hides, SYSTEMS["pulled_block"].hides
    for kind, count in COUNTS.items():
        order = [forms[kind][k] for _ in range(count) for k in random.permutation(len(forms[kind]))][:count]
        draws += [(kind, form, NOISES[int(random.integers(len(NOISES)))]) for form in order]
    plan = []
    for number, k in enumerate(random.permutation(len(draws)), 1):
        kind, form, noise = draws[k]
        system = "pulled_block" if number >= _PULLED and kind in pulled else "switching_rig"
        if system == "pulled_block":
            form = pulled[kind][int(random.integers(len(pulled[kind])))]
        plan.append(Draw(1000 * seed + number, system, kind, form, 0.0, noise))
    return plan + _pairs(seed, len(plan))


def _pairs(seed, before):
    """[Draw] of the pairs, numbered on from those ``before``."""
    random, listed = np.random.default_rng([seed, 61]), hidden.pairs()
    order = random.permutation(len(listed))[:PAIRS]
    return [Draw(1000 * seed + before + k + 1, "switching_rig", "pair", (*listed[chosen], _WHERE[k % 2]), 0.0,
                 NOISES[int(random.integers(len(NOISES)))]) for k, chosen in enumerate(order)]


def case(draw, folder):
    """Truth of a Draw whose files are in ``folder``."""
    kept = folder / "truth.json"
    if not kept.exists():
        kept.write_text(json.dumps(_made(draw, folder), indent=1) + "\n")
    return json.loads(kept.read_text())


def _made(draw, folder):
    """The same where its files are new, of a seed further on where none can be made of its own."""
    for attempt in range(_TRIES):
        again = replace(draw, seed=int(np.random.SeedSequence([draw.seed, attempt]).generate_state(1)[0]))
        try:
            truth = SYSTEMS[again.system].write(again, folder)
        except BrakechainError as error:
            message = error
        else:
            return {**truth, "visible": VISIBLE, "motion": "forced", "draw": asdict(again)}
    raise message


def solve(folder, kept, only_made, draw):
    """(truth, answer) of one Draw in its folder; prints its line. None where it cannot be made, or is only made."""
    own = folder / f"{draw.seed}"
    try:
        truth = case(draw, own)
    except BrakechainError as error:
        print(f"{draw.seed} {draw.kind} {draw.hidden}: not made: {error}", flush=True)
        return None
    if only_made:
        print(described(draw, truth), flush=True)
        return None
    answer = answered(own, partial(solved, own, kept=kept))
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    right = "right" if judged(truth, answer)["right"] else "wrong"
    print(f"{described(draw, truth)}  -> {right} {answer['verdict']:<10} {named}   {answer['cpu_seconds']:.0f} s",
          flush=True)
    return truth, answer


def described(draw, truth):
    """One line of a truth."""
    form = "" if truth["class"] == "pair" else truth["form"]
    hides = ", ".join(f"{form or e['name']} at {e['place']}" for e in truth["effects"])
    return (f"{draw.seed} {truth['class']:<11} {hides:<32} {truth['noise']:>4.0%} {truth['way']:<9}"
            f" {truth['bodies']} bodies, {truth['a_period']:.0f} a period, leaves {truth['left']:.0f}")


def table(results):
    """Lines of rates with their Wilson intervals from [(truth, answer)]."""
    scores = [(t, a, judged(t, a)) for t, a in results]

    def of(what, *kinds):
        return [s[what] for t, _, s in scores if t["class"] in kinds]

    rows = [("effects: type and place", of("right", "effect")), ("effects: type", of("type", "effect")),
            ("effects: among the first three", of("top", "effect")),
            ("controls: false alarms", of("false_alarm", *EMPTY)), ("controls: told right", of("right", *EMPTY)),
            ("foreign: not misnamed", [a["verdict"] not in NAMING for t, a, _ in scores if t["class"] == "foreign"]),
            ("foreign: unknown", of("right", "foreign")), ("sensors: channel and type", of("right", "sensor")),
            ("sensors: called so", of("called", "sensor")),
            *_pair_rows(scores), ("refused", [a["verdict"] == "refused" for _, a, _ in scores])]
    rows += [(f"effects at {level:.0%} noise", [s["right"] for t, _, s in scores
                                               if t["class"] == "effect" and t["noise"] == level]) for level in NOISES]
    return [line(name, rate(hits)) for name, hits in rows if hits]


def _pair_rows(scores):
    """[(what, [bool])] of the pairs among [(truth, answer, judgement)]."""
    pairs = [(s["right"], len({e["place"] for e in t["effects"]}), a) for t, a, s in scores if t["class"] == "pair"]
    return [("pairs at one spring", [right for right, places, _ in pairs if places == 1]),
            ("pairs at two springs", [right for right, places, _ in pairs if places == 2]),
            ("pairs: one named alone", [a["verdict"] == "missing" and len(a["effects"]) == 1 for *_, a in pairs])]


def main():
    """Make and solve what is chosen, print the table and why answers are not right."""
    parser = argparse.ArgumentParser(prog="make study_second_family", description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_second_family")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of the cases, from 1; pairs from 61; default all")
    parser.add_argument("--kept", type=int, default=8, help="candidates that are refitted")
    parser.add_argument("--make", action="store_true", help="make the cases, and do not solve them")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    chosen = parser.parse_args()
    folder = chosen.folder / f"seed_{chosen.seed}"
    every = plans(chosen.seed)
    wanted = [every[k - 1] for k in chosen.only] if chosen.only else every
    results = shared_out(partial(solve, folder, chosen.kept, chosen.make), wanted, chosen.workers)
    kept = [r for r in results if r]
    if kept:
        reasons = {f"{t['draw']['seed']}": why(t, a, judged(t, a)) for t, a in kept if not judged(t, a)["right"]}
        (folder / "rates.json").write_text(json.dumps({"rates": table(kept), "why": reasons}, indent=1) + "\n")
        print("\n".join(table(kept)))


if __name__ == "__main__":
    main()
