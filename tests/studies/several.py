"""'make study_several': joints with one to three laws at once, integrated by SciPy, diagnosed and scored.

A mass on a spring and a damper, 200 samples a period, noise of 1 %. The laws of the truth are not those of the
catalogue: exponents, and the speed that friction follows, are 2 to 5 % off. Prints one line a case, then the rates.
"""

import argparse
import time
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Run as RigRun
from pipeline.products import Channel, Condition, Recording
from pipeline.products import Run as RunProduct
from tests.diagnosis.small_rig import laid_out, model

MASS, STIFFNESS, DAMPING = 1.0, 415.0, 1.0          # the nominal rig: 1 kg, 400 N/m, 1.2 N s/m
RATE, DURATION, LEVELS, NOISE = 640.0, 5.0, (2.0, 4.0, 7.0, 5.5), 0.01
#: a displacement and a speed at which laws have the sizes that are drawn
SIZE, SPEED = 0.1, 2.0
LAWS = ("quadratic_stiffness", "cubic_stiffness", "coulomb")
#: few rivals, for a fast answer
RIVALS = (*LAWS, "quadratic_damping", "hysteretic_joint", "clearance", "joint_damping", "sensor_gain")
#: corner of the low pass of displacements, samples left out at the ends, and every so many kept
EQUATION = {"corner": "15 Hz", "trim": 64, "decimation": 4}


@dataclass(frozen=True)
class Truth:
    """``force`` {law: N at SIZE} and its relative ``error`` {law: 2 to 5 %, either sign} of shape."""

    force: dict
    error: dict


def truth(laws, seed):
    """Truth of these ``laws``, each as large as 15 to 35 % of the spring's force."""
    random = np.random.default_rng(seed)
    force = {law: random.uniform(0.15, 0.35) * STIFFNESS * SIZE * (0.06 if law == "coulomb" else 1.0) for law in laws}
    return Truth(force, {law: random.uniform(0.02, 0.05) * random.choice((-1, 1)) for law in laws})


def joint_force(x, v, given):
    """Force (N) of the laws of a Truth; friction is smooth below a thousandth of the speed alone."""
    force, error, u = given.force, given.error, abs(x) / SIZE
    total = force.get("quadratic_stiffness", 0.0) * u ** (2 * (1 + error.get("quadratic_stiffness", 0.0)))
    total += force.get("cubic_stiffness", 0.0) * np.sign(x) * u ** (3 * (1 + error.get("cubic_stiffness", 0.0)))
    slope = 1 + error.get("coulomb", 0.0) * abs(v) / SPEED
    return total + force.get("coulomb", 0.0) * np.tanh(v / (1e-3 * SPEED)) * slope


def motion(given, level, seed):
    """(displacement, force of the shaker) (n,) of one run."""
    at, phase = np.arange(round(DURATION * RATE) + 1) / RATE, np.random.default_rng(seed).uniform(0, 2 * np.pi, 3)
    tones = sum(np.sin(2 * np.pi * f * at + p) for f, p in zip((1.1, 2.9, 3.7), phase, strict=True))
    shaken = level * (tones + np.sin(2 * np.pi * (1 + 0.4 * at) * at)) / 2

    def slope(t, state):
        x, v = state
        return v, (np.interp(t, at, shaken) - STIFFNESS * x - DAMPING * v - joint_force(x, v, given)) / MASS

    whole = solve_ivp(slope, (0, at[-1]), (0.0, 0.0), "LSODA", at, rtol=1e-7, atol=1e-10, max_step=2 / RATE)
    return whole.y[0], shaken


def recording(given, seed):
    """(Product Recording, standard deviation of the displacement's noise) of a Truth at all levels."""
    random = np.random.default_rng(seed)
    motions = [motion(given, level, k) for k, level in enumerate(LEVELS)]
    std, runs = NOISE * float(np.mean([x.std() for x, _ in motions])), {}
    for k, (x, shaken) in enumerate(motions):
        shown = {"x": (x + std * random.standard_normal(len(x)), "m"), "force": (shaken, "N")}
        runs[f"level_{k + 1}"] = RunProduct(
            description="", repeat_of="", conditions={"level": Condition(value=[LEVELS[k]], time=[0.0], unit="N")},
            channels={name: Channel(samples=s, missing=np.empty((0, 2), int), unit=unit, measures="", rate=RATE,
                                    begin=0.0, place="", position=[], direction=[], role="")
                      for name, (s, unit) in shown.items()})
    return Recording(source=["made for a study"], runs=runs), std


def problem(given, seed, equation=False, weighed=RIVALS):
    """DiagnosisProblem of a Truth, by simulation or by the equation of motion; the last level is held out."""
    recordings, std = recording(given, seed)
    section = laid_out(forward="equation", equation=EQUATION) if equation else laid_out()
    bench = benches.built(model(), section)
    noise = {"force on block": f"{_noise_of_balance(bench, std)!r} N"} if equation else {"x": f"{std!r} m"}
    asked = fill(Settings, {
        "parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.3}},
        "held_out": [f"level_{len(LEVELS)}"], "noise": {"std": noise}, "effects": list(weighed)}, "diagnosis")
    runs = recorded(recordings, section)
    return (force_balance_problem(bench, runs, asked, section.equation) if equation
            else forced_problem(bench, runs, asked))


def _noise_of_balance(bench, std):
    """Standard deviation (N) of a balance of noise of ``std`` (m) alone."""
    noise = std * np.random.default_rng(0).standard_normal(round(DURATION * RATE) + 1)
    run = RigRun("noise", DURATION, RATE, {"shaker": np.zeros(len(noise))})
    return float(equation_residual(bench, run, {"x": noise}, 15.0, decimation=4, trim=64).std())


def answer(diagnosis):
    """(verdict, names of the effects that are said to be there) of a Diagnosis."""
    known = {effect for effect, _ in diagnosis.nominal.effects}
    named = {c.name.split(" at ")[0] for c in diagnosis.decision.named}
    return diagnosis.decision.verdict, tuple(sorted(known | named))


def plans(draws):
    """[(laws, seed)]: ``draws`` of all three, of each pair and of each alone."""
    pairs = [tuple(law for law in LAWS if law != left) for left in LAWS]
    return [(laws, seed) for laws in (LAWS, *((law,) for law in LAWS), *pairs) for seed in range(draws)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=12)
    parser.add_argument("--equation", action="store_true", help="by the equation of motion instead of simulation")
    parser.add_argument("--whole", action="store_true", help="the whole catalogue instead of a few rivals")
    parser.add_argument("--laws", type=int, default=0, help="cases of so many laws alone")
    asked, right = parser.parse_args(), {}
    for laws, seed in plans(asked.draws):
        if asked.laws and len(laws) != asked.laws:
            continue
        given = problem(truth(laws, seed), seed, asked.equation, () if asked.whole else RIVALS)
        begin = time.process_time()
        solved = given.solved()
        verdict, names = answer(solved)
        right.setdefault(laws, []).append((verdict, names) == ("missing", tuple(sorted(laws))))
        taken = time.process_time() - begin
        print(f"{' + '.join(laws)}, draw {seed}: {verdict} {' + '.join(names)}, {taken:.1f} CPU s", flush=True)
        if not right[laws][-1]:
            print(*(f"    {c}" for c in solved.combinations if c.outcome), sep="\n", flush=True)
    for laws, hits in right.items():
        print(f"{' + '.join(laws)}: {sum(hits)} of {len(hits)} named, all and nothing else")


if __name__ == "__main__":
    main()
