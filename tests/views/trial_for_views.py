"""A result of a trial that was never held: drawn truths and drawn answers, for the page alone."""

import random

from pipeline.blind_trial.metrics.result import result

EFFECTS, PLACES = ("coulomb", "cubic_stiffness", "joint_damping", "falling_friction"), ("link_0", "link_1", "contact")
SHARES = (("control", 40), ("effect", 40), ("foreign", 16), ("pair", 6), ("sensor", 6), ("solver", 2), ("below", 6),
          ("wrong_value", 4))
RIGHT = {"control": "parameters", "wrong_value": "parameters", "foreign": "unknown", "sensor": "sensor",
         "solver": "numerics", "below": "parameters"}
ABOUT = {"name": "never_held", "kind": "sealed", "cases": 120, "commitment": "0" * 64, "commit": "f" * 40,
         "version": "0.1.0", "catalogue": list(EFFECTS)}


def drawn(seed=1, about=ABOUT):
    """Result of 120 drawn cases with two baselines."""
    chance = random.Random(seed)
    truth = {f"{k:03d}": _truth(kind, chance) for k, kind in enumerate(
        [kind for kind, count in SHARES for _ in range(count)], 1)}
    answers = {method: {number: _answer(one, chance, skill) for number, one in truth.items()}
               for method, skill in (("diagnosis", 0.88), ("largest_residual", 0.3), ("best_held_out", 0.5))}
    return result(about, truth, answers)


def _truth(kind, chance):
    count = {"control": 0, "wrong_value": 0, "solver": 0, "pair": 2}.get(kind, 1)
    names = chance.sample(("magnet", "film_drag") if kind == "foreign" else EFFECTS, count)
    motion = chance.choice(("forced", "forced", "self_excited"))
    return {"class": kind, "effects": [{"name": n, "place": chance.choice(PLACES)} for n in names],
            "system": f"{motion}_rig", "motion": motion, "noise": chance.choice((0.01, 0.1)),
            "size": chance.uniform(0.03, 0.6) if count else 0.0, "left": chance.lognormvariate(3, 1),
            "parameters": {"masses.a": 2.0}}


def _answer(truth, chance, skill):
    well = chance.random() < skill
    verdict = RIGHT.get(truth["class"], "missing") if well else chance.choice(("missing", "unknown", "tie", "refused"))
    wrong = [{"name": chance.choice(EFFECTS), "place": chance.choice(PLACES)} for _ in range(1 + (verdict == "tie"))]
    named = truth["effects"] if well else wrong
    posterior = chance.uniform(0.9, 1.0) if verdict != "tie" else 0.5
    effects = [{**e, "posterior": posterior} for e in named] if verdict in ("missing", "sensor", "tie") else []
    fit = {"before": 0.6, "recalibrated": 0.3, "after": chance.uniform(0.009, 0.012 if well else 0.2),
           "noise_floor": 0.01, "runs": ["run_3"]}
    return {"verdict": verdict, "effects": effects, "fit": {"training": fit, "held_out": fit},
            "alternatives": [{**e, "posterior": 0.02} for e in wrong],
            "reasons": ["coulomb at link_0: its gain on held-out runs is 1.9 standard errors", "no candidate survives"],
            "parameters": {"masses.a": {"nominal": 1.5, "value": chance.gauss(2.0, 0.1), "std": 0.08, "unit": "kg"}},
            "cpu_seconds": chance.lognormvariate(3, 0.6)}
