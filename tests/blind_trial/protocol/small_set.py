"""A small set made by hand, and a method that answers it without looking."""

import json

from pipeline.blind_trial.protocol import solver_process, solving
from pipeline.contract.executors import InProcess

COULOMB = {"name": "coulomb", "place": "link_0", "parameters": {}}
TRUTH = {
    "001": {"class": "control", "effects": [], "system": "rig", "size": 0.0, "noise": 0.01, "motion": "forced",
            "parameters": {"masses.a": 2.0}},
    "002": {"class": "effect", "effects": [COULOMB], "system": "rig", "size": 0.3, "noise": 0.01, "motion": "forced"},
    "003": {"class": "foreign", "effects": [{"name": "magnet", "place": "link_1"}], "system": "belt", "size": 0.3,
            "noise": 0.1, "motion": "self_excited"},
}
_FIT = {part: {"before": 0.5, "recalibrated": 0.2, "after": 0.011, "noise_floor": 0.01, "runs": ["a"]}
        for part in ("training", "held_out")}
TOLD = {
    "001": {"verdict": "parameters", "effects": [], "reasons": ["values are off"], "fit": _FIT,
            "parameters": {"masses.a": {"nominal": 1.5, "value": 2.1, "std": 0.08, "unit": "kg"}}},
    "002": {"verdict": "missing", "effects": [{**COULOMB, "posterior": 0.97}], "reasons": ["found"], "fit": _FIT,
            "alternatives": [{"name": "viscous", "place": "link_0", "posterior": 0.03}]},
    "003": {"verdict": "missing", "effects": [{**COULOMB, "posterior": 0.91}], "reasons": ["also found"], "fit": _FIT},
}


def small_set(folder, truth=TRUTH):
    """A set without set.yaml: files of no meaning, and the truth in clear; returns its folder."""
    for number in truth:
        case = folder / "cases" / number
        case.mkdir(parents=True)
        (case / "nominal.yaml").write_text(f"# {number}\n")
        (case / "recordings.h5").write_bytes(number.encode())
    (folder / "truth.json").write_text(json.dumps(truth))
    return folder


def solved(folder, monkeypatch, told=TOLD, **asked):
    """Solve a set in this process with the answers ``told``; returns how many were asked for."""
    monkeypatch.setattr(solving, "answered", lambda case, method, limit: {**told[case.name], "cpu_seconds": 1.0})
    return solving.solve(folder, InProcess(), **asked)


def refusing(case, method, limit):
    """A method that refuses every case."""
    return {**solver_process.refused(f"{method} refuses"), "cpu_seconds": 0.5}
