"""'make study_sharp': friction that really sticks, play and stops, recorded from event to event, diagnosed and scored.

Two masses in a row on springs, shaken at one end at four levels, about 50 samples in a period. What is hidden is
integrated by SciPy with events (``tests.physics.time_stepping.event_driven``), no time step and no law of ours takes
part. Nominal values are some percent off, noise is 1 or 5 % of each channel. One file a case; a case that has its
answer is not solved again. Prints one line a case, then the table of rates.
"""

import argparse
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.products import Channel, Recording
from pipeline.products import Run as RunProduct
from tests.physics.time_stepping.event_driven import Masses
from tests.studies.forced import ROOT, by_stages, kept_answer, shared_out

JOINTS, ROWS = ("mount", "coupling"), np.array([[1.0, 0.0], [-1.0, 1.0]])
MASS, STIFFNESS, DAMPING = np.array([1.0, 0.6]), np.array([900.0, 500.0]), np.array([2.0, 1.0])
RATE, DURATION, LEVELS, NOISES, DRAWS = 200.0, 5.0, (1.0, 2.0, 3.0, 1.6), (0.01, 0.05), 12
#: the stop in front of the left mass: N/m, and its nominal gap over the root mean square of the linear motion there
STOP, THOUGHT = 3e4, 2.0
KINDS = ("coulomb", "backlash", "stop", "coulomb + cubic", "nothing")


@dataclass(frozen=True)
class Plan:
    """What to make: the hidden ``kind``, its ``draw`` and the ``noise`` as a share of each channel."""

    kind: str
    draw: int
    noise: float

    @property
    def name(self):
        """Name of the case."""
        return f"{self.kind.replace(' ', '')}_{self.draw}_{self.noise:g}"


@dataclass(frozen=True)
class Truth:
    """``effects`` ((name, place), ...) that a Recording hides, its ``noise`` {channel: m}, the nominal ``gap`` m of a
    stop."""

    effects: tuple
    noise: dict
    recording: Recording
    gap: float = 0.0


def plans(kinds=KINDS):
    """Every kind x draws x levels of noise."""
    return [Plan(kind, draw, noise) for kind in kinds for draw in range(DRAWS) for noise in NOISES]


def shaking(random):
    """Force (N) over time (s): seven tones of 1 to 9 Hz that swell and fade."""
    frequency, phase = random.uniform(1, 9, 7), random.uniform(0, 2 * np.pi, 7)

    def force(t):
        return np.sin(np.pi * t / DURATION) ** 2 * np.cos(2 * np.pi * frequency * t + phase).sum()

    return force


def made(plan, levels=LEVELS):
    """Truth of a Plan: recordings of the true rig with what is hidden, at ``levels`` of the force."""
    random = np.random.default_rng([plan.draw, KINDS.index(plan.kind)])
    true = STIFFNESS * random.lognormal(0, 0.05, 2), DAMPING * random.lognormal(0, 0.2, 2)
    force, instants = shaking(random), np.arange(round(DURATION * RATE) + 1) / RATE

    def moved(level, limit=(0.0, 0.0), **laws):
        masses = Masses(MASS, ROWS, *true, np.array(limit), lambda t: np.array([0.0, level * force(t)]), **laws)
        return masses.motion(instants, np.zeros(4))

    elongation = (ROWS @ moved(2.0)).std(axis=1)
    effects, laws = hidden(plan.kind, random, elongation, true[0])
    shown = [moved(level, **laws) for level in levels]
    std, runs = plan.noise * np.array(shown).std(axis=(0, 2)), {}
    for k, (level, x) in enumerate(zip(levels, shown, strict=True)):
        seen = x + std[:, None] * random.standard_normal(x.shape)
        channels = {"left": _channel(seen[0], "m"), "right": _channel(seen[1], "m"),
                    "force": _channel(np.array([level * force(t) for t in instants]), "N")}
        runs[f"run_{k + 1}"] = RunProduct(description="", repeat_of="", channels=channels)
    return Truth(effects, dict(zip(("left", "right"), std, strict=True)), Recording(source=["events"], runs=runs),
                 float(THOUGHT * elongation[0]))


def hidden(kind, random, elongation, stiffness):
    """(effects, laws of Masses) of a kind; sizes by the root mean square ``elongation`` (j,) of the linear rig."""
    joint = int(random.integers(2))
    place, e, k = JOINTS[joint], elongation[joint], stiffness[joint]
    limit = tuple(random.uniform(0.15, 0.5) * k * e if j == joint else 0.0 for j in range(2))
    if kind == "coulomb":
        return (("coulomb", place),), {"limit": limit}
    if kind == "backlash":
        gap = random.uniform(0.15, 0.5) * e
        return (("backlash", place),), {"spring": lambda x: _at(joint, -k * np.clip(x[joint], -gap, gap)),
                                        "kinks": ((joint, -gap), (joint, gap))}
    if kind == "stop":
        gap = random.uniform(0.5, 1.2) * elongation[0]
        return (("clearance", "contact"),), {"spring": lambda x: _at(0, STOP * min(x[0] + gap, 0.0)),
                                             "kinks": ((0, -gap),)}
    if kind == "coulomb + cubic":
        other = int(random.integers(2))
        cubic = random.uniform(0.03, 0.1) * stiffness[other] / elongation[other] ** 2
        return ((("coulomb", place), ("cubic_stiffness", JOINTS[other])),
                {"limit": limit, "spring": lambda x: _at(other, cubic * x[other] ** 3)})
    return (), {}


def _at(joint, force):
    return np.array([force, 0.0]) if joint == 0 else np.array([0.0, force])


def _channel(samples, unit):
    return Channel(samples=samples, missing=np.empty((0, 2), int), unit=unit, measures="", rate=RATE, begin=0.0,
                   place="", position=[], direction=[], role="")


def document(truth, stop=False):
    """{section: settings} of the nominal case of a Truth; with the ``stop``, where it is thought to be."""
    case = {
        "lumped": {
            "masses": {n: {"mass": f"{m} kg", "moves": ["x"]} for n, m in zip(("left", "right"), MASS, strict=True)},
            "springs": {name: {"between": ends, "stiffness": f"{k} N/m", "damping": f"{c} N s/m"}
                        for name, ends, k, c in zip(JOINTS, (["left.x", "ground"], ["right.x", "left.x"]), STIFFNESS,
                                                    DAMPING, strict=True)},
            "inputs": {"shaker": {"along": {"right.x": 1}, "force": "1 N"}},
            "sensors": {n: {"along": {f"{n}.x": 1}, "quantity": "displacement", "unit": "m"}
                        for n in ("left", "right")}},
        "bench": {"step": "5 ms", "inputs": {"shaker": {"channel": "force", "hold": "band_limited"}},
                  "channels": {n: {"quantity": "displacement", "source": n} for n in ("left", "right")}},
        "diagnosis": {"parameters": {f"joints.{n}.{of}": {"spread": spread} for n in JOINTS
                                     for of, spread in (("stiffness", 0.1), ("damping", 0.3))},
                      "held_out": [list(truth.recording.runs)[-1]],
                      "noise": {"std": {n: f"{float(std)!r} m" for n, std in truth.noise.items()}}}}
    if stop:
        case["lumped"]["contacts"] = {"stop": {"tangent": {"right.x": 1}, "normal": {"left.x": 1},
                                               "stiffness": f"{STOP} N/m", "gap": f"{truth.gap!r} m"}}
        case["bench"] |= {"contact": "penalty", "contact_stiffness": f"{STOP} N/m", "friction": 0.0, "step": "2.5 ms"}
    return case


def solved(truth, kept=4, stop=False, **asked):
    """diagnosis.json of a Truth, without what it hides."""
    return by_stages(document(truth, stop), truth.recording, kept=kept, **asked)


def right(plan, truth, answer):
    """Whether the answer names exactly what is hidden, at its place."""
    named = {(e["name"], e["place"]) for e in answer["effects"]}
    verdicts = ("missing",) if truth.effects else ("consistent", "parameters")
    return answer["verdict"] in verdicts and named == set(truth.effects)


def solve(folder, kept, plan):
    """(plan, whether right, CPU seconds) of a Plan; prints its line."""
    answer = kept_answer(folder / f"{plan.name}.json", partial(made, plan),
                         partial(solved, kept=kept, stop=plan.kind == "stop"),
                         lambda truth, answer: {"hidden": truth.effects, "right": right(plan, truth, answer)})
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    known = ", ".join(f"{name} at {place}" for name, place in answer["hidden"])
    print(f"{plan.name:<24} {known:<44} -> {answer['verdict']:<10} {named:<46} {answer['cpu_seconds']:.0f} s",
          flush=True)
    return plan, answer["right"], answer["cpu_seconds"]


def table(results):
    """Lines of rates and CPU seconds from [(Plan, whether right, CPU seconds)]."""
    rows = []
    for kind in KINDS:
        for noise in NOISES:
            of = [(hit, seconds) for plan, hit, seconds in results if (plan.kind, plan.noise) == (kind, noise)]
            if of:
                rows.append(f"{line(f'{kind}, {noise:.0%} noise', rate([hit for hit, _ in of]))}   CPU s:"
                            f" {np.median([s for _, s in of]):.0f} (median), {max(s for _, s in of):.0f} (most)")
    return rows


def main():
    """Solve what is chosen, print the table."""
    parser = argparse.ArgumentParser(prog="make study_sharp", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_sharp")
    parser.add_argument("--only", nargs="*", default=KINDS, choices=KINDS, help="kinds; default all")
    parser.add_argument("--every", type=int, default=1, help="one case in so many")
    parser.add_argument("--kept", type=int, default=4, help="candidates that are refitted")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    chosen = parser.parse_args()
    wanted = plans(chosen.only)[::chosen.every]
    print("\n".join(table(shared_out(partial(solve, chosen.folder, chosen.kept), wanted, chosen.workers))))


if __name__ == "__main__":
    main()
