"""Files of a pulled block, and its truth: see ``switching_files``."""

import numpy as np

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.switching.pulled_block import FORMS, LEVELS, NAMES, made
from pipeline.blind_trial.generators.switching.recalibration import GAIN_SPREAD, SPREAD

#: steps of the workshop's model in a period, at least
_STEPS = 100


def hides():
    """{class: ((form,), ...)} of what a pulled block can hide."""
    known, foreign = (tuple((form,) for form, so in FORMS.items() if so == wanted) for wanted in (True, False))
    return {"control": ((),), "effect": known, "foreign": foreign}


def write(draw, folder):
    """Write the case of a Draw into a folder; its truth, as ``generators.systems`` specifies it."""
    form, = draw.hidden or ("",)
    case = made(draw.seed, draw.kind, form, draw.noise)
    case_files.leave(folder, nominal(case), {f"take_{k + 1}": {
        "conditions": {"level": (LEVELS[k], "1")},
        "channels": {"load_cell": (rows[0], "N", "force", case.rate, "response"),
                     "laser": (rows[1], "mm/s", "velocity", case.rate, "response")}}
        for k, rows in enumerate(case.shown)})
    return {**truth(case), "system": draw.system}


def truth(case):
    """What is opened only for the score: see ``pipeline.blind_trial.generators.systems``."""
    names = dict(zip(NAMES, ("masses.block", "joints.machine.stiffness", "joints.machine.damping"), strict=False))
    values = {name: getattr(case.truth, key) for key, name in names.items()}
    effects = [{"name": case.form, "place": "contact", "parameters": {}, "alike": []}] if case.form else []
    return {"class": case.kind, "effects": effects, "noise": case.level, "size": case.change, "left": case.left,
            "parameters": {**values, "friction": case.truth.friction / case.belief.friction}, "seed": case.seed,
            "colour": case.colour, "wrong": "", "way": "machine", "form": case.form, "gaps": case.gap,
            "amount": case.size, "bodies": 1, "a_period": case.rate / case.truth.frequency}


def nominal(case):
    """The case file of the workshop: a block on a machine's spring, Coulomb friction, the speeds that were set."""
    block, step = case.belief, 1 / (case.rate * np.ceil(_STEPS * case.truth.frequency / case.rate))
    corner, delay = np.sqrt(3) / (2 * np.pi * case.tau), (1 - 1 / np.sqrt(3)) * case.tau
    lag = {"corner": f"{corner:.6g} Hz", "delay": f"{delay:.6g} s"}
    courses = {f"take_{k + 1}": {"at": [f"{1e3 * t:.9g} ms" for t in course.at],
                                 "speed": [f"{1e3 * v:.9g} mm/s" for v in course.speed]}
               for k, course in enumerate(case.courses)}
    free = ("masses.block", "joints.machine.stiffness", "joints.machine.damping", "friction")
    return {
        "chain": "lumped_bench", "title": "Block", "description": "A block pulled over a track by a machine.",
        "lumped": {"masses": {"block": {"mass": f"{1e3 * block.mass:.6g} g", "moves": ["x"]}},
                   "springs": {"machine": {"between": ["block.x", "ground"], "damping": f"{block.damping:.6g} N s/m",
                                           "stiffness": f"{block.stiffness / 1e3:.6g} N/mm"}},
                   "contacts": {"track": {"tangent": {"block.x": 1}, "normal_force": f"{block.load:.6g} N"}},
                   "inputs": {"machine": {"displaces": "machine", "displacement": "1 m"}},
                   "sensors": {"block": {"along": {"block.x": 1}, "quantity": "velocity", "unit": "m/s"}}},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": f"{step:.9g} s", "speed": "0 rad/s", "friction": round(float(block.friction), 6),
                  "courses": {"machine": courses},
                  "channels": {"load_cell": {"quantity": "joint_force", "source": "machine", **lag},
                               "laser": {"quantity": "velocity", "source": "block", **lag}}},
        "diagnosis": {"parameters": {name: {"spread": SPREAD} for name in free}
                      | {f"channels.{c}.gain": {"spread": GAIN_SPREAD} for c in ("load_cell", "laser")},
                      "held_out": [f"take_{len(LEVELS)}"],
                      "noise": {"std": {"load_cell": f"{case.noise[0]:.6g} N",
                                        "laser": f"{1e3 * case.noise[1]:.6g} mm/s"}}}}
