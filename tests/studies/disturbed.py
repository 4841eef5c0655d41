"""'make study_disturbed': nothing is missing, but noise is not white, clocks differ, samples are lost, joints change.

One to three bodies in a row on linear springs and dampers, 5 Hz to 3 kHz, shaken at the last body at four levels and
sampled 15 to 120 times a period; SciPy integrates them. What is stated of the noise is its root mean square. No answer
may name physics that is not there. Answers are added to data/studies/disturbed.csv; a case that stands there is not
solved again. Prints one line a case, then the table of rates of all that is solved.
"""

import argparse
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.signal import lfilter

from pipeline.blind_trial.metrics.criteria import NAMING, NOTHING
from pipeline.blind_trial.metrics.rates import line, rate
from pipeline.products import Recording
from pipeline.products import Run as RunProduct
from pipeline.recordings.samples import channel
from tests.diagnosis.decays import UNITS
from tests.studies.forced import ROOT, by_stages, kept_answer, shared_out
from tests.studies.ledger import FOLDER, Ledger, answer_of
from tests.studies.sharp import NOISES, Plan

#: disturbance -> effects that state it, so that they are no false alarm: a softening joint softens
DISTURBANCES = {"white": (), "coloured": (), "flicker": (), "hum": (), "swelling": (), "bursts": (), "rounded": (),
                "lost": (), "clock": ("sensor_delay",), "reassembled": (), "warming": ("thermal_softening",),
                "beyond": ()}
DRAWS, LEVELS = 33, (1.0, 2.0, 3.0, 1.6)
#: samples of a run; share of it over which the force rises and falls
_SAMPLES, _RAMP = (900, 2000), 0.1
#: steps of the model in a period of the highest mode, at least
_STEPS = 100
#: by how much joints differ from run to run, a clock runs fast, a joint softens over a run, a level is beyond others
_STIFFNESS, _DAMPING, _FAST, _SOFTER, _BEYOND = 0.002, 0.03, 1e-4, 0.005, 10.0


@dataclass(frozen=True)
class Row:
    """Bodies (n,) kg in a row on ``stiffness`` N/m and ``damping`` N s/m (n,), the first towards the ground."""

    mass: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    rows: np.ndarray = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "rows", np.eye(len(self.mass)) - np.eye(len(self.mass), k=-1))

    @property
    def frequencies(self):
        """Natural frequencies (n,) Hz, rising."""
        squares = eigh(self.rows.T * self.stiffness @ self.rows, np.diag(self.mass), eigvals_only=True)
        return np.sqrt(squares) / (2 * np.pi)

    def motion(self, force, instants, softer=0.0):
        """{quantity: (n, samples)} at ``instants`` s from rest, ``force(t)`` N on the last body; the first joint loses
        the share ``softer`` of its stiffness over the run."""
        end, count = instants[-1], len(self.mass)

        def slope(t, state):
            x, v = state[:count], state[count:]
            stiffness = self.stiffness.copy()
            stiffness[0] *= 1 - softer * t / end
            pulled = -(stiffness * (self.rows @ x) + self.damping * (self.rows @ v)) @ self.rows
            pulled[-1] += force(t)
            return np.concatenate((v, pulled / self.mass))

        found = solve_ivp(slope, (0.0, end), np.zeros(2 * count), "DOP853", instants, rtol=1e-9, atol=1e-15,
                          max_step=0.05 / self.frequencies[-1])
        x, v = np.split(found.y, 2)
        a = np.array([slope(t, state)[count:] for t, state in zip(instants, found.y.T, strict=True)]).T
        return {"displacement": x, "velocity": v, "acceleration": a}


@dataclass(frozen=True)
class Case:
    """A ``recording`` of a Row, its nominal ``document``."""

    recording: Recording
    document: dict


def plans(disturbances=tuple(DISTURBANCES)):
    """Every disturbance x draws, the levels of noise in turn."""
    return [Plan(each, draw, NOISES[draw % len(NOISES)]) for each in disturbances for draw in range(DRAWS)]


def made(plan):
    """Case of a Plan."""
    random = np.random.default_rng([plan.draw, list(DISTURBANCES).index(plan.kind), 71])
    nominal, count = _drawn(random), int(random.integers(*_SAMPLES))
    true = Row(nominal.mass, *(values * random.lognormal(0, spread, len(values))
                               for values, spread in ((nominal.stiffness, 0.07), (nominal.damping, 0.2))))
    sampled = random.uniform(15, 120) * nominal.frequencies[-1]
    instants, quantity = np.arange(count) / sampled, list(UNITS)[int(random.integers(len(UNITS)))]
    seen, forces = [], []
    for k, level in enumerate(LEVELS):
        beyond = plan.kind == "beyond" and k == len(LEVELS) - 1
        force = shaking(random, instants[-1], nominal.frequencies, (0.9, 2.5) if beyond else (0.2, 1.5))
        strength = level * (_BEYOND if beyond else 1.0)
        forces.append(strength * np.array([force(t) for t in instants]))
        softer = _SOFTER if plan.kind == "warming" else 0.0
        late = instants * (1 + _FAST * (plan.kind == "clock"))
        row = _reassembled(true, random) if plan.kind == "reassembled" else true
        seen.append(strength * row.motion(force, late, softer)[quantity])
    std = plan.noise * np.array(seen[:3]).std(axis=(0, 2))
    shown = [disturbed(plan.kind, x, std, random) for x in seen]
    recording = Recording(source=["SciPy"], runs={f"run_{k + 1}": _run(x, force, quantity, sampled)
                                                  for k, (x, force) in enumerate(zip(shown, forces, strict=True))})
    halvings = int(np.ceil(np.log2(max(_STEPS * nominal.frequencies[-1] / sampled, 1.0))))
    return Case(recording, document(nominal, quantity, std, 1 / (sampled * 2**halvings)))


def _drawn(random):
    """Nominal Row: its lowest frequency 5 Hz to 3 kHz, damping ratios about a percent."""
    count = int(random.integers(1, 4))
    mass = np.exp(random.uniform(np.log(0.05), np.log(20.0))) * random.uniform(0.4, 1.0, count)
    stiffness = random.uniform(0.5, 1.0, count)
    raw = Row(mass, stiffness, np.ones(count))
    scale = (np.exp(random.uniform(np.log(5.0), np.log(3e3))) / raw.frequencies[0])**2
    omega = 2 * np.pi * np.sqrt(scale) * raw.frequencies[0]
    return Row(mass, scale * stiffness, 2 * random.uniform(0.005, 0.02, count) * scale * stiffness / omega)


def _reassembled(row, random):
    return Row(row.mass, row.stiffness * random.lognormal(0, _STIFFNESS, len(row.mass)),
               row.damping * random.lognormal(0, _DAMPING, len(row.mass)))


def shaking(random, end, frequencies, band):
    """Force (N) over time (s): tones of ``band`` times the lowest and the highest of ``frequencies`` that rise and
    fall."""
    count = 4 * len(frequencies) + 2
    tone = random.uniform(band[0] * frequencies[0], band[1] * frequencies[-1], count)
    phase = random.uniform(0, 2 * np.pi, count)

    def force(t):
        rise = min(t, max(end - t, 0.0)) / (_RAMP * end)
        return np.sin(np.pi / 2 * min(rise, 1.0))**2 * np.cos(2 * np.pi * tone * t + phase).sum()

    return force


def disturbed(kind, values, std, random):
    """``values`` (c, n) with the noise of a disturbance, of the root mean square ``std`` (c,); NaN where lost."""
    count, white = values.shape[1], random.standard_normal(values.shape)
    time = np.arange(count) / count
    noise = {"coloured": lambda: lfilter([1.0], [1.0, -random.uniform(0.5, 0.97)], white),
             "flicker": lambda: _flicker(white), "hum": lambda: 0.5 * white + _hum(random, time, count),
             "swelling": lambda: white * (0.2 + 2 * time), "bursts": lambda: white * _bursts(random, count)}
    shape = noise.get(kind, lambda: white)()
    seen = values + std[:, None] * shape / np.sqrt(np.mean(shape**2))
    if kind == "rounded":       # twelve bits or fewer: steps of the root mean square of the noise
        step = np.sqrt(12) * std[:, None]
        seen = np.round((values + 0.2 * std[:, None] * white) / step) * step
    if kind == "lost":
        for begin in random.integers(0, count, 12):
            seen[:, begin:begin + int(random.integers(1, 30))] = np.nan
    return seen


def _flicker(white):
    """Noise (c, n) whose power falls with the frequency, no mean."""
    spectrum = np.fft.rfft(white)
    spectrum /= np.sqrt(np.maximum(np.arange(spectrum.shape[1]), 1))
    spectrum[:, 0] = 0
    return np.fft.irfft(spectrum, white.shape[1])


def _hum(random, time, count):
    """One tone and its third multiple (1, n), the same in all channels."""
    cycles, phase = random.uniform(5, count / 8), random.uniform(0, 2 * np.pi)
    return (np.sin(2 * np.pi * cycles * time + phase) + 0.4 * np.sin(6 * np.pi * cycles * time + phase))[None]


def _bursts(random, count):
    """Factor (1, n) of noise that is ten times as strong for a few per cent of the time."""
    factor = np.ones(count)
    for begin in random.integers(0, count, 4):
        factor[begin:begin + count // 80] = 10.0
    return factor[None]


def _run(values, force, quantity, sampled):
    channels = {f"body_{k + 1}": channel(x, UNITS[quantity], quantity, sampled, 0.0, "case")
                for k, x in enumerate(values)}
    channels["force"] = channel(force, "N", "force", sampled, 0.0, "case", role="excitation")
    return RunProduct(description="", repeat_of="", channels=channels)


def document(row, quantity, std, step):
    """{section: settings} of the nominal case of a Row whose channels have the noise ``std`` (n,) in SI."""
    names = [f"body_{k + 1}" for k in range(len(row.mass))]
    joints = [f"joint_{k + 1}" for k in range(len(row.mass))]
    unit = UNITS[quantity]
    return {
        "lumped": {
            "masses": {n: {"mass": f"{float(m)!r} kg", "moves": ["x"]} for n, m in zip(names, row.mass, strict=True)},
            "springs": {n: {"between": [f"{names[k]}.x", f"{names[k - 1]}.x" if k else "ground"],
                            "stiffness": f"{float(row.stiffness[k])!r} N/m",
                            "damping": f"{float(row.damping[k])!r} N s/m"} for k, n in enumerate(joints)},
            "inputs": {"shaker": {"along": {f"{names[-1]}.x": 1}, "force": "1 N"}},
            "sensors": {n: {"along": {f"{n}.x": 1}, "quantity": quantity, "unit": unit} for n in names}},
        "bench": {"step": f"{float(step)!r} s", "inputs": {"shaker": {"channel": "force", "hold": "band_limited"}},
                  "channels": {n: {"quantity": quantity, "source": n} for n in names}},
        "diagnosis": {"parameters": {f"joints.{n}.{of}": {"spread": spread} for n in joints
                                     for of, spread in (("stiffness", 0.1), ("damping", 0.3))},
                      "held_out": [f"run_{len(LEVELS)}"],
                      "noise": {"std": {n: f"{float(s)!r} {unit}" for n, s in zip(names, std, strict=True)}}}}


def solved(case, kept=4, **asked):
    """diagnosis.json of a Case."""
    return by_stages(case.document, case.recording, kept=kept, **asked)


def scored(plan, answer):
    """(whether told as it is, whether a false alarm) of an answer."""
    foreign = [e["name"] for e in answer["effects"] if e["name"] not in DISTURBANCES[plan.kind]]
    return answer["verdict"] in NOTHING, answer["verdict"] in NAMING and bool(foreign)


def solve(folder, kept, ledger, plan):
    """Solve one Plan and add its answer to a Ledger; prints its line."""
    answer = kept_answer(folder / f"{plan.name}.json", partial(made, plan), partial(solved, kept=kept))
    ledger.add(plan.name, plan.kind, plan.noise, 0.0, answer)
    named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
    print(f"{plan.name:<22} -> {'FALSE ALARM ' if scored(plan, answer)[1] else ''}{answer['verdict']:<10} {named:<40}"
          f" {answer['cpu_seconds']:.0f} s", flush=True)


def results_of(rows):
    """[(Plan, whether told as it is, whether a false alarm)] of the rows of a Ledger."""
    by_name = {plan.name: plan for plan in plans()}
    return [(by_name[name], *scored(by_name[name], answer_of(row))) for name, row in rows.items()]


def table(results):
    """Lines of rates from [(Plan, whether told as it is, whether a false alarm)]."""
    rows = [("false alarms", [alarm for _, _, alarm in results]), ("told as it is", [right for _, right, _ in results])]
    for kind in DISTURBANCES:
        own = [(right, alarm) for plan, right, alarm in results if plan.kind == kind]
        if own:
            rows += [(f"{kind}: false alarms", [a for _, a in own]), (f"{kind}: told as it is", [r for r, _ in own])]
    return [line(name, rate(hits)) for name, hits in rows]


def main():
    """Solve what is chosen, print the table."""
    parser = argparse.ArgumentParser(prog="make study_disturbed", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_disturbed")
    parser.add_argument("--ledger", type=Path, default=FOLDER / "disturbed.csv")
    parser.add_argument("--only", nargs="*", default=list(DISTURBANCES), choices=list(DISTURBANCES), help="default all")
    parser.add_argument("--every", type=int, default=1, help="one case in so many")
    parser.add_argument("--kept", type=int, default=4, help="candidates that are refitted")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    chosen = parser.parse_args()
    ledger = Ledger(chosen.ledger)
    there = ledger.rows()
    left = [plan for plan in plans(chosen.only)[::chosen.every] if plan.name not in there]
    shared_out(partial(solve, chosen.folder, chosen.kept, ledger), left, chosen.workers)
    ledger.tidy()
    print("\n".join(table(results_of(ledger.rows()))))


if __name__ == "__main__":
    main()
