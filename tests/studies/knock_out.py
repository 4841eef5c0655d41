"""'make study_knock_out': every effect that a forced rig can hide, hidden while the catalogue lacks it.

What the catalogue does not hold must not be taken for something that it does. Each case is one of a known effect,
solved without that effect and without the laws that contain it (CONTAINING). Scored are the answers that name no
physics in its place; cases that leave less than can be seen count apart. Answers are added to
data/studies/knock_out.csv; a case that stands there is not solved again.
"""

import argparse
import os
from functools import partial
from pathlib import Path

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.rig_case import kind_of
from pipeline.blind_trial.metrics.criteria import NAMING, VISIBLE
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.contract.errors import BrakechainError
from pipeline.effects import CATALOGUE
from tests.studies.forced import COLOURS, LEVELS, ROOT, Plan, run, shared_out
from tests.studies.ledger import FOLDER, Ledger, answer_of

#: laws of joint friction that are dry friction as a limit of theirs
_DRY = ("dahl", "lugre", "stribeck_joint", "position_friction", "jenkins", "series_stiffness", "logarithmic_friction",
        "rate_state_ageing", "rate_state_slip", "bouc_wen")
#: laws of joint friction that are a spring as long as they do not slip
_SPRINGS = ("jenkins", "dahl", "lugre", "bouc_wen", "series_stiffness", "hysteretic_joint")
#: laws that are a spring as long as they do not relax
_RELAXING = ("viscoelastic_pad", "shim_damping", "hydraulic_compliance")
#: laws of the catalogue that have an effect as a limit of theirs, beside those whose ``extends`` says so, or make the
#: same force on a rig of one shaker. A mass m on a spring k' behind a joint k pulls with k - (k^2 / m) /
#: ((k + k') / m - w^2), a hidden mass m' on a spring k" at the point with k" - (k"^2 / m') / (k" / m' - w^2): the same
#: at another stiffness of the joint
CONTAINING = {
    "coulomb": ("asymmetric_friction", "hysteretic_joint", *_DRY),
    "asymmetric_friction": ("coulomb",),
    "joint_damping": ("viscous", "viscoelastic_pad", "shim_damping", "stribeck_joint", "lugre"),
    "viscoelastic_pad": ("shim_damping", "hydraulic_compliance"),
    "shim_damping": ("viscoelastic_pad", "hydraulic_compliance"),
    "hydraulic_compliance": ("viscoelastic_pad", "shim_damping"),
    "hysteretic_joint": ("micro_slip", "jenkins", "series_stiffness", "dahl", "lugre", "bouc_wen"),
    "backlash": ("clearance",), "moving_base": ("base_shake", "second_mode", "tuned_absorber"),
    "base_shake": ("pressure_ripple",), "pressure_ripple": ("base_shake",),
    "compliant_arm": ("series_stiffness", "second_mode"),
    "attached_mass": ("tuned_absorber", "second_mode"), "added_stiffness": ("tuned_absorber", *_SPRINGS, *_RELAXING),
    "sensor_gain": ("unit_factor",),
}
#: draws of every effect at every noise
DRAWS = 5


def plans(draws=DRAWS, first=500_000):
    """``draws`` cases of every known effect at both levels of noise; a run that is stopped has some of every one."""
    names = [name for name in HIDDEN if kind_of((name,)) == "effect"]
    wanted = [(name, draw, level) for draw in range(draws) for level in LEVELS for name in names]
    return [Plan(first + k, name, draw % 2 if HIDDEN[name].place != "shaker" else 0, level,
                 3 if HIDDEN[name].place == "wall link" else 2, COLOURS[k % len(COLOURS)])
            for k, (name, draw, level) in enumerate(wanted)]


def removed(name):
    """Effects of the catalogue without which a case of effect ``name`` is solved."""
    containing = {*CONTAINING.get(name, ()), *(effect.name for effect in CATALOGUE if name in effect.extends)}
    return tuple(effect.name for effect in CATALOGUE if effect.name == name or effect.name in containing)


def misnamed(answer):
    """Whether an answer names physics, a sensor or the solver in the place of what the catalogue lacks."""
    return answer["verdict"] in NAMING


def table(results):
    """Lines of rates from [(truth, answer)]."""
    far = [(t, a) for t, a in results if t["left"] >= VISIBLE]
    rows = [("not taken for a known law", [not misnamed(a) for _, a in far]),
            ("told unknown", [a["verdict"] == "unknown" for _, a in far])]
    rows += [(f"not taken for a known law, {level:.0%} noise", [not misnamed(a) for t, a in far if t["noise"] == level])
             for level in LEVELS]
    rows.append(("below the threshold", [not misnamed(a) for t, a in results if t["left"] < VISIBLE]))
    return [line(name, rate(hits)) for name, hits in rows if hits]


def solve(folder, kept, ledger, plan):
    """Solve one Plan without its effect and add its answer to a Ledger, unless its case cannot be made; prints its
    line."""
    try:
        truth, answer = run(plan, folder / f"{plan.seed}", kept=kept, without=removed(plan.hidden))
    except BrakechainError as error:
        print(f"{plan.seed} {plan.hidden}: not made: {error}", flush=True)
        return
    ledger.add(f"{plan.seed}", plan.hidden, truth["noise"], truth["left"], answer)
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    print(f"{plan.seed} {plan.hidden:<22} {truth['noise']:>4.0%} leaves {truth['left']:6.1f}  ->"
          f" {answer['verdict']:<10} {named}   {answer['cpu_seconds']:.0f} s", flush=True)


def results_of(rows):
    """[(truth, answer)] of the rows of a Ledger."""
    return [({"noise": float(row["noise"]), "left": float(row["left"])}, answer_of(row)) for row in rows]


def main():
    """Solve what is chosen, print the table of all that is solved."""
    parser = argparse.ArgumentParser(prog="make study_knock_out", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_knock_out")
    parser.add_argument("--ledger", type=Path, default=FOLDER / "knock_out.csv")
    parser.add_argument("--every", type=int, default=1, help="one case in so many")
    parser.add_argument("--kept", type=int, default=4, help="candidates that are refitted")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes; default all processors")
    chosen = parser.parse_args()
    ledger = Ledger(chosen.ledger)
    there = ledger.rows()
    left = [plan for plan in plans()[::chosen.every] if f"{plan.seed}" not in there]
    shared_out(partial(solve, chosen.folder, chosen.kept, ledger), left, chosen.workers)
    ledger.tidy()
    print("\n".join(table(results_of(ledger.rows().values()))))


if __name__ == "__main__":
    main()
