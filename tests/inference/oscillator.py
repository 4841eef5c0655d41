"""A toy bench for the tests of a diagnosis: a driven oscillator whose truth is integrated apart from its model.

Truth: LSODA of SciPy with a tight tolerance. Model: Runge-Kutta 4 in numba, which errs by at most 3e-4 of the
standard deviation of a channel, beside dry friction by 1.2e-3. Channels: displacement [m], velocity [m/s].
"""

from dataclasses import replace
from functools import cache, lru_cache
from math import pi, sin, tanh

import numpy as np
from numba import njit
from scipy.integrate import odeint

from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem
from pipeline.inference.rules import DEFAULTS

RATE, SAMPLES, SUBSTEPS = 200.0, 2000, 2
STIFFNESS, DAMPING = 400.0, 1.2         # of unit mass [N/m, N s/m]
NOMINAL = Hypothesis("nominal", (), (
    Parameter("stiffness", "N/m", STIFFNESS, LogNormal(STIFFNESS, 0.2)),
    Parameter("damping", "N s/m", DAMPING, LogNormal(DAMPING, 0.3)),
))
#: laws the model can add: name -> (parameter, unit, prior); the order is that of the model's argument
LAWS = {
    "cubic": ("cubic_stiffness", "N/m^3", Normal(0.0, 2e4)),
    "quadratic": ("quadratic_stiffness", "N/m^2", Normal(0.0, 2e3)),
    "coulomb": ("friction_force", "N", HalfNormal(1.0)),
    "air": ("quadratic_damping", "N s^2/m^2", HalfNormal(2.0)),
    "offset": ("force_offset", "N", Normal(0.0, 1.0)),
    "negative_damping": ("velocity_cubed", "N s^3/m^3", Normal(0.0, 3.0)),
}
SENSOR_GAIN = Hypothesis("sensor_gain", (("sensor_gain", "displacement"),), (
    Parameter("gain_error", "1", 0.0, Normal(0.0, 0.1), 0.0),), "sensor")
CATALOGUE = (*(Hypothesis(law, ((law, "mount"),), (Parameter(name, unit, prior.value(0.0), prior, 0.0),))
               for law, (name, unit, prior) in LAWS.items()), SENSOR_GAIN)


@cache
def drive_on_grid(amplitude, tones):
    """The drive [N] on the half steps of the model: three tones and a slow sweep, scaled by the amplitude of the run.
    """
    time = np.arange(2 * SUBSTEPS * (SAMPLES - 1) + 1) / (2 * RATE * SUBSTEPS)
    sweep = np.sin(2 * np.pi * (1.0 + 0.25 * time) * time)
    return amplitude * (sum(np.sin(2 * np.pi * f * time + 2.1 * k) for k, f in enumerate(tones)) + sweep)


@njit(cache=True)
def march(force, step, stiffness, damping, laws):
    """Displacement and velocity (2, n) from rest; ``force`` on a grid of half steps."""
    steps = (len(force) - 1) // 2
    out = np.zeros((2, steps + 1))
    x, v = 0.0, 0.0
    for i in range(steps):
        a1 = _pull(force[2 * i], x, v, stiffness, damping, laws)
        x2, v2 = x + 0.5 * step * v, v + 0.5 * step * a1
        a2 = _pull(force[2 * i + 1], x2, v2, stiffness, damping, laws)
        x3, v3 = x + 0.5 * step * v2, v + 0.5 * step * a2
        a3 = _pull(force[2 * i + 1], x3, v3, stiffness, damping, laws)
        x4, v4 = x + step * v3, v + step * a3
        a4 = _pull(force[2 * i + 2], x4, v4, stiffness, damping, laws)
        x, v = x + step / 6 * (v + 2 * v2 + 2 * v3 + v4), v + step / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        out[0, i + 1], out[1, i + 1] = x, v
    return out


@njit(cache=True)
def _pull(force, x, v, stiffness, damping, laws):
    friction = laws[2] * np.tanh(v / 0.005) if laws[2] else 0.0       # most of the time, for a law that few have
    return (force - stiffness * x - damping * v - laws[0] * x**3 - laws[1] * x**2 - friction - laws[3] * v * abs(v)
            - laws[4] - laws[5] * v**3)


def predict(hypothesis, values, run):
    """What both channels show in ``run``."""
    force = drive_on_grid(run.conditions["amplitude"], run.conditions["tones"])
    force = force[:2 * SUBSTEPS * (run.samples.shape[1] - 1) + 1]
    laws = np.array([values.get(name, 0.0) for name, _, _ in LAWS.values()])
    motion = march(force, 1 / (RATE * SUBSTEPS), values["stiffness"], values["damping"], laws)[:, ::SUBSTEPS]
    return motion * np.array([[1.0 + values.get("gain_error", 0.0)], [1.0]])


def truth(conditions, stiffness=STIFFNESS, damping=DAMPING, extra=None, gain=1.0):
    """Both channels (2, n) with an ``extra`` force(t, x, v) in the equation of motion, by LSODA."""
    motion = _moved(conditions["amplitude"], conditions["tones"], stiffness, damping, extra)
    return motion * np.array([[gain], [1.0]])


@lru_cache(64)
def _moved(amplitude, tones, stiffness, damping, extra):
    """Motion under the drive, which is written once more here: step by step, and apart from that of the model."""
    time = np.arange(SAMPLES) / RATE
    waves = [(2 * pi * tone, 2.1 * k) for k, tone in enumerate(tones)]

    def slope(t, state):
        x, v = state.tolist()
        force = sin(2 * pi * (1.0 + 0.25 * t) * t)
        for angular, phase in waves:
            force += sin(angular * t + phase)
        return v, amplitude * force - stiffness * x - damping * v - (extra(t, x, v) if extra else 0.0)

    return odeint(slope, (0.0, 0.0), time, rtol=1e-10, atol=1e-13, tfirst=True, mxstep=10**5).T


def conditions_of(held_out=True):
    """Amplitude ladder of three fitted runs; the fourth has other tones and an amplitude in between."""
    ladder = [{"amplitude": a, "tones": t} for a, t in ((2.0, (1.1, 2.9, 3.7)), (5.0, (1.6, 2.6, 4.3)),
                                                        (9.0, (0.9, 3.3, 5.1)))]
    return [*ladder, {"amplitude": 7.0, "tones": (1.3, 2.4, 3.9)}][:4 if held_out else 3]


def bench(seed, noise=0.01, held_out=True, **of_truth):
    """Problem whose runs are the truth with white noise of ``noise`` times the channel's standard deviation."""
    generator, runs = np.random.default_rng(seed), []
    for k, conditions in enumerate(conditions_of(held_out)):
        clean = truth(conditions, **of_truth)
        std = noise * clean.std(axis=1)
        samples = clean + std[:, None] * generator.standard_normal(clean.shape)
        runs.append(Observed(f"run_{k + 1}", conditions, ("displacement", "velocity"), samples, RATE, noise_std=std,
                             held_out=k == 3))
    return Problem(tuple(runs), predict, NOMINAL)


def both(t, x, v):
    """A cubic spring and dry friction, N, of which the first alone leaves little."""
    return 1.5e4 * x**3 + 0.6 * tanh(v / 0.005)


def changed(group, **values):
    """The default rules with other ``values`` of a group."""
    return replace(DEFAULTS, **{group: replace(getattr(DEFAULTS, group), **values)})


def alone(problem, count=1):
    """The same bench with only its first fitted runs."""
    return replace(problem, runs=problem.runs[:count])


def predict_with_lag(hypothesis, values, run):
    """As ``predict``, by a careless solver: its force comes half a sample late. ``refinement`` 1 takes the lag away."""
    good = predict(hypothesis, values, run)
    late = np.roll(drive_on_grid(run.conditions["amplitude"], run.conditions["tones"]), SUBSTEPS)
    late[:SUBSTEPS] = 0.0
    late = late[:2 * SUBSTEPS * (run.samples.shape[1] - 1) + 1]
    laws = np.array([values.get(name, 0.0) for name, _, _ in LAWS.values()])
    lagging = march(late, 1 / (RATE * SUBSTEPS), values["stiffness"], values["damping"], laws)[:, ::SUBSTEPS]
    with np.errstate(all="ignore"):
        return lagging + values.get("refinement", 0.0) * (good - lagging)


SOLVER = Hypothesis("time_step", (("time_step", "solver"),), (
    Parameter("refinement", "1", 0.0, Normal(0.0, 1.0), 0.0),), "numerics")
